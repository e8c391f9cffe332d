//! Rolling hills: a height field of value noise summed over octaves, after Perlin (SIGGRAPH 1985)
//! in its simplest form.
//!
//! It uses additions and multiplications of `f64` only, so a seed gives the same bits on every
//! machine.

use nephrite_formats::TriangleMesh;

use super::{MAX_COUNT, lattice, mesh_of};

/// Length of the square that the terrain covers.
const EXTENT: f64 = 1000.0;
/// Height of the first octave above zero.
const AMPLITUDE: f64 = 160.0;
/// Each octave halves wavelength and height; the tenth has hills of height 0.3 and length 2.
const N_OCTAVES: u32 = 10;

/// A terrain over [0, 1000]^2 whose heights lie in [0, 320].
///
/// `side * side` vertices and `2 * (side - 1)^2` triangles, row by row; `side` in `2..=MAX_COUNT`.
/// A finer side samples the same hills more densely; another `seed` gives other hills.
pub fn terrain(side: u32, seed: u64) -> TriangleMesh {
    let side = side.clamp(2, MAX_COUNT);
    let mut positions = Vec::with_capacity(side as usize * side as usize);
    for row in 0..side {
        for column in 0..side {
            let [u, v] = [column, row].map(|index| lattice::step(0.0, 1.0, index, side - 1));
            positions.push([u * EXTENT, v * EXTENT, height(u, v, seed)]);
        }
    }
    mesh_of(&positions, lattice::triangles(side - 1, side - 1, |column, row| row * side + column))
}

/// Sum of all octaves at a point of the unit square.
fn height(u: f64, v: f64, seed: u64) -> f64 {
    (0..N_OCTAVES)
        .map(|octave| {
            let n_cells = f64::from(4_u32 << octave);
            AMPLITUDE / f64::from(1_u32 << octave)
                * noise(u * n_cells, v * n_cells, seed ^ u64::from(octave) << 56)
        })
        .sum()
}

/// Values in [0, 1] at the whole numbers, smooth in between.
fn noise(x: f64, y: f64, seed: u64) -> f64 {
    let [column, row] = [x.floor(), y.floor()];
    let [s, t] = [fade(x - column), fade(y - row)];
    let value = |right: f64, up: f64| lattice_value(column + right, row + up, seed);
    let [low, high] = [0.0, 1.0].map(|up| mix(value(0.0, up), value(1.0, up), s));
    mix(low, high, t)
}

/// A smooth step from 0 to 1: its first two derivatives are 0 at both ends.
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// A number in [0, 1) that depends on every bit of a lattice point and the seed.
fn lattice_value(x: f64, y: f64, seed: u64) -> f64 {
    let mixed = scramble(scramble(seed ^ x.to_bits()) ^ y.to_bits());
    #[expect(clippy::cast_precision_loss, reason = "53 bits are left")]
    let numerator = (mixed >> 11) as f64;
    numerator / 9_007_199_254_740_992.0
}

/// The output function of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
fn scramble(state: u64) -> u64 {
    let state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn is_one_disc_of_hills() {
        let mesh = terrain(65, 7);
        assert_eq!(mesh.triangles.len(), 2 * 64 * 64);
        assert_eq!(Topology::of(&mesh).euler(), 1);
        let heights = || mesh.positions.iter().map(|position| position[2]);
        assert!(heights().all(|height| (0.0..=320.0).contains(&height)));
        let [low, high] = [heights().fold(f32::MAX, f32::min), heights().fold(f32::MIN, f32::max)];
        assert!(high - low > 80.0, "hills from {low} to {high}");
    }

    #[test]
    fn seeds_differ_and_repeat() {
        assert_eq!(terrain(17, 1), terrain(17, 1));
        assert_ne!(terrain(17, 1), terrain(17, 2));
    }

    #[test]
    fn finer_sides_sample_the_same_hills() {
        let [coarse, fine] = [terrain(9, 3), terrain(17, 3)];
        for row in 0..9 {
            for column in 0..9 {
                assert_eq!(coarse.positions[row * 9 + column], fine.positions[row * 2 * 17 + column * 2]);
            }
        }
    }
}
