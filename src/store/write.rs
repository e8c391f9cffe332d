//! Writing: everything is laid out first, then streamed in one pass, and the head is filled in at the end.

use super::arrange::VertexOrder;
use super::attributes::AttributeSections;
use super::compact::CompactSlots;
use super::content::Content;
use super::pieces::Pieces;
use super::{Metadata, Provenance, Vertices, WriteError};
use crate::History;
use crate::geometry::morton::Grid;
use crate::history::Levels;
use crate::tree::Layout;
use crate::vertex_cache::FanOrder;
use nephrite_formats::neph::{
    self, CHUNK_BYTES, MAX_DEVIATION_NAMES_BYTES, MAX_DEVIATIONS, MAX_METADATA_BYTES,
};
use std::io::{Seek, Write};

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
    let by_fans = |fans: &mut FanOrder, stretch: &mut [u32]| order_by_fans(fans, stretch, pieces);
    layout.order_stretches(STRETCH_LEN, || FanOrder::new(n_vertices), by_fans);
    Ok(layout)
}

/// Triangles that are ordered for the vertex cache at a time: a longer group, which lies along a curve by then, falls into stretches of
/// so many. Where two of them meet some vertices are loaded twice, which in stretches of this length cannot be seen in the miss ratio.
const STRETCH_LEN: usize = 1 << 14;

/// Orders triangles for the vertex cache; leaves other simplices as they are.
fn order_by_fans<const CORNERS: usize>(
    fans: &mut FanOrder,
    stretch: &mut [u32],
    pieces: &Pieces<'_, CORNERS>,
) {
    let mut triangles = Vec::with_capacity(stretch.len());
    for &id in &*stretch {
        let Ok(triangle) = <[u32; 3]>::try_from(pieces.vertices(id).as_slice()) else { return };
        triangles.push(triangle);
    }
    let Some(order) = fans.order_owned(triangles) else { return };
    let ids: Vec<u32> = order.into_iter().map(|place| stretch[place as usize]).collect();
    stretch.copy_from_slice(&ids);
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
