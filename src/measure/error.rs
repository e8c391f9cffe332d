//! Why two meshes could not be compared.

use nephrite_formats::MeshFault;

/// One of the two meshes that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The mesh that is trusted.
    Reference,
    /// The mesh that is judged.
    Mesh,
}

impl std::fmt::Display for Side {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Self::Reference => "reference",
            Self::Mesh => "mesh",
        })
    }
}

/// Why [`measure`](super::measure) has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// A mesh has no surface to measure.
    #[error("the {side} has no triangles, {n_vertices} vertices alone are no surface")]
    NoTriangles {
        /// Which of the two meshes.
        side: Side,
        /// Its number of vertices.
        n_vertices: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} of the {side} uses vertex {vertex}, the mesh has {n_vertices}")]
    VertexOutOfRange {
        /// Which of the two meshes.
        side: Side,
        /// The triangle.
        triangle: usize,
        /// The index found.
        vertex: u32,
        /// What it must be below.
        n_vertices: usize,
    },
    /// A coordinate that a triangle uses is infinite or not a number.
    #[error("vertex {vertex} of the {side} is at {position:?}, which is not finite")]
    NotFinite {
        /// Which of the two meshes.
        side: Side,
        /// The vertex.
        vertex: u32,
        /// Where it is.
        position: [f64; 3],
    },
    /// A mesh contradicts itself elsewhere.
    #[error("the {side} contradicts itself: {fault}")]
    Inconsistent {
        /// Which of the two meshes.
        side: Side,
        /// The contradiction.
        fault: MeshFault,
    },
    /// The origin of a mesh is infinite or not a number.
    #[error("the origin of the {side} is {origin:?}, which is not finite")]
    OriginNotFinite {
        /// Which of the two meshes.
        side: Side,
        /// The origin found.
        origin: [f64; 3],
    },
    /// More vertices or triangles than 32-bit ids can number.
    #[error("{found} {what} of the {side}, there can be at most {limit}")]
    TooLarge {
        /// Which of the two meshes.
        side: Side,
        /// What is counted, in the plural.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The meshes are so far apart that squares of distances are not finite.
    #[error("coordinates reach {found:e}, at most {limit:e} can be measured")]
    TooFarApart {
        /// Largest coordinate about the reference's centre.
        found: f64,
        /// Largest coordinate that is accepted.
        limit: f64,
    },
    /// There is no mean of 0 samples.
    #[error("0 samples were asked for, at least 1 is needed")]
    NoSamples,
    /// The tolerance is not a number above zero.
    #[error("the tolerance is {found}, it must be a finite number above 0")]
    BadTolerance {
        /// The tolerance found.
        found: f64,
    },
}
