//! One removal: planned, and carried out.

use super::candidate::{Scratch, Situation, Verdict, fill};
use super::decimation::named_corners;
use crate::bound::{Change, Limits, Replacement};
use crate::history::Recorder;
use crate::mesh::{Filling, Hole, Seams, Surface};

/// All that a removal changes.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The star that goes, without its points.
    pub hole: Hole,
    pub(super) filling: Filling,
    error: f64,
    change: Change,
}

/// Plans the removal of `v` under `limits`, or tells what it would need. A plan is long, and most candidates have none: in a box it is
/// not moved about with them.
pub fn plan(
    situation: Situation<'_>,
    v: u32,
    limits: Limits,
    scratch: &mut Scratch,
) -> Result<Box<Plan>, Verdict> {
    fill(situation, v, limits, scratch)?;
    let Scratch { hole, filling, transfer, .. } = scratch;
    let replacement = Replacement { surface: situation.surface, hole, filling };
    let (errors, change) = situation.error.change(replacement, limits, transfer).map_err(Verdict::Above)?;
    Ok(Box::new(Plan { hole: hole.without_points(), filling: filling.clone(), error: errors.global, change }))
}

impl Plan {
    /// The star that goes, and what its filling changes in the errors.
    pub fn change(&self) -> (&Hole, &Change) {
        (&self.hole, &self.change)
    }

    /// Edges that the filling makes, as vertices, the lower one first.
    pub fn new_edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let vertex = |i: u8| self.hole.ring[usize::from(i)];
        self.filling.inner_edges(&self.hole).map(move |[i, j]| [vertex(i), vertex(j)]).map(ascending)
    }

    /// The vertices of the one triangle that closes a hole of three corners, in ascending order.
    pub fn lid(&self) -> Option<[u32; 3]> {
        let is_closed = self.hole.closed && self.hole.n_ring() == 3;
        is_closed.then(|| ascending(self.filling.corners(&self.hole, 0)))
    }

    /// Puts the filling in the place of the star and writes that down as a step.
    pub fn replace_star(
        &self,
        surface: &mut Surface,
        seams: Option<&mut Seams>,
        names: Option<&[u32]>,
        recorder: &mut Recorder,
    ) {
        let Self { hole, filling, error, .. } = self;
        recorder.step(*error);
        for &slot in &hole.slots {
            recorder.death(slot, named_corners(surface, seams.as_deref(), names, slot));
        }
        let born: Vec<[u32; 3]> = (0..filling.triangles.len()).map(|i| filling.corners(hole, i)).collect();
        let vertices = seams.as_deref().map(|seams| seam_vertices(surface, seams, hole, filling));
        surface.replace_star(hole.removed, &hole.slots, &born);
        hole.slots.iter().take(born.len()).for_each(|&slot| recorder.birth(slot));
        if let (Some(seams), Some(vertices)) = (seams, vertices) {
            hole.slots.iter().zip(vertices).for_each(|(&slot, vertices)| seams.set(slot, vertices));
        }
    }
}

fn ascending<const N: usize>(mut vertices: [u32; N]) -> [u32; N] {
    vertices.sort_unstable();
    vertices
}

/// The vertices of the filling's triangles: at each ring point the one that the star has on the same side of the seam.
fn seam_vertices(surface: &Surface, seams: &Seams, hole: &Hole, filling: &Filling) -> Vec<[u32; 3]> {
    let corner = |t: usize, i: u8| {
        // A part of the filling runs round from its start to its end, so only its start lies before its triangles.
        let (i, is_start) = (usize::from(i), i == filling.part_start(t));
        let slot = if is_start { hole.slot_after(i) } else { hole.slot_before(i) };
        seams.vertex(surface, slot, hole.ring[i])
    };
    (0..filling.triangles.len()).map(|t| filling.triangles[t].map(|i| corner(t, i))).collect()
}
