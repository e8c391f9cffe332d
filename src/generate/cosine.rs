//! The ripple with which Ciampalini, Cignoni, Montani and Scopigno (The Visual Computer, 1997,
//! figures 2, 3 and 5) show how the error of their decimation rises.

use nephrite_formats::TriangleMesh;

use super::{MAX_COUNT, lattice, mesh_of};

/// The height field `z = cos(r) / (r + 0.001)`, `r` the distance from the z axis, over `x` and `y`
/// in [-10, 10].
///
/// `side * side` vertices and `2 * (side - 1)^2` triangles, row by row; `side` in `2..=MAX_COUNT`.
/// The paper's mesh of 28,322 triangles is `cosine(120)`.
///
/// ```
/// assert_eq!(nephrite::generate::cosine(120).triangles.len(), 28_322);
/// ```
pub fn cosine(side: u32) -> TriangleMesh {
    let side = side.clamp(2, MAX_COUNT);
    let mut positions = Vec::with_capacity(side as usize * side as usize);
    for row in 0..side {
        for column in 0..side {
            let [x, y] = [column, row].map(|index| lattice::step(-10.0, 10.0, index, side - 1));
            let radius = x.hypot(y);
            positions.push([x, y, radius.cos() / (radius + 0.001)]);
        }
    }
    mesh_of(&positions, lattice::triangles(side - 1, side - 1, |column, row| row * side + column))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn is_one_disc_with_the_papers_counts() {
        let mesh = cosine(120);
        assert_eq!(mesh.positions.len(), 14_400);
        assert_eq!(mesh.triangles.len(), 28_322);
        let topology = Topology::of(&mesh);
        assert_eq!(topology.euler(), 1);
        assert_eq!(topology.n_boundary_edges, 4 * 119);
        assert!(topology.is_oriented);
    }

    #[test]
    fn corners_are_exact_and_odd_sides_reach_the_peak() {
        let mesh = cosine(3);
        let corner = 200.0_f64.sqrt();
        assert_eq!(mesh.positions[0][..2], [-10.0, -10.0]);
        assert!((f64::from(mesh.positions[0][2]) - corner.cos() / (corner + 0.001)).abs() < 1e-9);
        assert_eq!(mesh.positions[4], [0.0, 0.0, 1000.0]);
        assert_eq!(mesh.positions[8][..2], [10.0, 10.0]);
    }

    #[test]
    fn a_side_below_two_is_one_cell() {
        assert_eq!(cosine(0).triangles, [[0, 1, 3], [0, 3, 2]]);
    }
}
