//! Numbering along a curve, so that what is near in space is near in memory.

use super::used::pick_values;
use super::{Numbering, Repaired};

/// Renumbers vertices along a Morton curve, and triangles by their least vertex. The mesh is the
/// same: a decimator that walks over it misses the cache less. O(n log n).
pub(crate) fn along_a_curve(Repaired { mut mesh, points, looks, dropped, report }: Repaired) -> Repaired {
    // Vertices of one point keep their order: its first one stays the first.
    let numbering = Numbering::along_curve(&mesh.positions);
    numbering.sort_triangles(&mut mesh.triangles);
    for vertex in mesh.triangles.as_flattened_mut() {
        *vertex = numbering.place(*vertex);
    }
    mesh.positions = numbering.arrange(&mesh.positions);
    for attribute in &mut mesh.attributes {
        *attribute = pick_values(attribute, numbering.vertices());
    }
    let renumber = |of: Vec<u32>| {
        let mut of = numbering.arrange(&of);
        of.iter_mut().for_each(|vertex| *vertex = numbering.place(*vertex));
        of
    };
    Repaired { points: points.map(renumber), looks: looks.map(renumber), mesh, dropped, report }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;
    use crate::mesh::repair;
    use nephrite_formats::{Attribute, ScalarType, TriangleMesh};

    /// Triangles as the positions of their corners, in any order.
    fn shape(mesh: &TriangleMesh) -> Vec<[[u32; 3]; 3]> {
        let corner = |v: u32| mesh.positions[v as usize].map(f32::to_bits);
        let mut shape: Vec<_> = mesh.triangles.iter().map(|t| t.map(corner)).collect();
        shape.sort_unstable();
        shape
    }

    #[test]
    fn the_mesh_is_the_same_and_neighbours_are_near() {
        let repaired = repair(generate::plate(3, 2, 16));
        let along = along_a_curve(repaired.clone());
        let (before, after) = (&repaired.mesh, &along.mesh);
        assert_eq!(shape(before).len(), shape(after).len());
        let rotated = |t: [[u32; 3]; 3]| {
            let least = (0..3).min_by_key(|&i| t[i]).unwrap();
            [t[least], t[(least + 1) % 3], t[(least + 2) % 3]]
        };
        let rotated = |mesh| {
            let mut shape: Vec<_> = shape(mesh).into_iter().map(rotated).collect();
            shape.sort_unstable();
            shape
        };
        assert_eq!(rotated(before), rotated(after));
    }

    #[test]
    fn seams_keep_the_first_vertex_of_each_point() {
        let grid = generate::cosine(6);
        let mut doubled = grid.clone();
        let n = u32::try_from(grid.positions.len()).unwrap();
        doubled.positions.extend_from_slice(&grid.positions);
        for triangle in doubled.triangles.iter_mut().skip(20) {
            *triangle = triangle.map(|v| v + n);
        }
        let look: Vec<u8> = (0..2 * n).flat_map(|v| u32::from(v >= n).to_le_bytes()).collect();
        doubled.attributes.push(Attribute {
            name: "look".into(),
            scalar: ScalarType::U32,
            n_components: 1,
            bytes: look,
        });
        let along = along_a_curve(repair(doubled));
        let points = along.points.unwrap();
        for (v, &point) in (0..).zip(&points) {
            assert!(point <= v && points[point as usize] == point);
            let [at, first] = [v, point].map(|v| along.mesh.positions[v as usize].map(f32::to_bits));
            assert_eq!(at, first);
        }
    }
}
