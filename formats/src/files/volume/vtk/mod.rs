//! Legacy VTK files of unstructured grids: text or big-endian binary, versions 1 to 5.1.
//!
//! Reference: Kitware, "VTK File Formats" (the legacy section), and for version 5.1 the note "VTK
//! legacy reader/writer information".

mod cell_type;
mod read;
mod source;
mod write;

pub(super) use cell_type::{TETRAHEDRON, kind_of};
pub(super) use read::read;
pub(super) use write::write;
