//! The content of a new file: which sections it has, how long each is, and what is streamed into
//! it.

use super::arrange::VertexOrder;
use super::attributes::AttributeSections;
use super::body::BodyWriter;
use super::compact::CompactSlots;
use super::pieces::Pieces;
use super::{NO_BOUND, StoreReport, Vertices};
use crate::History;
use crate::geometry::bounds::Bounds;
use crate::geometry::vector::widen;
use crate::history::Levels;
use crate::tree::{Layout, Run};
use nephrite_formats::neph::{self, CHUNK_BYTES, Header, MAGIC, Placement, SectionKind, VERSION};
use std::io::{self, Seek, SeekFrom, Write};

/// Everything that goes into the file, most of it by reference and in the order of the input.
pub(super) struct Content<'a, const CORNERS: usize> {
    pub(super) mesh: Vertices<'a>,
    pub(super) history: &'a History<CORNERS>,
    pub(super) levels: &'a Levels,
    pub(super) pieces: Pieces<'a, CORNERS>,
    pub(super) layout: Layout,
    pub(super) compact: Option<CompactSlots>,
    pub(super) vertices: VertexOrder,
    pub(super) run_offsets: Vec<u64>,
    pub(super) runs: Vec<Run>,
    pub(super) metadata: Vec<u8>,
    pub(super) deviation_names: Vec<u8>,
    pub(super) attributes: AttributeSections,
    pub(super) operations: &'a [u8],
}

