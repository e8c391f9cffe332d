//! The surface around a volume.

use crate::mesh::{UsedVertices, boundary_faces, fitting};
use nephrite_formats::{MeshFault, TetrahedronMesh, TriangleMesh};

/// The surface around a volume: the faces that belong to one tetrahedron only, seen
/// counter-clockwise from outside where the tetrahedra have positive volume. Vertices keep their
/// order and their values; those inside are left out.
///
/// Tetrahedra meet as they do in a build: vertices at one position are one point, whatever their
/// values are, and a tetrahedron without four points or with the points of an earlier one does not
/// count. O(n log n).
///
/// # Errors
///
/// The first contradiction in `volume`.
///
/// ```
/// let surface = nephrite::boundary(&nephrite::generate::box_volume([2, 2, 2]))?;
/// assert_eq!((surface.positions.len(), surface.triangles.len()), (26, 48));
/// # Ok::<(), nephrite::MeshFault>(())
/// ```
pub fn boundary(volume: &TetrahedronMesh) -> Result<TriangleMesh, MeshFault> {
    volume.check()?;
    Ok(boundary_of_checked(volume))
}

/// As [`boundary`], of a volume that contradicts itself nowhere.
pub(crate) fn boundary_of_checked(volume: &TetrahedronMesh) -> TriangleMesh {
    let (over_points, vertices) = fitting(volume);
    let faces = boundary_faces(&over_points, volume.positions.len());
    let mut triangles: Vec<[u32; 3]> =
        faces.map(|(tetrahedron, face)| face.map(|i| vertices[tetrahedron][i])).collect();
    let used = UsedVertices::new(volume.positions.len(), triangles.as_flattened());
    used.renumber(triangles.as_flattened_mut());
    TriangleMesh {
        origin: volume.origin,
        positions: used.pick(&volume.positions),
        attributes: used.pick_attributes(&volume.attributes),
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
        let surface = boundary(&volume).unwrap();
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
