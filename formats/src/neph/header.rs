//! The fixed header at the start of the file.

use bytemuck::{Pod, Zeroable};

/// First eight bytes of every file: a byte that is not text, the name, and line ends that a text
/// transfer would change.
pub const MAGIC: [u8; 8] = *b"\x89NEPH\r\n\x1a";
/// Version that this crate writes and reads.
pub const VERSION: u32 = 1;
/// Length of [`Header`].
pub const HEADER_BYTES: usize = size_of::<Header>();
/// Header and directory end before this offset.
pub const MAX_HEAD_BYTES: usize = 16 * 1024;
/// Most levels in one file.
pub const MAX_LEVELS: u64 = 1 << 31;
/// Bytes per checksummed chunk in files that the engine writes.
pub const CHUNK_BYTES: u64 = 1 << 20;

/// The first 192 bytes of a file. Every bit pattern is a valid value;
/// [`Directory::read`](super::Directory::read) checks the meaning.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: [u8; 8],
    /// [`VERSION`].
    pub version: u32,
    /// Records in the directory that follows.
    pub n_sections: u32,
    /// Length of the file.
    pub file_bytes: u64,
    /// Checksum of header and directory, taken with this field as zero.
    pub head_checksum: u64,
    /// Bytes per checksummed chunk of the body, a power of two.
    pub chunk_bytes: u64,
    /// Checksum of the checksum section.
    pub checksums_checksum: u64,
    /// Vertex indices per simplex: 3 for triangles, 4 for tetrahedra.
    pub n_corners: u32,
    /// Levels, at least one.
    pub n_levels: u32,
    /// Vertices that some level has.
    pub n_vertices: u64,
    /// Stored copies of simplices.
    pub n_slots: u64,
    /// Stored lifetimes; a simplex may have several.
    pub n_lifetimes: u64,
    /// Added to every position to give the coordinates of the input, in mesh units.
    pub origin: [f64; 3],
    /// Least coordinates over all vertices, relative to `origin`.
    pub bounds_min: [f32; 3],
    /// Largest coordinates over all vertices, relative to `origin`.
    pub bounds_max: [f32; 3],
    /// Largest distance between an input vertex and its stored position, in mesh units.
    pub rounding: f64,
    /// Zero.
    pub reserved: [u64; 7],
}
