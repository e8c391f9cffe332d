//! Why a build fails.

use crate::decimate::Stopped;
use crate::mesh::TooMany;
use nephrite_formats::MeshFault;

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
    /// The mesh contradicts itself.
    #[error("the mesh contradicts itself: {0}")]
    Mesh(#[from] MeshFault),
    /// More vertices or simplices than ids of 32 bits have room for: 2^31 - 1 vertices, 2^29 - 1
    /// simplices.
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
