//! Why a build fails.

use crate::decimate::Stopped;
use crate::mesh::TooMany;

/// Why a build failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// No triangle is left after repair.
    #[error("no triangle with three distinct corners among the {n_triangles} of the mesh")]
    NoTriangles {
        /// Triangles before repair.
        n_triangles: usize,
    },
    /// No tetrahedron is left after repair.
    #[error("no tetrahedron with four distinct corners among the {n_tetrahedra} of the mesh")]
    NoTetrahedra {
        /// Tetrahedra before repair.
        n_tetrahedra: usize,
    },
    /// A volume contradicts itself: an index without a vertex, a field of the wrong length.
    #[error("the mesh contradicts itself: found {found} where {expected} would be right or the limit")]
    Inconsistent {
        /// Index or length.
        found: u64,
        /// Length or limit that would be right.
        expected: u64,
    },
    /// A coordinate is not a number, or not finite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {found}, the mesh has {n_vertices}")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The index it holds.
        found: u32,
        /// Vertices there are.
        n_vertices: usize,
    },
    /// More vertices or simplices than ids of 32 bits have room for, see [`mesh::MAX_SIMPLICES`](crate::mesh::MAX_SIMPLICES).
    #[error("{found} {what}, there can be at most {limit}")]
    TooLarge {
        /// What is counted, in the plural.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// An option has no meaning.
    #[error("{option} must be {expected}, found {found}")]
    Option {
        /// Its name.
        option: &'static str,
        /// What it must be.
        expected: &'static str,
        /// What it is.
        found: f64,
    },
    /// The observer asked to stop.
    #[error("interrupted")]
    Interrupted,
}

impl From<TooMany> for BuildError {
    fn from(TooMany { what, found, limit }: TooMany) -> Self {
        Self::TooLarge { what, found, limit }
    }
}

impl From<Stopped> for BuildError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Interrupted => Self::Interrupted,
            Stopped::TooLarge(too_many) => too_many.into(),
        }
    }
}
