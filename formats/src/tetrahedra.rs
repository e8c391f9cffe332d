//! The tetrahedral mesh that volume readers produce and volume writers consume: flat arrays, nothing derived.
//!
//! Coordinates follow the rule of [`crate::mesh`]. Fields are per-vertex attributes: they keep the name and the type that
//! the file gave them. Several values of one field, as the steps of a simulation give them, are several attributes or several
//! components of one.

use crate::Attribute;
use crate::error::{MeshError, Place};

/// Tetrahedra over shared vertices, with fields that belong to vertices.
///
/// Every index in `tetrahedra` is below `positions.len()`; every position is finite.
///
/// ```
/// let corner = nephrite_formats::TetrahedronMesh {
///     positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     tetrahedra: vec![[0, 1, 2, 3]],
///     ..Default::default()
/// };
/// assert!(corner.check().is_ok());
/// assert_eq!(corner.volume(), 1.0 / 6.0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TetrahedronMesh {
    /// Added to every position to give file coordinates, see [`TriangleMesh::origin`](crate::TriangleMesh::origin).
    pub origin: [f64; 3],
    /// Vertex positions relative to `origin`, in mesh units.
    pub positions: Vec<[f32; 3]>,
    /// Four vertex indices per tetrahedron: the first three counter-clockwise seen from the fourth's opposite side, so that
    /// `dot(cross(b - a, c - a), d - a)` is positive.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Per-vertex fields, each of length `positions.len()`.
    pub attributes: Vec<Attribute>,
    /// Largest distance, in mesh units, between a vertex as the file gave it and as it is stored here.
    pub rounding: f64,
}

impl TetrahedronMesh {
    /// The field of this name.
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// Six times the signed volume of a tetrahedron: positive where it has the orientation that
    /// [`tetrahedra`](Self::tetrahedra) states.
    ///
    /// # Panics
    ///
    /// Where there is no such vertex.
    pub fn six_volumes(&self, [a, b, c, d]: [u32; 4]) -> f64 {
        let point = |v: u32| self.positions[v as usize].map(f64::from);
        let apex = point(a);
        let edge = |v: u32| {
            let p = point(v);
            [p[0] - apex[0], p[1] - apex[1], p[2] - apex[2]]
        };
        let ([bx, by, bz], [cx, cy, cz], [dx, dy, dz]) = (edge(b), edge(c), edge(d));
        (by * cz - bz * cy) * dx + (bz * cx - bx * cz) * dy + (bx * cy - by * cx) * dz
    }

    /// Sum of the signed volumes, in cubic mesh units.
    ///
    /// # Panics
    ///
    /// Where an index has no vertex.
    pub fn volume(&self) -> f64 {
        self.tetrahedra.iter().map(|&tetrahedron| self.six_volumes(tetrahedron)).sum::<f64>() / 6.0
    }

    /// Checks what the types leave open: indices in range, finite coordinates, fields of the right length.
    ///
    /// Costs one pass over the mesh. Every reader returns meshes that pass; writers refuse those that do not.
    ///
    /// # Errors
    ///
    /// [`MeshError::InconsistentMesh`] or [`MeshError::NonFinite`] for the first contradiction.
    pub fn check(&self) -> Result<(), MeshError> {
        let n_vertices = self.positions.len();
        for (i, position) in self.positions.iter().enumerate() {
            if let Some(&value) = position.iter().find(|value| !value.is_finite()) {
                return Err(MeshError::NonFinite { place: Place::item("vertex", i), value: value.into() });
            }
        }
        let inconsistent =
            |place, what, found, expected| Err(MeshError::InconsistentMesh { place, what, found, expected });
        for (i, tetrahedron) in self.tetrahedra.iter().enumerate() {
            if let Some(&index) = tetrahedron.iter().find(|&&index| index as usize >= n_vertices) {
                let place = Place::item("tetrahedron", i);
                return inconsistent(place, "an index", index.into(), n_vertices as u64);
            }
        }
        for (i, attribute) in self.attributes.iter().enumerate() {
            let expected = n_vertices as u64 * attribute.stride_bytes() as u64;
            let found = attribute.bytes.len() as u64;
            if attribute.n_components == 0 || found != expected {
                return inconsistent(Place::item("attribute", i), "the length", found, expected);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contradictions_are_named() {
        let good = TetrahedronMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            tetrahedra: vec![[0, 1, 2, 3], [0, 2, 1, 3]],
            ..Default::default()
        };
        good.check().unwrap();
        assert_eq!(good.six_volumes(good.tetrahedra[1]), -1.0);
        assert_eq!(good.volume(), 0.0);
        let mut bad = good.clone();
        bad.tetrahedra[1][3] = 4;
        assert!(matches!(bad.check(), Err(MeshError::InconsistentMesh { found: 4, expected: 4, .. })));
        let mut bad = good;
        bad.positions[2][1] = f32::NAN;
        assert!(matches!(bad.check(), Err(MeshError::NonFinite { .. })));
    }
}
