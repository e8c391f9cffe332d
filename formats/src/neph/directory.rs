//! Reads the head of a file: header and directory, checked against each other and against the
//! length of the file.

use super::{
    HEADER_BYTES, Header, MAGIC, MAX_ATTRIBUTE_NAMES_BYTES, MAX_ATTRIBUTES, MAX_DEVIATION_NAMES_BYTES,
    MAX_DEVIATIONS, MAX_HEAD_BYTES, MAX_LEVELS, MAX_METADATA_BYTES, NephError, REQUIRED,
    SECTION_RECORD_BYTES, SectionKind, SectionRecord, VERSION, align, head_checksum,
};
use std::ops::Range;

/// Header and sections of a file whose head is valid: sections cover the file exactly and have the
/// lengths that the counts of the header give. The contents of the sections are not checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Directory {
    header: Header,
    body_start: u64,
    /// Byte range of each kind, at `code - 1`; empty for an optional section that the file does not
    /// have.
    ranges: [(u64, u64); SectionKind::ALL.len()],
    is_compact: bool,
}

impl Directory {
    /// Reads and checks header and directory. `head` is the beginning of the file, at least its
    /// first 16 KiB or all of it; `file_bytes` is the length of the file. Cost does not depend on
    /// that length.
    ///
    /// # Errors
    ///
    /// The first rule of the format that does not hold.
    pub fn read(head: &[u8], file_bytes: u64) -> Result<Self, NephError> {
        let header = read_header(head, file_bytes)?;
        let records = read_records(head, &header)?;
        check_counts(&header)?;
        check_geometry(&header)?;
        let body_start = align((HEADER_BYTES + records.len() * SECTION_RECORD_BYTES) as u64);
        check_coverage(&records, body_start, file_bytes)?;
        let (ranges, is_compact) = known_ranges(&records)?;
        let directory = Self { header, body_start, ranges, is_compact };
        directory.check_section_bytes()?;
        directory.check_slot_bytes()?;
        Ok(directory)
    }

    /// The header.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Offset and length of a section; length 0 if an optional section is not in the file.
    pub fn section(&self, kind: SectionKind) -> (u64, u64) {
        self.ranges[kind as usize - 1]
    }

    /// Whether the slots are in the compact form.
    pub fn is_compact(&self) -> bool {
        self.is_compact
    }

    /// Simplices that the compact form holds; 0 in the plain form.
    pub fn n_distinct(&self) -> u64 {
        let bytes = u64::from(self.header.n_corners) * index_bytes(self.header.n_vertices);
        self.section(SectionKind::DistinctSimplices).1 / bytes
    }

    /// The checksummed part of the file: from the first section to the checksum section.
    pub fn body(&self) -> Range<u64> {
        self.body_start..self.section(SectionKind::Checksums).0
    }

    fn check_section_bytes(&self) -> Result<(), NephError> {
        let header = &self.header;
        let n_levels = u64::from(header.n_levels);
        // Counts are below 2^32 and widths small, so no product here exceeds 64 bits.
        let exact = [
            (SectionKind::Errors, 8 * n_levels),
            (SectionKind::SimplexCounts, 4 * n_levels),
            (SectionKind::VertexCounts, 4 * n_levels),
            (SectionKind::Positions, 12 * header.n_vertices),
            (SectionKind::RunOffsets, 8 * (n_levels + 1)),
            (SectionKind::Checksums, 8 * (self.body().end - self.body().start).div_ceil(header.chunk_bytes)),
        ];
        let at_most = [
            (SectionKind::Metadata, MAX_METADATA_BYTES, 1),
            (SectionKind::Runs, 8 * 32 * n_levels, 8),
            (SectionKind::AttributeTable, 32 * MAX_ATTRIBUTES, 32),
            (SectionKind::AttributeNames, MAX_ATTRIBUTE_NAMES_BYTES, 1),
            (SectionKind::DeviationNames, MAX_DEVIATION_NAMES_BYTES, 1),
            (SectionKind::Deviations, 8 * MAX_DEVIATIONS * n_levels, 8 * n_levels),
        ];
        for (kind, expected) in exact {
            let found = self.section(kind).1;
            if found != expected {
                return Err(NephError::SectionBytes { kind, found, expected });
            }
        }
        let (kind, expected) = (SectionKind::VertexBirths, 4 * header.n_vertices);
        let found = self.section(kind).1;
        if found != 0 && found != expected {
            return Err(NephError::SectionBytes { kind, found, expected });
        }
        for (kind, largest, record_bytes) in at_most {
            let found = self.section(kind).1;
            if found > largest || !found.is_multiple_of(record_bytes) {
                return Err(NephError::SectionBytes { kind, found, expected: largest });
            }
        }
        Ok(())
    }

