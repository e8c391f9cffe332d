//! The tetrahedral mesh that volume readers produce and volume writers consume: flat arrays,
//! nothing derived.
//!
//! Coordinates follow the rule of [`crate::mesh`]. Fields are per-vertex attributes: they keep the
//! name and the type that the file gave them. Several values of one field, as the steps of a
//! simulation give them, are several attributes or several components of one.

use crate::Attribute;
use crate::fault::{Arrays, MeshFault};

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
    /// Added to every position to give file coordinates, see
    /// [`TriangleMesh::origin`](crate::TriangleMesh::origin).
    pub origin: [f64; 3],
    /// Vertex positions relative to `origin`, in mesh units.
    pub positions: Vec<[f32; 3]>,
    /// Four vertex indices per tetrahedron: the first three counter-clockwise seen from the
    /// fourth's opposite side, so that `dot(cross(b - a, c - a), d - a)` is positive.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Per-vertex fields, each of length `positions.len()`.
    pub attributes: Vec<Attribute>,
    /// Largest distance, in mesh units, between a vertex as the file gave it and as it is stored
    /// here.
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
    /// If there is no such vertex.
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

    /// Checks what the types leave open: indices in range, finite coordinates, a rounding that is a
    /// length, fields of the right length.
    ///
    /// Costs one pass over the mesh. Every reader returns meshes that pass; writers and builds
    /// refuse those that do not.
    ///
    /// # Errors
    ///
    /// The first contradiction.
    pub fn check(&self) -> Result<(), MeshFault> {
        let Self { origin, positions, tetrahedra, attributes, rounding } = self;
        let (origin, rounding) = (*origin, *rounding);
        Arrays { simplex: "tetrahedron", origin, positions, simplices: tetrahedra, attributes, rounding }
            .check()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ScalarType;

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
        let index = MeshFault::Index { simplex: "tetrahedron", at: 1, found: 4, n_vertices: 4 };
        assert_eq!(bad.check(), Err(index));
        let mut bad = good.clone();
        bad.positions[2][1] = f32::INFINITY;
        assert_eq!(bad.check(), Err(MeshFault::NotFinite { vertex: 2, found: f32::INFINITY }));
        for found in [-1.0, f64::INFINITY, f64::NEG_INFINITY] {
            let bad = TetrahedronMesh { rounding: found, ..good.clone() };
            assert_eq!(bad.check(), Err(MeshFault::Rounding { found }));
            let bad = TetrahedronMesh { origin: [0.0, f64::INFINITY, 0.0], ..good.clone() };
            assert_eq!(bad.check(), Err(MeshFault::Origin { found: f64::INFINITY }));
        }
        let bad = TetrahedronMesh { rounding: f64::NAN, ..good.clone() };
        assert!(matches!(bad.check(), Err(MeshFault::Rounding { .. })));
        let mut bad = good;
        bad.attributes.push(Attribute::from_values("f", ScalarType::U8, 2, [0.0; 7]));
        assert_eq!(bad.check(), Err(MeshFault::AttributeBytes { at: 0, found: 7, expected: 8 }));
        bad.attributes[0].n_components = 0;
        assert_eq!(bad.check(), Err(MeshFault::NoComponents { at: 0 }));
    }
}
