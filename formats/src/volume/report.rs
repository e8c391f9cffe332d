//! What a volume reader had to decide, drop or cut: nothing that changes the mesh goes unsaid.

use super::VolumeFormat;
use crate::error::quoted_name;
use serde::Serialize;

/// What happened while a volume was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct VolumeReport {
    /// The format the contents were read as.
    pub format: VolumeFormat,
    /// Hexahedra, prisms and pyramids cut into tetrahedra.
    pub n_solids_cut: usize,
    /// Cells with nodes on their edges, of which the corners are kept.
    pub n_cells_straightened: usize,
    /// Cells without a volume (points, lines, triangles, quadrilaterals), left out.
    pub n_cells_ignored: usize,
    /// Everything else worth knowing, in the order found.
    pub warnings: Vec<VolumeWarning>,
}

impl VolumeReport {
    /// A report in which nothing happened yet.
    pub(super) fn new(format: VolumeFormat) -> Self {
        Self { format, n_solids_cut: 0, n_cells_straightened: 0, n_cells_ignored: 0, warnings: Vec::new() }
    }
}

/// A decision of a volume reader that its user may care about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, thiserror::Error)]
#[serde(tag = "warning", rename_all = "snake_case")]
#[non_exhaustive]
pub enum VolumeWarning {
    /// Data of the file that belongs to cells, or to no vertex in particular, left out.
    #[error("{kind} {} is left out", quoted_name(.name))]
    DataIgnored {
        /// `cell data`, `field data` and the like.
        kind: &'static str,
        /// Its name in the file.
        name: String,
    },
    /// A field that has a value for every node of another number than the points, left out.
    #[error("field {} has {found} values for {expected} vertices and is left out", quoted_name(.name))]
    FieldLength {
        /// Its name.
        name: String,
        /// Tuples it has.
        found: u64,
        /// Vertices there are.
        expected: u64,
    },
    /// 64-bit integers kept in another type: `i32` where all fit, `f64` otherwise.
    #[error("field {} of 64-bit integers is kept as {scalar}", quoted_name(.name))]
    FieldNarrowed {
        /// Its name.
        name: String,
        /// The type it has now.
        scalar: &'static str,
    },
    /// A second field of the same name got another one.
    #[error("a second field {} is kept as {}", quoted_name(.name), quoted_name(.new_name))]
    FieldRenamed {
        /// The name both have in the file.
        name: String,
        /// The name the later one has now.
        new_name: String,
    },
    /// The file has a solution at other time steps or in other blocks that was not read.
    #[error("{what} is not read")]
    PartIgnored {
        /// What it is.
        what: String,
    },
}
