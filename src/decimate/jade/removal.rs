//! One removal: planned in parallel with others, carried out in turn.

use super::candidate::{Scratch, Situation, Verdict, fill};
use super::decimation::{Decimation, named_corners};
use crate::bound::{Change, GlobalError, Limits, Replacement};
use crate::mesh::{Filling, Hole, Seams, Surface, TooMany};

/// All that a removal changes.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The star that goes, without its points.
    pub hole: Hole,
    filling: Filling,
    error: f64,
    change: Change,
}

/// Plans the removal of `v` under `limits`, or tells what it would need.
pub fn plan(
    situation: Situation<'_>,
    v: u32,
    limits: Limits,
    scratch: &mut Scratch,
) -> Result<Plan, Verdict> {
    fill(situation, v, limits, scratch)?;
    let Scratch { hole, filling, transfer, .. } = scratch;
    let replacement = Replacement { surface: situation.surface, hole, filling };
    let (errors, change) = situation.error.change(replacement, limits, transfer).map_err(Verdict::Above)?;
    Ok(Plan { hole: hole.without_points(), filling: filling.clone(), error: errors.global, change })
}

impl Plan {
    /// Whether the plan still fits after others of its batch were carried out: none of its new edges has been made
    /// since, and none of the source edges that it moves has moved.
    pub fn is_current(&self, surface: &Surface, error: &GlobalError) -> bool {
        let is_free = |[i, j]: [u8; 2]| {
            surface.n_faces(self.hole.ring[usize::from(i)], self.hole.ring[usize::from(j)]) == 0
        };
        let closes_up = self.hole.closed
            && self.hole.n_ring() == 3
            && surface.has_triangle(self.filling.corners(&self.hole, 0));
        !closes_up && self.filling.inner_edges(&self.hole).all(is_free) && error.is_current(&self.change)
    }

    /// Carries the plan out: record, errors, mesh, in this order, since each needs the star as it was.
    ///
    /// # Errors
    ///
    /// When the errors have no room for it; nothing has changed then.
    pub fn carry_out(self, decimation: &mut Decimation) -> Result<(), TooMany> {
        let Self { hole, filling, error: step_error, change } = self;
        let Decimation { surface, seams, names, error, recorder, .. } = decimation;
        error.check_room(&hole, &change)?;
        recorder.step(step_error);
        for &slot in &hole.slots {
            recorder.death(slot, named_corners(surface, seams.as_ref(), names.as_deref(), slot));
        }
        error.apply(&hole, change);
        let born: Vec<[u32; 3]> = (0..filling.triangles.len()).map(|i| filling.corners(&hole, i)).collect();
        let vertices = seams.as_ref().map(|seams| seam_vertices(surface, seams, &hole, &filling));
        surface.replace_star(hole.removed, &hole.slots, &born);
        for (i, &slot) in (0..born.len()).zip(&hole.slots) {
            recorder.birth(slot);
            if let (Some(seams), Some(vertices)) = (seams.as_mut(), &vertices) {
                seams.set(slot, vertices[i]);
            }
        }
        Ok(())
    }
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
