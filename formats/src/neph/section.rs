//! Sections: their kinds, their records in the directory, and where a writer puts them.

use super::{HEADER_BYTES, MAX_HEAD_BYTES, NephError};
use bytemuck::{Pod, Zeroable};

/// Every section begins at a multiple of this.
pub const SECTION_ALIGNMENT: u64 = 64;
/// Length of [`SectionRecord`].
pub const SECTION_RECORD_BYTES: usize = size_of::<SectionRecord>();
/// Flag of a section without which a file cannot be understood.
pub const REQUIRED: u32 = 1;
/// Largest metadata section.
pub const MAX_METADATA_BYTES: u64 = 1 << 20;

/// What a section holds. The numbers are part of the format and never change their meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum SectionKind {
    /// JSON object.
    Metadata = 1,
    /// `f64` per level.
    Errors = 2,
    /// `u32` per level: simplices alive.
    SimplexCounts = 3,
    /// `u32` per level: vertices that die later.
    VertexCounts = 4,
    /// `[f32; 3]` per vertex.
    Positions = 5,
    /// `u64` per level and one more.
    RunOffsets = 6,
    /// Two `u32` per run.
    Runs = 7,
    /// `n_corners` `u32` per slot.
    Simplices = 8,
    /// `u32` per slot.
    Stamps = 9,
    /// [`AttributeRecord`](super::AttributeRecord) per attribute.
    AttributeTable = 10,
    /// UTF-8.
    AttributeNames = 11,
    /// Attribute values, one attribute after the other.
    AttributeValues = 12,
    /// `u64` per chunk of the body.
    Checksums = 13,
    /// `u32` per vertex: the first level that has it.
    VertexBirths = 14,
    /// Compact form: `n_corners` indices for each distinct simplex, in the order of the first slot
    /// that holds it.
    DistinctSimplices = 15,
    /// Compact form: one bit per slot, in `u64` words, set if an earlier slot holds the same
    /// simplex.
    RepeatBits = 16,
    /// Compact form: one `u32` per set bit, the place of the simplex among the distinct ones.
    RepeatSources = 17,
    /// Compact form: a stamp per slot.
    CompactStamps = 18,
    /// UTF-8, each name ended by a zero byte.
    DeviationNames = 19,
    /// `f64` per level, one deviation after the other.
    Deviations = 20,
    /// Operations that lead from an empty mesh to the input, see `progressive_mesh` of the engine.
    Operations = 21,
}

/// Most deviations in one file.
pub const MAX_DEVIATIONS: u64 = 1024;
/// Most bytes that all names of deviations take together.
pub const MAX_DEVIATION_NAMES_BYTES: u64 = 64 * 1024;

impl SectionKind {
    /// Every kind of version 1, in the order of their numbers.
    pub const ALL: [Self; 21] = [
        Self::Metadata,
        Self::Errors,
        Self::SimplexCounts,
        Self::VertexCounts,
        Self::Positions,
        Self::RunOffsets,
        Self::Runs,
        Self::Simplices,
        Self::Stamps,
        Self::AttributeTable,
        Self::AttributeNames,
        Self::AttributeValues,
        Self::Checksums,
        Self::VertexBirths,
        Self::DistinctSimplices,
        Self::RepeatBits,
        Self::RepeatSources,
        Self::CompactStamps,
        Self::DeviationNames,
        Self::Deviations,
        Self::Operations,
    ];

    /// The sections that hold the slots in the plain form.
    pub const PLAIN: [Self; 2] = [Self::Simplices, Self::Stamps];

    /// The sections that hold the slots in the compact form.
    pub const COMPACT: [Self; 4] =
        [Self::DistinctSimplices, Self::RepeatBits, Self::RepeatSources, Self::CompactStamps];

    /// Number in the file.
    pub fn code(self) -> u32 {
        self as u32
    }

    /// Kind of a number; `None` if this version does not know it.
    pub fn from_code(code: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.code() == code)
    }

    /// Whether a file with this section cannot be read without understanding it.
    pub fn is_required(self) -> bool {
        !matches!(
            self,
            Self::AttributeTable
                | Self::AttributeNames
                | Self::AttributeValues
                | Self::VertexBirths
                | Self::DeviationNames
                | Self::Deviations
                | Self::Operations
        )
    }
}

/// One record of the directory.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct SectionRecord {
    /// Number of a [`SectionKind`], or one that a later version defines.
    pub kind: u32,
    /// [`REQUIRED`] or nothing.
    pub flags: u32,
    /// Where the section begins, a multiple of [`SECTION_ALIGNMENT`].
    pub offset: u64,
    /// Its length without padding.
    pub bytes: u64,
    /// Zero.
    pub reserved: u64,
}

/// The next multiple of [`SECTION_ALIGNMENT`]; saturates at `u64::MAX`.
pub fn align(offset: u64) -> u64 {
    offset.checked_next_multiple_of(SECTION_ALIGNMENT).unwrap_or(u64::MAX)
}

/// Where the sections of a new file go: the result of [`plan`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placement {
    /// Records in the order of their offsets, the checksum section last.
    pub records: Vec<SectionRecord>,
    /// First byte of the body.
    pub body_start: u64,
    /// Length of the file.
    pub file_bytes: u64,
}

/// Places sections of the given lengths one after the other and adds the checksum section at the
/// end.
///
/// # Errors
///
/// [`NephError::TooManySections`] if the directory would not fit in the head,
/// [`NephError::TooLarge`] if an offset would not fit in 64 bits.
pub fn plan(sections: &[(SectionKind, u64)], chunk_bytes: u64) -> Result<Placement, NephError> {
    let n_sections = sections.len() + 1;
    let head_bytes = HEADER_BYTES + n_sections * SECTION_RECORD_BYTES;
    if head_bytes > MAX_HEAD_BYTES {
        return Err(NephError::TooManySections { found: n_sections as u64 });
    }
    let body_start = align(head_bytes as u64);
    let mut end = body_start;
    let mut records = Vec::with_capacity(n_sections);
    let mut place = |kind: SectionKind, bytes: u64, end: &mut u64| -> Result<(), NephError> {
        let offset = align(*end);
        *end = offset.checked_add(bytes).ok_or(NephError::TooLarge)?;
        let flags = if kind.is_required() { REQUIRED } else { 0 };
        records.push(SectionRecord { kind: kind.code(), flags, offset, bytes, reserved: 0 });
        Ok(())
    };
    for &(kind, bytes) in sections {
        place(kind, bytes, &mut end)?;
    }
    let n_chunks = (align(end) - body_start).div_ceil(chunk_bytes);
    place(SectionKind::Checksums, n_chunks * 8, &mut end)?;
    Ok(Placement { records, body_start, file_bytes: end })
}
