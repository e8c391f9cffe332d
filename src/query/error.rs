//! Why a query has no answer.

/// A cut cannot be handed out in the form asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum QueryError {
    /// The caller's buffer is too small.
    #[error("buffer has room for {found} indices, the cut needs {expected}")]
    BufferTooSmall {
        /// Length of the buffer.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// The file holds simplices of another kind.
    #[error("file holds simplices with {found} corners, not triangles")]
    NotTriangles {
        /// Corners per simplex.
        found: u32,
    },
    /// The file holds simplices of another kind.
    #[error("file holds simplices with {found} corners, not tetrahedra")]
    NotTetrahedra {
        /// Corners per simplex.
        found: u32,
    },
    /// The file is damaged: a vertex index is outside the vertices of the level.
    #[error("file is damaged: vertex index {found} at a level of {vertex_count} vertices")]
    VertexIndex {
        /// The index.
        found: u32,
        /// Vertices of the level.
        vertex_count: usize,
    },
    /// The file is damaged: a position is not finite.
    #[error("file is damaged: position of vertex {vertex} is not finite")]
    Position {
        /// Which vertex.
        vertex: usize,
    },
}
