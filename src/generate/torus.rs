//! A torus, the simplest closed surface with a handle.

use std::f64::consts::TAU;

use nephrite_formats::TriangleMesh;

use super::{MAX_COUNT, lattice, mesh_of};

/// Distance of the tube's centre from the axis.
const MAJOR_RADIUS: f64 = 1.0;
/// Radius of the tube.
const MINOR_RADIUS: f64 = 0.4;

/// A torus about the z axis, its tube of radius 0.4 around the unit circle.
///
/// `segments` sections around the axis, each of `sides` vertices: `2 * segments * sides` triangles.
/// Both counts in `3..=MAX_COUNT`.
pub fn torus(segments: u32, sides: u32) -> TriangleMesh {
    let [segments, sides] = [segments, sides].map(|count| count.clamp(3, MAX_COUNT));
    let mut positions = Vec::with_capacity(segments as usize * sides as usize);
    for segment in 0..segments {
        let (sin_around, cos_around) = lattice::step(0.0, TAU, segment, segments).sin_cos();
        for side in 0..sides {
            let (sin_tube, cos_tube) = lattice::step(0.0, TAU, side, sides).sin_cos();
            let radius = MAJOR_RADIUS + MINOR_RADIUS * cos_tube;
            positions.push([radius * cos_around, radius * sin_around, MINOR_RADIUS * sin_tube]);
        }
    }
    let triangles =
        lattice::triangles(segments, sides, |segment, side| segment % segments * sides + side % sides);
    mesh_of(&positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn is_closed_with_one_handle() {
        for (segments, sides) in [(3, 3), (24, 12), (5, 90)] {
            let mesh = torus(segments, sides);
            let topology = Topology::of(&mesh);
            assert_eq!(mesh.triangles.len(), 2 * (segments * sides) as usize);
            assert_eq!(topology.euler(), 0);
            assert!(topology.is_closed() && topology.is_oriented);
        }
    }

    #[test]
    fn encloses_the_volume_of_a_torus() {
        let exact = TAU * MAJOR_RADIUS * std::f64::consts::PI * MINOR_RADIUS * MINOR_RADIUS;
        let volume = Topology::volume(&torus(200, 100));
        assert!(volume < exact && volume > 0.998 * exact, "{volume} of {exact}");
    }
}
