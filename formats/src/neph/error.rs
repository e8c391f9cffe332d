//! What can be wrong with the head of a file.

use super::SectionKind;

/// Header, directory or attribute table break a rule of the format. Offsets and lengths are in
/// bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NephError {
    /// The file ends before the head does.
    #[error("file has {found} bytes where header and directory need {expected}")]
    Truncated {
        /// Bytes there are.
        found: u64,
        /// Bytes needed.
        expected: u64,
    },
    /// Not a `.neph` file.
    #[error("file begins with {found:02x?}, which is not the signature of a .neph file")]
    Magic {
        /// First eight bytes.
        found: [u8; 8],
    },
    /// Written by a later version.
    #[error("file has format version {found}, this reader knows {expected}")]
    Version {
        /// Version of the file.
        found: u32,
        /// Version of this crate.
        expected: u32,
    },
    /// The length in the header is not that of the file: it was truncated, or has bytes after its
    /// end.
    #[error("file has {found} bytes where its header says {expected}")]
    FileBytes {
        /// Length of the file.
        found: u64,
        /// Length in the header.
        expected: u64,
    },
    /// Header or directory are damaged.
    #[error("checksum of header and directory is {found:016x} where the header says {expected:016x}")]
    HeadChecksum {
        /// Checksum computed.
        found: u64,
        /// Checksum stored.
        expected: u64,
    },
    /// More sections than the head can hold.
    #[error("{found} sections do not fit in the first 16 KiB")]
    TooManySections {
        /// Sections asked for.
        found: u64,
    },
    /// A length beyond 64 bits.
    #[error("the file would be longer than 2^64 bytes")]
    TooLarge,
    /// The chunk length is no power of two in the allowed range.
    #[error("chunks of {found} bytes are not a power of two from 4 KiB to 1 GiB")]
    ChunkBytes {
        /// Value of the header.
        found: u64,
    },
    /// A count of the header is outside its range.
    #[error("header field {field} is {found}, allowed are {min} to {max}")]
    Count {
        /// Name of the field.
        field: &'static str,
        /// Its value.
        found: u64,
        /// Least allowed.
        min: u64,
        /// Largest allowed.
        max: u64,
    },
    /// Origin, bounds or rounding are not finite, or bounds are reversed.
    #[error("header field {field} is not finite or out of order")]
    Geometry {
        /// Name of the field.
        field: &'static str,
    },
    /// A field that must be zero is not.
    #[error("reserved bits of {place} are set")]
    Reserved {
        /// `header`, `directory` or `the padding after the directory`.
        place: &'static str,
    },
    /// The reader does not know a section it must understand.
    #[error("section of unknown kind {kind} is required to read the file")]
    UnknownRequired {
        /// Number of the kind.
        kind: u32,
    },
    /// A kind occurs twice.
    #[error("section kind {kind} occurs twice")]
    Duplicate {
        /// Number of the kind.
        kind: u32,
    },
    /// A required section is not there.
    #[error("section {kind:?} is missing")]
    Missing {
        /// Its kind.
        kind: SectionKind,
    },
    /// Slots in the plain form and in the compact form, or in neither.
    #[error("slots are in {found} forms, expected either the plain or the compact one")]
    Forms {
        /// Forms of which a section is there.
        found: u32,
    },
    /// Sections overlap, leave a hole, are not in order or do not end with the file.
    #[error("section of kind {kind} begins at byte {found} instead of {expected}")]
    Coverage {
        /// Number of the kind, 0 for the end of the file.
        kind: u32,
        /// Offset found.
        found: u64,
        /// Offset that leaves neither hole nor overlap.
        expected: u64,
    },
    /// A section's length contradicts the header.
    #[error("section {kind:?} has {found} bytes, the header's counts give {expected}")]
    SectionBytes {
        /// Its kind.
        kind: SectionKind,
        /// Its length.
        found: u64,
        /// Length by the header, or the largest allowed.
        expected: u64,
    },
    /// The checksum section is not the last one.
    #[error("checksum section is not the last")]
    ChecksumsNotLast,
    /// A record of the attribute table is wrong.
    #[error("attribute {index}: field {field} is {found}, expected {expected}")]
    Attribute {
        /// Which record.
        index: u64,
        /// Name of the field.
        field: &'static str,
        /// Its value.
        found: u64,
        /// Value by the rules, or the largest allowed.
        expected: u64,
    },
    /// The name of an attribute is not UTF-8 or occurs twice.
    #[error("name of attribute {index} is not UTF-8 or occurs twice")]
    AttributeName {
        /// Which record.
        index: u64,
    },
}
