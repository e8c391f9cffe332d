//! One removal: planned, and carried out.

use super::candidate::{Refusal, Scratch, Situation, fill};
use super::names::Names;
use crate::bound::{Change, Limits, Replacement};
use crate::history::Recorder;
use crate::mesh::{Filling, Hole, Surface, Wedges};

/// All that a removal changes.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The star that goes, without its points.
    pub hole: Hole,
    pub(super) filling: Filling,
    error: f64,
    change: Change,
    /// The triangles of the star, as they are recorded: beside the change of the surface, which has
    /// others by then.
    dying: Vec<[u32; 3]>,
    /// Those of the filling, as they are recorded; none without seams.
    born_at_seams: Vec<[u32; 3]>,
}

/// Plans the removal of `v` under `limits`, or returns what it would need. The plan is in a box: it
/// is long and most candidates have none.
pub(crate) fn plan(
    situation: Situation<'_>,
    v: u32,
    limits: Limits,
    scratch: &mut Scratch,
) -> Result<Box<Plan>, Refusal> {
    fill(situation, v, limits, scratch)?;
    let Scratch { hole, filling, transfer, .. } = scratch;
    let Situation { surface, names, .. } = situation;
    let replacement = Replacement { surface, hole, filling };
    let (errors, change) = situation.error.change(replacement, limits, transfer).map_err(Refusal::Above)?;
    Ok(Box::new(Plan {
        error: errors.global,
        change,
        dying: hole.slots.iter().map(|&slot| names.corners(surface, slot)).collect(),
        born_at_seams: names
            .wedges()
            .map_or_else(Vec::new, |wedges| seam_vertices(surface, wedges, hole, filling)),
        filling: filling.clone(),
        hole: hole.without_points(),
    }))
}

impl Plan {
    /// The star that goes, and what its filling changes in the errors.
    pub(crate) fn change(&self) -> (&Hole, &Change) {
        (&self.hole, &self.change)
    }

    /// Edges that the filling makes, as vertices, the lower one first.
    pub(crate) fn new_edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let vertex = |i: u8| self.hole.ring[usize::from(i)];
        self.filling.inner_edges(&self.hole).map(move |[i, j]| [vertex(i), vertex(j)]).map(ascending)
    }

    /// The vertices of the one triangle that closes a hole of three corners, in ascending order.
    pub(crate) fn lid(&self) -> Option<[u32; 3]> {
        let is_closed = self.hole.closed && self.hole.n_ring() == 3;
        is_closed.then(|| ascending(self.filling.corners(&self.hole, 0)))
    }

    /// Writes the removal down as a step.
    pub(crate) fn record(&self, recorder: &mut Recorder) {
        let Self { hole, filling, error, dying, .. } = self;
        recorder.step(*error);
        hole.slots.iter().zip(dying).for_each(|(&slot, &triangle)| recorder.death(slot, triangle));
        hole.slots.iter().take(filling.triangles.len()).for_each(|&slot| recorder.birth(slot));
    }

    /// Gives the filling its vertices in the history.
    pub(crate) fn name_filling(&self, names: &mut Names) {
        names.set(&self.hole.slots, &self.born_at_seams);
    }
}

fn ascending<const N: usize>(mut vertices: [u32; N]) -> [u32; N] {
    vertices.sort_unstable();
    vertices
}

/// The vertices of the filling's triangles: at each ring point the one that the star has on the
/// same side of the seam.
fn seam_vertices(surface: &Surface, wedges: &Wedges, hole: &Hole, filling: &Filling) -> Vec<[u32; 3]> {
    let corner = |t: usize, i: u8| {
        // A part of the filling runs round from its start to its end, so only its start lies before
        // its triangles.
        let (i, is_start) = (usize::from(i), i == filling.part_start(t));
        let slot = if is_start { hole.slot_after(i) } else { hole.slot_before(i) };
        wedges.at(surface, slot, hole.ring[i])
    };
    (0..filling.triangles.len()).map(|t| filling.triangles[t].map(|i| corner(t, i))).collect()
}
