//! The vertices of a mesh, whatever its simplices are.

use nephrite_formats::{Attribute, TetrahedronMesh, TriangleMesh};

/// What a file stores of the vertices that a history's indices refer to.
#[derive(Clone, Copy, Debug)]
pub struct Vertices<'a> {
    /// Added to every position to give file coordinates.
    pub origin: [f64; 3],
    /// Positions relative to `origin`.
    pub positions: &'a [[f32; 3]],
    /// Attributes, each of length `positions.len()`.
    pub attributes: &'a [Attribute],
    /// Largest distance between a vertex of the input and its position here, in mesh units.
    pub rounding: f64,
}

impl<'a> From<&'a TriangleMesh> for Vertices<'a> {
    fn from(mesh: &'a TriangleMesh) -> Self {
        let TriangleMesh { origin, positions, attributes, rounding, .. } = mesh;
        Self { origin: *origin, positions, attributes, rounding: *rounding }
    }
}

impl<'a> From<&'a TetrahedronMesh> for Vertices<'a> {
    fn from(mesh: &'a TetrahedronMesh) -> Self {
        let TetrahedronMesh { origin, positions, attributes, rounding, .. } = mesh;
        Self { origin: *origin, positions, attributes, rounding: *rounding }
    }
}
