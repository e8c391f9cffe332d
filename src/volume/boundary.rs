//! The surface around a volume.

use crate::mesh::boundary_triangles;
use nephrite_formats::{Attribute, TetrahedronMesh, TriangleMesh};

/// The faces that belong to one tetrahedron only, counter-clockwise as seen from outside if the
/// tetrahedra have positive volume. Boundary vertices keep their order and their values; inner
/// vertices are left out. O(n).
pub fn boundary(volume: &TetrahedronMesh) -> TriangleMesh {
    const UNUSED: u32 = u32::MAX;
    let mut triangles = boundary_triangles(&volume.tetrahedra, volume.positions.len());
    let mut numbers = vec![UNUSED; volume.positions.len()];
    triangles.as_flattened().iter().for_each(|&v| numbers[v as usize] = 0);
    let mut used = Vec::new();
    for (v, number) in numbers.iter_mut().enumerate().filter(|(_, number)| **number != UNUSED) {
        *number = u32::try_from(used.len()).unwrap_or(UNUSED);
        used.push(v);
    }
    triangles.as_flattened_mut().iter_mut().for_each(|v| *v = numbers[*v as usize]);
    let attributes = volume.attributes.iter().map(|attribute| {
        let stride = attribute.stride_bytes();
        let bytes = used.iter().flat_map(|&v| &attribute.bytes[v * stride..][..stride]).copied().collect();
        Attribute { bytes, name: attribute.name.clone(), ..*attribute }
    });
    TriangleMesh {
        origin: volume.origin,
        positions: used.iter().map(|&v| volume.positions[v]).collect(),
        attributes: attributes.collect(),
        triangles,
        rounding: volume.rounding,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_has_four_faces_that_look_outwards() {
        let volume = TetrahedronMesh {
            positions: vec![[9.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            tetrahedra: vec![[1, 2, 3, 4]],
            ..Default::default()
        };
        let surface = boundary(&volume);
        assert_eq!((surface.positions.len(), surface.triangles.len()), (4, 4));
        let point = |v: u32| surface.positions[v as usize].map(f64::from);
        let six_volumes: f64 = surface
            .triangles
            .iter()
            .map(|&[a, b, c]| {
                use crate::geometry::vector::{cross, dot};
                dot(point(a), cross(point(b), point(c)))
            })
            .sum();
        assert!((six_volumes - 1.0).abs() < 1e-12);
    }
}
