//! The `.neph` file: its records and the rules between them. `SPEC.md` beside this crate is the
//! description; names here follow it.
//!
//! The engine writes a file by [`plan`]ning its sections and streaming them through a
//! [`ChunkHasher`]. It reads a file by checking its [`Directory`], which reads the first 16 KiB
//! only.

mod attribute;
mod checksum;
mod directory;
mod error;
mod header;
mod section;

pub use attribute::{
    AttributeEntry, AttributeRecord, MAX_ATTRIBUTE_NAMES_BYTES, MAX_ATTRIBUTES, read_attributes, scalar_code,
    scalar_from_code,
};
pub use checksum::{ChunkHasher, checksum, head_checksum};
pub use directory::{Directory, index_bytes, stamp_bytes};
pub use error::NephError;
pub use header::{CHUNK_BYTES, HEADER_BYTES, Header, MAGIC, MAX_HEAD_BYTES, MAX_LEVELS, VERSION};
pub use section::{
    MAX_DEVIATION_NAMES_BYTES, MAX_DEVIATIONS, MAX_METADATA_BYTES, Placement, REQUIRED, SECTION_ALIGNMENT,
    SECTION_RECORD_BYTES, SectionKind, SectionRecord, align, plan,
};

#[cfg(target_endian = "big")]
compile_error!("the records of a .neph file are little-endian and are read in place");
