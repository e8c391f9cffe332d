//! A polyline with a width: plane curves as surfaces.

use nephrite_formats::TriangleMesh;

use super::{lattice, mesh_of};

/// The points `[x, z]` of `profile` swept along y from 0 to `width`: two triangles for every
/// segment.
///
/// Vertices `0..n` are at `y = 0` and `n..2 * n` at `y = width`, each in the order of the profile.
/// The surface faces upwards if the profile runs to the right. A profile of fewer than two points
/// gives no triangle.
pub fn ribbon(profile: &[[f64; 2]], width: f64) -> TriangleMesh {
    let n_points = u32::try_from(profile.len()).unwrap_or(u32::MAX).min(u32::MAX / 2);
    let profile = &profile[..n_points as usize];
    let positions: Vec<[f64; 3]> =
        [0.0, width].iter().flat_map(|&y| profile.iter().map(move |&[x, z]| [x, y, z])).collect();
    mesh_of(
        &positions,
        lattice::triangles(n_points.saturating_sub(1), 1, |column, row| row * n_points + column),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn segments_become_pairs_of_triangles() {
        let mesh = ribbon(&[[0.0, 0.0], [1.0, 0.5], [2.0, 0.0]], 3.0);
        assert_eq!(mesh.triangles, [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]);
        assert_eq!(mesh.positions[4], [1.0, 3.0, 0.5]);
        assert_eq!(Topology::of(&mesh).euler(), 1);
    }

    #[test]
    fn a_lone_point_has_no_triangle() {
        assert!(ribbon(&[[0.0, 0.0]], 1.0).triangles.is_empty());
        assert!(ribbon(&[], 1.0).positions.is_empty());
    }
}