    /// Checks that there are as many slots as the header says, in either form.
    fn check_slot_bytes(&self) -> Result<(), NephError> {
        let Header { n_slots, n_corners, n_vertices, n_levels, .. } = self.header;
        let n_corners = u64::from(n_corners);
        let exact = if self.is_compact {
            let n_distinct = self.n_distinct();
            vec![
                (SectionKind::DistinctSimplices, n_corners * index_bytes(n_vertices) * n_distinct),
                (SectionKind::RepeatBits, 8 * n_slots.div_ceil(64)),
                (SectionKind::RepeatSources, 4 * n_slots.saturating_sub(n_distinct)),
                (SectionKind::CompactStamps, stamp_bytes(n_levels) * n_slots),
            ]
        } else {
            vec![(SectionKind::Simplices, 4 * n_corners * n_slots), (SectionKind::Stamps, 4 * n_slots)]
        };
        for (kind, expected) in exact {
            let found = self.section(kind).1;
            if found != expected {
                return Err(NephError::SectionBytes { kind, found, expected });
            }
        }
        Ok(())
    }
}

/// Bytes of a vertex index in the compact form.
pub fn index_bytes(n_vertices: u64) -> u64 {
    if n_vertices <= 1 << 16 { 2 } else { 4 }
}

/// Bytes of a stamp in the compact form. A stamp is a level, or the number of levels.
pub fn stamp_bytes(n_levels: u32) -> u64 {
    if n_levels <= u32::from(u16::MAX) { 2 } else { 4 }
}

fn read_header(head: &[u8], file_bytes: u64) -> Result<Header, NephError> {
    let Some(bytes) = head.get(..HEADER_BYTES) else {
        // For a short file of another kind, the wrong signature is the better error than the
        // length.
        if let Some(&found) = head.first_chunk::<8>().filter(|found| **found != MAGIC) {
            return Err(NephError::Magic { found });
        }
        return Err(NephError::Truncated { found: head.len() as u64, expected: HEADER_BYTES as u64 });
    };
    let header: Header = bytemuck::pod_read_unaligned(bytes);
    if header.magic != MAGIC {
        return Err(NephError::Magic { found: header.magic });
    }
    if header.version != VERSION {
        return Err(NephError::Version { found: header.version, expected: VERSION });
    }
    if header.file_bytes != file_bytes {
        return Err(NephError::FileBytes { found: file_bytes, expected: header.file_bytes });
    }
    Ok(header)
}

fn read_records(head: &[u8], header: &Header) -> Result<Vec<SectionRecord>, NephError> {
    let head_bytes = HEADER_BYTES as u64 + u64::from(header.n_sections) * SECTION_RECORD_BYTES as u64;
    if head_bytes > MAX_HEAD_BYTES as u64 {
        return Err(NephError::TooManySections { found: u64::from(header.n_sections) });
    }
    let records = usize::try_from(head_bytes).ok().and_then(|end| head.get(HEADER_BYTES..end));
    let Some(records) = records else {
        return Err(NephError::Truncated { found: head.len() as u64, expected: head_bytes });
    };
    let found = head_checksum(header, records);
    if found != header.head_checksum {
        return Err(NephError::HeadChecksum { found, expected: header.head_checksum });
    }
    let records: Vec<SectionRecord> = bytemuck::pod_collect_to_vec(records);
    if header.reserved != [0; 7] {
        return Err(NephError::Reserved { place: "header" });
    }
    if records.iter().any(|record| record.reserved != 0 || record.flags & !REQUIRED != 0) {
        return Err(NephError::Reserved { place: "directory" });
    }
    let padding = usize::try_from(align(head_bytes)).map_or(&[][..], |end| &head[..end.min(head.len())]);
    if padding.iter().skip(HEADER_BYTES + records.len() * SECTION_RECORD_BYTES).any(|&byte| byte != 0) {
        return Err(NephError::Reserved { place: "the padding after the directory" });
    }
    Ok(records)
}

