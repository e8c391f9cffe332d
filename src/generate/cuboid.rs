//! A cube with flat faces. A decimator should reduce it to twelve triangles without error.

use std::collections::HashMap;

use nephrite_formats::TriangleMesh;

use super::{lattice, mesh_of};

/// Largest number of segments: 48 million triangles.
const MAX_SEGMENTS: u32 = 2000;

/// The cube [0, 1]^3, each face a lattice of `segments * segments` cells.
///
/// `12 * segments^2` triangles over `6 * segments^2 + 2` vertices; `segments` in `1..=2000`.
pub fn cuboid(segments: u32) -> TriangleMesh {
    let segments = segments.clamp(1, MAX_SEGMENTS);
    let mut ids: HashMap<[u32; 3], u32> = HashMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for level in [0, segments] {
            let mut face = Vec::with_capacity((segments as usize + 1).pow(2));
            for row in 0..=segments {
                for column in 0..=segments {
                    // The upper face has (axis + 1, axis + 2) counter-clockwise, the lower face the
                    // reverse.
                    let mut point = if level == 0 { [level, row, column] } else { [level, column, row] };
                    point.rotate_right(axis);
                    let next = u32::try_from(ids.len()).unwrap_or(u32::MAX);
                    face.push(*ids.entry(point).or_insert_with(|| {
                        positions.push(point.map(|index| lattice::step(0.0, 1.0, index, segments)));
                        next
                    }));
                }
            }
            let vertex =
                |column: u32, row: u32| face[row as usize * (segments as usize + 1) + column as usize];
            triangles.extend(lattice::triangles(segments, segments, vertex));
        }
    }
    mesh_of(&positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn is_a_closed_cube() {
        for segments in [1, 2, 9] {
            let mesh = cuboid(segments);
            let topology = Topology::of(&mesh);
            assert_eq!(mesh.triangles.len(), 12 * (segments * segments) as usize);
            assert_eq!(mesh.positions.len(), 6 * (segments * segments) as usize + 2);
            assert_eq!(topology.euler(), 2);
            assert!(topology.is_closed() && topology.is_oriented);
            assert!((Topology::volume(&mesh) - 1.0).abs() < 1e-6);
        }
    }
}
