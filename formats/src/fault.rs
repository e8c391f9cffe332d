//! What can be wrong with a mesh in memory, for surfaces and volumes alike.

use crate::Attribute;

/// The first contradiction in a mesh.
///
/// ```
/// use nephrite_formats::{MeshFault, TriangleMesh};
///
/// let mesh = TriangleMesh { triangles: vec![[0, 1, 2]], ..TriangleMesh::default() };
/// let fault = mesh.check().unwrap_err();
/// assert_eq!(fault, MeshFault::Index { simplex: "triangle", at: 0, found: 0, n_vertices: 0 });
/// assert_eq!(fault.to_string(), "triangle 0 names vertex 0, the mesh has 0 vertices");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// A simplex names a vertex that does not exist.
    #[error("{simplex} {at} names vertex {found}, the mesh has {n_vertices} vertices")]
    Index {
        /// `triangle` or `tetrahedron`.
        simplex: &'static str,
        /// Which one.
        at: usize,
        /// The index it holds.
        found: u32,
        /// Vertices there are.
        n_vertices: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} has the coordinate {found}, expected a finite number")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
        /// The coordinate.
        found: f32,
    },
    /// A coordinate of the origin is infinite or not a number.
    #[error("the origin has the coordinate {found}, expected a finite number")]
    Origin {
        /// The coordinate.
        found: f64,
    },
    /// The rounding is no length.
    #[error("the rounding is {found}, expected a finite number that is not negative")]
    Rounding {
        /// The rounding.
        found: f64,
    },
    /// An attribute has more or fewer bytes than its vertices need.
    #[error("attribute {at} has {found} bytes, expected {expected}")]
    AttributeBytes {
        /// Which one.
        at: usize,
        /// Its length.
        found: usize,
        /// The length that the vertices need.
        expected: u64,
    },
    /// An attribute has no component.
    #[error("attribute {at} has 0 components, expected at least 1")]
    NoComponents {
        /// Which one.
        at: usize,
    },
}

/// The arrays of a mesh with simplices of `N` corners.
pub(crate) struct Arrays<'a, const N: usize> {
    pub(crate) simplex: &'static str,
    pub(crate) origin: [f64; 3],
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) simplices: &'a [[u32; N]],
    pub(crate) attributes: &'a [Attribute],
    pub(crate) rounding: f64,
}

impl<const N: usize> Arrays<'_, N> {
    /// The first contradiction, in one pass.
    pub(crate) fn check(&self) -> Result<(), MeshFault> {
        if let Some(&found) = self.origin.iter().find(|x| !x.is_finite()) {
            return Err(MeshFault::Origin { found });
        }
        if !(self.rounding.is_finite() && self.rounding >= 0.0) {
            return Err(MeshFault::Rounding { found: self.rounding });
        }
        let n_vertices = self.positions.len();
        let coordinates = self.positions.as_flattened();
        if let Some(at) = coordinates.iter().position(|x| !x.is_finite()) {
            return Err(MeshFault::NotFinite { vertex: at / 3, found: coordinates[at] });
        }
        let corners = self.simplices.as_flattened();
        if let Some(at) = corners.iter().position(|&v| v as usize >= n_vertices) {
            let (simplex, found) = (self.simplex, corners[at]);
            return Err(MeshFault::Index { simplex, at: at / N, found, n_vertices });
        }
        self.check_attributes()
    }

    fn check_attributes(&self) -> Result<(), MeshFault> {
        for (at, attribute) in self.attributes.iter().enumerate() {
            let expected = self.positions.len() as u64 * attribute.stride_bytes() as u64;
            let found = attribute.bytes.len();
            if attribute.n_components == 0 {
                return Err(MeshFault::NoComponents { at });
            }
            if found as u64 != expected {
                return Err(MeshFault::AttributeBytes { at, found, expected });
            }
        }
        Ok(())
    }
}