impl<const CORNERS: usize> Content<'_, CORNERS> {
    /// Sections in the order of the file, small ones first.
    pub(super) fn section_bytes(&self) -> Vec<(SectionKind, u64)> {
        let n_levels = self.levels.steps().len() as u64;
        let n_slots = self.layout.slots().len() as u64;
        let mut sections = vec![
            (SectionKind::Metadata, self.metadata.len() as u64),
            (SectionKind::Errors, 8 * n_levels),
            (SectionKind::SimplexCounts, 4 * n_levels),
            (SectionKind::VertexCounts, 4 * n_levels),
            (SectionKind::RunOffsets, 8 * (n_levels + 1)),
            (SectionKind::Runs, 8 * self.runs.len() as u64),
        ];
        if !self.history.deviations.is_empty() {
            sections.push((SectionKind::DeviationNames, self.deviation_names.len() as u64));
            sections.push((SectionKind::Deviations, 8 * n_levels * self.history.deviations.len() as u64));
        }
        if !self.attributes.table.is_empty() {
            sections.push((SectionKind::AttributeTable, size_of_val(&self.attributes.table[..]) as u64));
            sections.push((SectionKind::AttributeNames, self.attributes.names.len() as u64));
        }
        let n_vertices = self.vertices.order.len() as u64;
        if !self.vertices.births.is_empty() {
            sections.push((SectionKind::VertexBirths, 4 * n_vertices));
        }
        sections.push((SectionKind::Positions, 12 * n_vertices));
        if !self.attributes.table.is_empty() {
            sections.push((SectionKind::AttributeValues, self.attributes.values_bytes));
        }
        sections.extend(self.slot_section_bytes(n_vertices, n_slots));
        if !self.operations.is_empty() {
            sections.push((SectionKind::Operations, self.operations.len() as u64));
        }
        sections
    }

    /// The sections that hold the slots, in one form or the other.
    fn slot_section_bytes(&self, n_vertices: u64, n_slots: u64) -> Vec<(SectionKind, u64)> {
        let n_corners = CORNERS as u64;
        let Some(CompactSlots { distinct, repeat_bits, repeat_sources }) = &self.compact else {
            return vec![
                (SectionKind::Simplices, 4 * n_corners * n_slots),
                (SectionKind::Stamps, 4 * n_slots),
            ];
        };
        let corners_bytes = neph::index_bytes(n_vertices) * n_corners;
        vec![
            (SectionKind::DistinctSimplices, corners_bytes * distinct.len() as u64),
            (SectionKind::RepeatBits, 8 * repeat_bits.len() as u64),
            (SectionKind::RepeatSources, 4 * repeat_sources.len() as u64),
            (SectionKind::CompactStamps, neph::stamp_bytes(self.levels.n_levels()) * n_slots),
        ]
    }

    /// Streams body, checksums and head, in that order, to an empty stream.
    pub(super) fn stream_to(
        &self,
        stream: &mut (impl Write + Seek),
        placement: &Placement,
    ) -> io::Result<()> {
        let mut body = BodyWriter::begin(&mut *stream, placement.body_start)?;
        for record in &placement.records {
            body.pad_to(record.offset)?;
            if let Some(kind) = SectionKind::from_code(record.kind) {
                self.stream_section(kind, &mut body)?;
            }
        }
        let checksums = body.finish()?;
        let checksums: &[u8] = bytemuck::cast_slice(&checksums);
        stream.write_all(checksums)?;

        let directory: &[u8] = bytemuck::cast_slice(&placement.records);
        let mut header = self.header(placement);
        header.checksums_checksum = neph::checksum(checksums);
        header.head_checksum = neph::head_checksum(&header, directory);
        stream.seek(SeekFrom::Start(0))?;
        stream.write_all(bytemuck::bytes_of(&header))?;
        stream.write_all(directory)?;
        stream.flush()
    }

    fn stream_section(&self, kind: SectionKind, body: &mut BodyWriter<impl Write>) -> io::Result<()> {
        match kind {
            SectionKind::Metadata => body.put(&self.metadata),
            SectionKind::Errors => body.put_each(self.errors().map(|error| error.min(NO_BOUND))),
            SectionKind::SimplexCounts => body.put(bytemuck::cast_slice(self.levels.simplex_counts())),
            SectionKind::VertexCounts => body.put(bytemuck::cast_slice(&self.vertices.counts)),
            SectionKind::VertexBirths => body.put(bytemuck::cast_slice(&self.vertices.births)),
            SectionKind::DeviationNames => body.put(&self.deviation_names),
            SectionKind::Deviations => body.put_each(self.deviations()),
            SectionKind::RunOffsets => body.put(bytemuck::cast_slice(&self.run_offsets)),
            SectionKind::Runs => body.put(bytemuck::cast_slice(&self.runs)),
            SectionKind::AttributeTable => body.put(bytemuck::cast_slice(&self.attributes.table)),
            SectionKind::AttributeNames => body.put(&self.attributes.names),
            SectionKind::Operations => body.put(self.operations),
            SectionKind::AttributeValues => self.stream_attribute_values(body),
            SectionKind::Positions => body.put_each(self.positions()),
            SectionKind::Simplices => body.put_each(self.corners(self.layout.slots())),
            SectionKind::Stamps => body.put_each(self.stamps()),
            SectionKind::CompactStamps => {
                put_narrow(body, neph::stamp_bytes(self.levels.n_levels()), self.stamps())
            }
            SectionKind::DistinctSimplices | SectionKind::RepeatBits | SectionKind::RepeatSources => {
                self.compact.as_ref().map_or(Ok(()), |compact| self.stream_compact(compact, kind, body))
            }
            // Known only when the body is written.
            SectionKind::Checksums => Ok(()),
        }
    }

    fn stream_compact(
        &self,
        compact: &CompactSlots,
        kind: SectionKind,
        body: &mut BodyWriter<impl Write>,
    ) -> io::Result<()> {
        match kind {
            SectionKind::RepeatBits => body.put(bytemuck::cast_slice(&compact.repeat_bits)),
            SectionKind::RepeatSources => body.put(bytemuck::cast_slice(&compact.repeat_sources)),
            _ => {
                let width = neph::index_bytes(self.vertices.order.len() as u64);
                put_narrow(body, width, self.corners(&compact.distinct))
            }
        }
    }

    /// Vertices of pieces, as the file numbers them.
    fn corners(&self, ids: &[u32]) -> impl Iterator<Item = u32> {
        ids.iter().flat_map(|&id| self.pieces.vertices(id).map(|vertex| self.vertices.rank[vertex as usize]))
    }

    /// Positions of the vertices in the order of the file.
    fn positions(&self) -> impl Iterator<Item = [f32; 3]> + '_ {
        self.vertices.order.iter().map(|&vertex| self.mesh.positions[vertex as usize])
    }

    /// Error of each level; infinite where no bound is stated.
    fn errors(&self) -> impl Iterator<Item = f64> + '_ {
        self.levels.steps().iter().map(|&step| self.history.errors[step as usize])
    }

    fn deviations(&self) -> impl Iterator<Item = f64> + '_ {
        let steps = self.levels.steps();
        let values = self.history.deviations.iter().map(|deviation| &deviation.values);
        values.flat_map(move |values| steps.iter().map(move |&step| values[step as usize]))
    }

    fn stamps(&self) -> impl Iterator<Item = u32> + '_ {
        self.layout.groups().flat_map(move |(group, slots)| {
            let ids = self.layout.slots()[slots].iter();
            ids.filter_map(move |&id| self.pieces.lifetime(id).map(|lifetime| group.stored_stamp(lifetime)))
        })
    }

    fn stream_attribute_values(&self, body: &mut BodyWriter<impl Write>) -> io::Result<()> {
        let section_start = body.position();
        for (attribute, record) in self.mesh.attributes.iter().zip(&self.attributes.table) {
            body.pad_to(section_start + record.values_offset)?;
            let stride = attribute.stride_bytes();
            for &vertex in &self.vertices.order {
                let start = vertex as usize * stride;
                body.put(&attribute.bytes[start..start + stride])?;
            }
        }
        Ok(())
    }

    /// The header without its checksums.
    fn header(&self, placement: &Placement) -> Header {
        let (bounds_min, bounds_max) = Bounds::around(self.positions().map(widen)).to_f32();
        let n_sections = u32::try_from(placement.records.len()).unwrap_or(u32::MAX);
        Header {
            magic: MAGIC,
            version: VERSION,
            n_sections,
            file_bytes: placement.file_bytes,
            head_checksum: 0,
            chunk_bytes: CHUNK_BYTES,
            checksums_checksum: 0,
            n_corners: u32::try_from(CORNERS).unwrap_or(u32::MAX),
            n_levels: self.levels.n_levels(),
            n_vertices: self.vertices.order.len() as u64,
            n_slots: self.layout.slots().len() as u64,
            n_lifetimes: u64::from(self.layout.n_lifetimes()),
            origin: self.mesh.origin,
            bounds_min,
            bounds_max,
            rounding: self.mesh.rounding,
            reserved: [0; 7],
        }
    }

    /// What was written.
    pub(super) fn report(&self, placement: &Placement) -> StoreReport {
        // Counts were checked to be below 2^32 by history and layout.
        let count = |len: usize| u32::try_from(len).unwrap_or(u32::MAX);
        StoreReport {
            n_levels: self.levels.n_levels(),
            n_lifetimes: self.layout.n_lifetimes(),
            n_slots: count(self.layout.slots().len()),
            n_vertices: count(self.vertices.order.len()),
            n_coarsest: self.levels.simplex_counts().last().copied().unwrap_or(0),
            max_error: self.errors().last().unwrap_or(0.0),
            file_bytes: placement.file_bytes,
        }
    }
}

/// Numbers that fit in `width` bytes, 2 or 4.
fn put_narrow(
    body: &mut BodyWriter<impl Write>,
    width: u64,
    numbers: impl Iterator<Item = u32>,
) -> io::Result<()> {
    match width {
        2 => body.put_each(numbers.map(|number| u16::try_from(number).unwrap_or(u16::MAX))),
        _ => body.put_each(numbers),
    }
}
