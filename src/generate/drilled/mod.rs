//! Drilled parts as a CAD system exports them: large flat faces in long thin triangles, with round
//! holes through them.
//!
//! All are made of one [`face`], squares in columns and rows of which some have a hole. A
//! [`plate()`] is a face and its mirror image; a [`shell()`] is a face that is bent; a
//! [`heat_exchanger()`] is two plates with tubes between them. With seven holes and the right
//! counts they are as large as the parts in W. J. Schroeder, "A topology modifying progressive
//! decimation algorithm", *IEEE Visualization* 1997, figure 7.

mod face;
mod heat_exchanger;
mod plate;
mod shell;

pub use heat_exchanger::heat_exchanger;
pub use plate::{drilled_plate, plate};
pub use shell::shell;

use super::lattice;

/// Length of the square that surrounds a hole.
const PITCH: f64 = 10.0;
/// Radius of a hole.
const HOLE_RADIUS: f64 = 3.0;
/// Thickness of a plate.
const THICKNESS: f64 = 2.0;

/// How a face is divided and drilled. Counts outside their ranges are clamped.
///
/// ```
/// use nephrite::generate::{Drilling, drilled_plate, shell};
/// assert_eq!(drilled_plate(&Drilling::PLATE).triangles.len(), 2624);
/// assert_eq!(shell(&Drilling::SHELL).triangles.len(), 1132);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drilling {
    /// Squares along x, `1..=400`.
    pub columns: u32,
    /// Squares along y, `1..=400`.
    pub rows: u32,
    /// Squares with a hole, spread evenly, `0..=columns * rows`.
    pub holes: u32,
    /// Sides of a hole, `4..=1024`, rounded up to a multiple of four.
    pub segments: u32,
    /// Edges along the side of a square, `1..=24`.
    pub pieces: u32,
    /// Rings of triangles from a hole to its square, `1..=6`.
    pub face_rings: u32,
    /// Rings of triangles from one face of a plate to the other, in each hole, `1..=6`.
    pub wall_rings: u32,
}

impl Drilling {
    /// The plate with seven holes: 2,624 triangles.
    pub const PLATE: Self =
        Self { columns: 3, rows: 3, holes: 7, segments: 40, pieces: 4, face_rings: 1, wall_rings: 3 };
    /// A plate with one hole: 1,000 triangles.
    pub const WASHER: Self =
        Self { columns: 1, rows: 1, holes: 1, segments: 84, pieces: 10, face_rings: 1, wall_rings: 4 };
    /// The shell with seven holes: 1,132 triangles.
    pub const SHELL: Self =
        Self { columns: 3, rows: 3, holes: 7, segments: 20, pieces: 12, face_rings: 3, wall_rings: 1 };

    /// A hole in every square, with as few triangles as possible.
    pub fn of_every_square(columns: u32, rows: u32, segments: u32) -> Self {
        let holes = columns.saturating_mul(rows);
        Self { columns, rows, holes, segments, pieces: 1, face_rings: 1, wall_rings: 1 }
    }

    /// The counts, clamped to their ranges, so that the vertices fit a `u32`.
    fn clamped(&self) -> Self {
        let (columns, rows) = (self.columns.clamp(1, 400), self.rows.clamp(1, 400));
        Self {
            columns,
            rows,
            holes: self.holes.min(columns * rows),
            segments: self.segments.clamp(4, 1024).next_multiple_of(4),
            pieces: self.pieces.clamp(1, 24),
            face_rings: self.face_rings.clamp(1, 6),
            wall_rings: self.wall_rings.clamp(1, 6),
        }
    }

    fn n_squares(&self) -> u32 {
        self.columns * self.rows
    }

    /// Whether square `index`, counted row by row, has a hole.
    fn is_drilled(&self, index: u32) -> bool {
        let n_before =
            |squares: u32| u64::from(squares) * u64::from(self.holes) / u64::from(self.n_squares());
        n_before(index) < n_before(index + 1)
    }
}

/// Triangles of a closed band over loops of vertices, the lowest loop first. Seen from the side
/// that the band faces, a loop runs to the right.
fn band(loops: &[Vec<u32>]) -> impl Iterator<Item = [u32; 3]> + '_ {
    loops.windows(2).flat_map(|pair| {
        let n = u32::try_from(pair[0].len()).unwrap_or(u32::MAX);
        lattice::triangles(n, 1, |step, row| pair[row as usize][(step % n) as usize])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_spread_and_all_there() {
        for (columns, rows, holes) in [(3, 3, 7), (5, 4, 0), (5, 4, 20), (4, 2, 3), (1, 1, 1)] {
            let drilling = Drilling { columns, rows, holes, ..Drilling::PLATE };
            let drilled = (0..columns * rows).filter(|&square| drilling.is_drilled(square));
            assert_eq!(drilled.count(), holes as usize);
        }
    }

    #[test]
    fn counts_are_moved_into_their_ranges() {
        let least =
            Drilling { columns: 0, rows: 0, holes: 9, segments: 0, pieces: 0, face_rings: 0, wall_rings: 0 };
        assert_eq!(drilled_plate(&least), plate(1, 1, 4));
    }
}
