//! Writing: everything is laid out first, then streamed in one pass, and the head is filled in at the end.

use super::arrange::VertexOrder;
use super::attributes::AttributeSections;
use super::body::BodyWriter;
use super::compact::CompactSlots;
use super::pieces::Pieces;
use super::{Metadata, Provenance, Vertices, WriteError};
use crate::History;
use crate::geometry::morton::{Grid, bounds};
use crate::history::Levels;
use crate::tree::{Layout, Run};
use crate::vertex_cache::FanOrder;
use nephrite_formats::neph::{
    self, CHUNK_BYTES, Header, MAGIC, MAX_DEVIATION_NAMES_BYTES, MAX_DEVIATIONS, MAX_METADATA_BYTES,
    Placement, SectionKind, VERSION,
};
use std::io::{self, Seek, SeekFrom, Write};

/// What a file is to keep of a history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoreOptions {
    /// Most levels; `None` for as many as [`LEVEL_RATIO`](crate::history::LEVEL_RATIO) gives.
    pub levels: Option<u32>,
    /// Levels per window, rounded up to a power of two: lifetimes are cut at the borders of windows, so that fewer vertices
    /// are transformed when a level is drawn as runs. With the usual levels some 1.1 per triangle for 16 instead of 1.8, and
    /// 0.9 for 8, in files 1.8 and 2.8 times as long. `None` for no windows.
    pub window_levels: Option<u32>,
    /// Each simplex once, with narrow indices and stamps: a file of a third to two thirds the length, which a reader lays
    /// out in memory when it opens it, whereas slots in the plain form are used where they lie.
    pub is_compact: bool,
}

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct StoreReport {
    /// Levels of the file.
    pub n_levels: u32,
    /// Stored lifetimes; a simplex may have several.
    pub n_lifetimes: u32,
    /// Stored copies of simplices.
    pub n_slots: u32,
    /// Vertices that some level has.
    pub n_vertices: u32,
    /// Simplices of the coarsest level.
    pub n_coarsest: u32,
    /// Error of the coarsest level, in mesh units.
    pub max_error: f64,
    /// Length of the file.
    pub file_bytes: u64,
}

/// Writes a whole file to an empty stream.
///
/// Memory: 4 bytes per slot and 8 per vertex, beside mesh and history. The same input gives the same bytes on any number
/// of threads. [`write`](super::write()) does the same to a path, safely.
///
/// # Errors
///
/// [`WriteError`] when the history or an attribute does not fit the mesh, when the file would exceed a limit of the format,
/// or when the stream refuses.
pub fn write_to<'a, const CORNERS: usize>(
    stream: &mut (impl Write + Seek),
    mesh: impl Into<Vertices<'a>>,
    history: &History<CORNERS>,
    provenance: &Provenance,
    options: &StoreOptions,
) -> Result<StoreReport, WriteError> {
    write_to_with(stream, mesh, history, provenance, options, &[])
}

/// As [`write_to`], with an [operation stream](crate::progressive_mesh) as a section of its own; none where it is empty.
///
/// # Errors
///
/// As [`write_to`].
pub fn write_to_with<'a, const CORNERS: usize>(
    stream: &mut (impl Write + Seek),
    mesh: impl Into<Vertices<'a>>,
    history: &History<CORNERS>,
    provenance: &Provenance,
    options: &StoreOptions,
    operations: &[u8],
) -> Result<StoreReport, WriteError> {
    let mesh = mesh.into();
    check_mesh(mesh, history)?;
    history.check()?;
    let levels = Levels::choose(history, options.levels)?;
    let pieces = Pieces::new(history, &levels, options.window_levels)?;
    let layout = lay_out(mesh, &pieces)?;
    let vertices = VertexOrder::new(mesh, history, &levels);
    let (run_offsets, runs) = layout.runs();
    let metadata = metadata_bytes(provenance)?;
    let attributes = AttributeSections::new(mesh, vertices.order.len())?;
    let compact = options.is_compact.then(|| CompactSlots::new(layout.slots(), &pieces));
    let content = Content {
        mesh,
        history,
        levels: &levels,
        pieces,
        layout,
        compact,
        vertices,
        run_offsets,
        runs,
        metadata,
        deviation_names: deviation_names(history)?,
        attributes,
        operations,
    };
    let placement = neph::plan(&content.section_bytes(), CHUNK_BYTES)?;
    content.stream_to(stream, &placement)?;
    Ok(content.report(&placement))
}

