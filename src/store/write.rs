//! Writing: everything is laid out first, then streamed in one pass, and the head is filled in at
//! the end.

use super::arrange::VertexOrder;
use super::attributes::AttributeSections;
use super::compact::CompactSlots;
use super::content::Content;
use super::pieces::Pieces;
use super::{Metadata, StoreReport, Vertices, WriteError};
use crate::History;
use crate::geometry::morton::Grid;
use crate::history::Levels;
use crate::progressive_mesh::StreamError;
use crate::tree::Layout;
use crate::vertex_cache::FanOrder;
use nephrite_formats::neph::{
    self, CHUNK_BYTES, MAX_DEVIATION_NAMES_BYTES, MAX_DEVIATIONS, MAX_METADATA_BYTES,
};
use std::io::{Seek, Write};

/// What a file is to keep of a history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoreOptions {
    /// Most levels; `None` for as many as make each level about 63/64 of the one before.
    pub levels: Option<u32>,
    /// Levels per window, rounded up to a power of two: lifetimes are cut at the borders of
    /// windows, so that fewer vertices are transformed when a level is drawn as runs. With the
    /// usual levels some 1.1 per triangle for 16 instead of 1.8, and 0.9 for 8, in files 1.8 and
    /// 2.8 times as long. `None` for no windows.
    pub window_levels: Option<u32>,
    /// Each simplex once, with narrow indices and stamps: a file of a third to two thirds the
    /// length, which a reader lays out in memory when it opens it, whereas slots in the plain form
    /// are used where they lie.
    pub is_compact: bool,
    /// Whether the file also holds the operations of a progressive build, from which the mesh can
    /// be built up one by one while they arrive, see
    /// [`ProgressiveMesh`](crate::progressive_mesh::ProgressiveMesh). Only a progressive build has
    /// them.
    pub operations: bool,
}

/// What a file is made of.
pub(crate) struct Source<'a, const CORNERS: usize> {
    /// The vertices that the history's indices refer to.
    pub(crate) vertices: Vertices<'a>,
    /// Every simplex that ever lived.
    pub(crate) history: &'a History<CORNERS>,
    /// How the history was made.
    pub(crate) metadata: Metadata,
    /// An [operation stream](crate::progressive_mesh); empty for none.
    pub(crate) operations: Vec<u8>,
}

impl<const CORNERS: usize> Source<'_, CORNERS> {
    /// Writes a whole file to an empty stream.
    ///
    /// Memory: 4 bytes per slot and 8 per vertex, beside mesh and history. The same input gives the
    /// same bytes on any number of threads.
    ///
    /// # Errors
    ///
    /// [`WriteError`] when the history or an attribute does not fit the mesh, when the file would
    /// exceed a limit of the format, when operations are wanted of a history that has none, or when
    /// the stream refuses.
    pub(crate) fn write_to(
        &self,
        stream: &mut (impl Write + Seek),
        options: &StoreOptions,
    ) -> Result<StoreReport, WriteError> {
        let Self { vertices: mesh, history, metadata, operations } = self;
        if options.operations && operations.is_empty() {
            return Err(StreamError::NoOperations.into());
        }
        check_mesh(*mesh, history)?;
        history.check()?;
        let levels = Levels::of_checked(history, options.levels)?;
        let pieces = Pieces::new(history, &levels, options.window_levels)?;
        let layout = lay_out(*mesh, &pieces)?;
        let vertices = VertexOrder::new(*mesh, history, &levels);
        let (run_offsets, runs) = layout.runs();
        let attributes = AttributeSections::new(*mesh, vertices.order.len())?;
        let compact = options.is_compact.then(|| CompactSlots::new(layout.slots(), &pieces));
        let content = Content {
            mesh: *mesh,
            history,
            levels: &levels,
            pieces,
            layout,
            compact,
            vertices,
            run_offsets,
            runs,
            metadata: metadata_bytes(metadata)?,
            deviation_names: deviation_names(history)?,
            attributes,
            operations,
        };
        let placement = neph::plan(&content.section_bytes(), CHUNK_BYTES)?;
        content.stream_to(stream, &placement)?;
        Ok(content.report(&placement))
    }
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

/// Triangles that are ordered for the vertex cache at a time: a longer group, which lies along a
/// curve by then, falls into stretches of so many. Where two of them meet some vertices are loaded
/// twice, which in stretches of this length cannot be seen in the miss ratio.
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

fn metadata_bytes(metadata: &Metadata) -> Result<Vec<u8>, WriteError> {
    let metadata = serde_json::to_vec(metadata)?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metadata_that_no_file_holds_are_refused() {
        let metadata = |n| Metadata { options: "m".repeat(n).into(), ..Metadata::new() };
        assert!(metadata_bytes(&metadata(1000)).is_ok());
        let refused = metadata_bytes(&metadata(2 << 20));
        assert!(matches!(refused, Err(WriteError::MetadataBytes { .. })));
    }
}
