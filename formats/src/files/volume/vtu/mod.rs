//! VTU files: VTK's XML of unstructured grids, with arrays as text, as base64 or appended raw,
//! plain or compressed by zlib, LZ4 or LZMA.
//!
//! Reference: Kitware, "VTK XML formats" (VTK documentation, details on the file formats).

mod arrays;
mod compression;
mod document;
mod piece;
mod read;
mod write;

pub(super) use read::read;
pub(super) use write::write;
