//! A closed cylinder: one curved face, two sharp circles, and two flat faces that are fans of any
//! valence.

use std::f64::consts::TAU;

use nephrite_formats::TriangleMesh;

use super::{MAX_COUNT, lattice, mesh_of};

/// A cylinder of radius 1 about the z axis from `z = 0` to `z = 2`, with a fan around the centre of
/// each end.
///
/// `2 * segments * (rings + 1)` triangles. Vertices 0 and 1 are the centres of bottom and top, each
/// of valence `segments`. `segments` in `3..=1,000,000`, `rings` in `1..=MAX_COUNT`, and fewer
/// rings if the product would exceed 400 million.
pub fn cylinder(segments: u32, rings: u32) -> TriangleMesh {
    let segments = segments.clamp(3, 1_000_000);
    let rings = rings.clamp(1, MAX_COUNT.min(400_000_000 / segments));
    let mut positions = vec![[0.0, 0.0, 0.0], [0.0, 0.0, 2.0]];
    for ring in 0..=rings {
        let height = lattice::step(0.0, 2.0, ring, rings);
        for segment in 0..segments {
            let (sin, cos) = lattice::step(0.0, TAU, segment, segments).sin_cos();
            positions.push([cos, sin, height]);
        }
    }
    let vertex = |segment: u32, ring: u32| 2 + ring * segments + segment % segments;
    let mut triangles = lattice::triangles(segments, rings, vertex);
    for segment in 0..segments {
        triangles.push([0, vertex(segment + 1, 0), vertex(segment, 0)]);
        triangles.push([1, vertex(segment, rings), vertex(segment + 1, rings)]);
    }
    mesh_of(&positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn is_closed_and_encloses_its_prism() {
        for (segments, rings) in [(3, 1), (64, 5), (1000, 1)] {
            let mesh = cylinder(segments, rings);
            let topology = Topology::of(&mesh);
            assert_eq!(mesh.triangles.len(), (2 * segments * (rings + 1)) as usize);
            assert_eq!(topology.euler(), 2);
            assert!(topology.is_closed() && topology.is_oriented);
            let base = 0.5 * f64::from(segments) * (TAU / f64::from(segments)).sin();
            assert!((Topology::volume(&mesh) - 2.0 * base).abs() < 1e-5);
        }
    }
}