fn check_mesh<const CORNERS: usize>(
    mesh: Vertices<'_>,
    history: &History<CORNERS>,
) -> Result<(), WriteError> {
    let (found, expected) = (history.vertex_death.len() as u64, mesh.positions.len() as u64);
    if found != expected {
        return Err(WriteError::VertexCount { found, expected });
    }
    let not_finite = |what: String| Err(WriteError::NotFinite { what });
    if !mesh.origin.iter().all(|x| x.is_finite()) {
        return not_finite("the origin".to_owned());
    }
    if !(mesh.rounding.is_finite() && mesh.rounding >= 0.0) {
        return not_finite("the rounding".to_owned());
    }
    match mesh.positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
        Some(vertex) => not_finite(format!("vertex {vertex}")),
        None => Ok(()),
    }
}

fn lay_out<const CORNERS: usize>(
    mesh: Vertices<'_>,
    pieces: &Pieces<'_, CORNERS>,
) -> Result<Layout, WriteError> {
    let n_levels = pieces.n_levels();
    let mut layout = Layout::build(n_levels, pieces.n_ids()?, |id| pieces.lifetime(id))?;
    let grid = Grid::around(mesh.positions);
    layout.sort_groups_by_key(|id| grid.morton_of_centroid(mesh.positions, pieces.vertices(id)));
    let n_vertices = mesh.positions.len();
    layout.order_groups(|| FanOrder::new(n_vertices), |fans, group| order_by_fans(fans, group, pieces));
    Ok(layout)
}

/// Orders the triangles of a group for the vertex cache; leaves other simplices as they are.
fn order_by_fans<const CORNERS: usize>(fans: &mut FanOrder, group: &mut [u32], pieces: &Pieces<'_, CORNERS>) {
    let mut triangles = Vec::with_capacity(group.len());
    for &id in &*group {
        let Ok(triangle) = <[u32; 3]>::try_from(pieces.vertices(id).as_slice()) else { return };
        triangles.push(triangle);
    }
    let Some(order) = fans.order_owned(triangles) else { return };
    let ids: Vec<u32> = order.into_iter().map(|place| group[place as usize]).collect();
    group.copy_from_slice(&ids);
}

fn metadata_bytes(provenance: &Provenance) -> Result<Vec<u8>, WriteError> {
    let metadata = serde_json::to_vec(&Metadata::new(provenance.clone()))?;
    let found = metadata.len() as u64;
    if found > MAX_METADATA_BYTES {
        return Err(WriteError::MetadataBytes { found, max: MAX_METADATA_BYTES });
    }
    Ok(metadata)
}

/// The names of the deviations, each ended by a zero byte.
fn deviation_names<const CORNERS: usize>(history: &History<CORNERS>) -> Result<Vec<u8>, WriteError> {
    let too_many = |what, found: usize, max| {
        let found = found as u64;
        if found > max { Err(WriteError::TooManyDeviations { what, found, max }) } else { Ok(()) }
    };
    let names = || history.deviations.iter().map(|deviation| deviation.name.as_bytes());
    too_many("deviations", history.deviations.len(), MAX_DEVIATIONS)?;
    too_many("zero bytes in names of deviations", names().filter(|name| name.contains(&0)).count(), 0)?;
    let bytes: Vec<u8> = names().flat_map(|name| [name, b"\0"].concat()).collect();
    too_many("bytes of deviation names", bytes.len(), MAX_DEVIATION_NAMES_BYTES)?;
    Ok(bytes)
}

/// Everything that goes into the file, most of it by reference and in the order of the input.
struct Content<'a, const CORNERS: usize> {
    mesh: Vertices<'a>,
    history: &'a History<CORNERS>,
    levels: &'a Levels,
    pieces: Pieces<'a, CORNERS>,
    layout: Layout,
    compact: Option<CompactSlots>,
    vertices: VertexOrder,
    run_offsets: Vec<u64>,
    runs: Vec<Run>,
    metadata: Vec<u8>,
    deviation_names: Vec<u8>,
    attributes: AttributeSections,
    operations: &'a [u8],
}

impl<const CORNERS: usize> Content<'_, CORNERS> {
    /// Sections in the order of the file, small ones first.
    fn section_bytes(&self) -> Vec<(SectionKind, u64)> {
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

    fn stream_to(&self, stream: &mut (impl Write + Seek), placement: &Placement) -> io::Result<()> {
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
            SectionKind::Errors => body.put_each(self.errors()),
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
        let (bounds_min, bounds_max) = bounds(self.positions());
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

    fn report(&self, placement: &Placement) -> StoreReport {
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