fn check_counts(header: &Header) -> Result<(), NephError> {
    let max = u64::from(u32::MAX);
    if !header.chunk_bytes.is_power_of_two() || !(1 << 12..=1 << 30).contains(&header.chunk_bytes) {
        return Err(NephError::ChunkBytes { found: header.chunk_bytes });
    }
    let ranges = [
        ("n_corners", u64::from(header.n_corners), 3, 4),
        ("n_levels", u64::from(header.n_levels), 1, MAX_LEVELS),
        ("n_vertices", header.n_vertices, 0, max),
        ("n_slots", header.n_slots, 0, max),
        ("n_lifetimes", header.n_lifetimes, header.n_slots.div_ceil(2), header.n_slots),
    ];
    for (field, found, min, max) in ranges {
        if !(min..=max).contains(&found) {
            return Err(NephError::Count { field, found, min, max });
        }
    }
    Ok(())
}

fn check_geometry(header: &Header) -> Result<(), NephError> {
    if !header.origin.iter().all(|x| x.is_finite()) {
        return Err(NephError::Geometry { field: "origin" });
    }
    if !(header.rounding.is_finite() && header.rounding >= 0.0) {
        return Err(NephError::Geometry { field: "rounding" });
    }
    let in_order = header.bounds_min.iter().zip(&header.bounds_max).all(|(min, max)| min <= max);
    let finite = header.bounds_min.iter().chain(&header.bounds_max).all(|x| x.is_finite());
    if !in_order || !finite {
        return Err(NephError::Geometry { field: "bounds" });
    }
    Ok(())
}

fn check_coverage(records: &[SectionRecord], body_start: u64, file_bytes: u64) -> Result<(), NephError> {
    let mut end = body_start;
    for record in records {
        let expected = align(end);
        if record.offset != expected {
            return Err(NephError::Coverage { kind: record.kind, found: record.offset, expected });
        }
        end = record.offset.checked_add(record.bytes).ok_or(NephError::TooLarge)?;
    }
    if end != file_bytes {
        return Err(NephError::Coverage { kind: 0, found: end, expected: file_bytes });
    }
    let is_last = records.last().is_some_and(|record| record.kind == SectionKind::Checksums.code());
    if is_last { Ok(()) } else { Err(NephError::ChecksumsNotLast) }
}

/// Byte range of every kind, and whether the slots are in the compact form.
fn known_ranges(
    records: &[SectionRecord],
) -> Result<([(u64, u64); SectionKind::ALL.len()], bool), NephError> {
    let mut found = [None; SectionKind::ALL.len()];
    for (index, record) in records.iter().enumerate() {
        if records[..index].iter().any(|earlier| earlier.kind == record.kind) {
            return Err(NephError::Duplicate { kind: record.kind });
        }
        match SectionKind::from_code(record.kind) {
            Some(kind) => found[kind as usize - 1] = Some((record.offset, record.bytes)),
            None if record.flags & REQUIRED != 0 => {
                return Err(NephError::UnknownRequired { kind: record.kind });
            }
            None => {}
        }
    }
    let has_any = |kinds: &[SectionKind]| kinds.iter().any(|&kind| found[kind as usize - 1].is_some());
    let is_compact = has_any(&SectionKind::COMPACT);
    let n_forms = u32::from(has_any(&SectionKind::PLAIN)) + u32::from(is_compact);
    if n_forms != 1 {
        return Err(NephError::Forms { found: n_forms });
    }
    let other_form: &[SectionKind] = if is_compact { &SectionKind::PLAIN } else { &SectionKind::COMPACT };
    let mut ranges = [(0, 0); SectionKind::ALL.len()];
    for kind in SectionKind::ALL {
        ranges[kind as usize - 1] = match found[kind as usize - 1] {
            Some(range) => range,
            None if kind.is_required() && !other_form.contains(&kind) => {
                return Err(NephError::Missing { kind });
            }
            None => (0, 0),
        };
    }
    Ok((ranges, is_compact))
}
