//! What a reader had to decide, drop or fill in: nothing that changes the mesh goes unsaid.

use serde::Serialize;

use crate::MeshFormat;
use crate::error::quoted_name;

/// What happened while a mesh was read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReadReport {
    /// The format the contents were read as.
    pub format: MeshFormat,
    /// Faces with four corners or more, cut into triangles.
    pub n_polygons_triangulated: usize,
    /// Those among them that self-intersect or have no plane, so that some of their triangles fold over.
    pub n_polygons_folded: usize,
    /// Faces with fewer than three corners, dropped.
    pub n_faces_dropped: usize,
    /// Things of the file that are neither vertices nor faces (points, lines, groups, materials, edges), skipped.
    pub n_ignored_elements: usize,
    /// Corners joined with an earlier corner at exactly the same position (STL, which has no shared vertices).
    pub n_welded: usize,
    /// Everything else worth knowing, in the order found.
    pub warnings: Vec<Warning>,
}

impl ReadReport {
    /// A report in which nothing happened yet.
    pub(crate) fn new(format: MeshFormat) -> Self {
        Self {
            format,
            n_polygons_triangulated: 0,
            n_polygons_folded: 0,
            n_faces_dropped: 0,
            n_ignored_elements: 0,
            n_welded: 0,
            warnings: Vec::new(),
        }
    }
}

/// A decision of a reader that its user may care about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, thiserror::Error)]
#[serde(tag = "warning", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Warning {
    /// The extension names another format than the contents are in; the contents were believed.
    #[error("the extension says {extension}, the contents are {format}")]
    ExtensionDisagrees {
        /// Format that the extension names.
        extension: MeshFormat,
        /// Format that the contents have.
        format: MeshFormat,
    },
    /// Bytes after the end of the mesh, left unread.
    #[error("{n_bytes} bytes follow the mesh and are ignored")]
    TrailingBytes {
        /// How many.
        n_bytes: u64,
    },
    /// Lines that hold more than was announced for them; the rest of each was left unread.
    #[error("the rest of {n_lines} lines is ignored")]
    LineRestIgnored {
        /// How many lines.
        n_lines: usize,
    },
    /// Vertex data that cannot be an attribute, left out.
    #[error("vertex attribute {} is left out: {reason}", quoted_name(.name))]
    AttributeDropped {
        /// Its name in the file.
        name: String,
        /// Why.
        reason: String,
    },
    /// Vertices for which the file does not give an attribute that others have got its neutral value.
    #[error("attribute {} is absent at {n_vertices} vertices and filled with its neutral value", quoted_name(.name))]
    AttributeFilled {
        /// The attribute.
        name: String,
        /// How many vertices were filled.
        n_vertices: usize,
    },
    /// Data that belongs to faces, left out.
    #[error("face data {} is left out", quoted_name(.name))]
    FaceDataIgnored {
        /// Its name in the file.
        name: String,
    },
    /// A feature of the format that moves or deforms vertices and was not applied.
    #[error("{feature} is not applied")]
    FeatureIgnored {
        /// What it is.
        feature: String,
    },
}
