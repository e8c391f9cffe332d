//! An order in which neighbours in space are neighbours in memory.
//!
//! Reference: G. M. Morton: "A computer oriented geodetic data base and a new technique in file
//! sequencing" (IBM, 1966).

use super::bounds::Bounds;

/// A grid of 2^21 cells along each axis around a mesh. The cells are numbered along a Morton curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    min: [f64; 3],
    cells_per_unit: f64,
}

impl Grid {
    const CELLS: f64 = 2_097_151.0;

    /// The grid around `positions`.
    pub(crate) fn around(positions: &[[f32; 3]]) -> Self {
        let bounds = Bounds::around_positions(positions);
        let side = bounds.extent().into_iter().fold(0.0, f64::max);
        Self { min: bounds.low, cells_per_unit: if side > 0.0 { Self::CELLS / side } else { 0.0 } }
    }

    /// Number of the cell that holds a position.
    pub(crate) fn morton(&self, position: [f32; 3]) -> u64 {
        self.cell(position.map(f64::from))
    }

    /// Number of the cell that holds the centroid of a simplex.
    pub(crate) fn morton_of_centroid<const CORNERS: usize>(
        &self,
        positions: &[[f32; 3]],
        simplex: [u32; CORNERS],
    ) -> u64 {
        let mut sum = [0.0; 3];
        for vertex in simplex {
            for (sum, x) in sum.iter_mut().zip(positions[vertex as usize]) {
                *sum += f64::from(x);
            }
        }
        self.cell(sum.map(|x| x / CORNERS as f64))
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the grid, which has 2^21 cells"
    )]
    fn cell(&self, position: [f64; 3]) -> u64 {
        let axis =
            |i: usize| ((position[i] - self.min[i]) * self.cells_per_unit).clamp(0.0, Self::CELLS) as u64;
        spread(axis(0)) | spread(axis(1)) << 1 | spread(axis(2)) << 2
    }
}

/// Moves bit `i` of a 21-bit number to bit `3 i`.
fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_moves_every_bit_to_three_times_its_place() {
        for bit in 0..21 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread((1 << 21) - 1), 0x1249_2492_4924_9249);
    }

    #[test]
    fn cells_of_any_mesh_are_in_the_grid() {
        let flat = Grid::around(&[[1.0; 3]; 4]);
        assert_eq!(flat.morton([1.0; 3]), 0);
        let huge = [[-f32::MAX, 0.0, 0.0], [f32::MAX, 1.0, 0.0]];
        let grid = Grid::around(&huge);
        assert_eq!(grid.morton(huge[0]), 0);
        assert_eq!(grid.morton(huge[1]), 0x1249_2492_4924_9249);
        assert_eq!(Grid::around(&[]).morton([5.0, f32::NAN, 0.0]), 0);
    }
}
