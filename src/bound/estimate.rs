//! The paper's estimates of the global error (JADE, section 4): e_g1 accumulated, e_g2 from the
//! removed vertices, and e_g3, the larger of both.

use super::accumulated::{Accumulated, Sampler};
use super::limits::{Errors, Limits};
use super::removed::{RemovedVertices, nearest};
use super::replacement::Replacement;
use crate::geometry::distance::point_segment_distance_sq;
use crate::mesh::{Filling, Hole, Renumbering, Surface};

/// Which of the paper's estimates decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EstimateKind {
    /// e_g1.
    Accumulated,
    /// e_g2.
    Removed,
    /// e_g3, the larger of the two.
    Joint,
}

/// Estimated errors of the current mesh.
#[derive(Clone, Debug)]
pub(crate) struct Estimate {
    sampler: Sampler,
    accumulated: Option<Accumulated>,
    removed: Option<RemovedVertices>,
}

/// What a replacement changes.
#[derive(Clone, Debug)]
pub(crate) struct EstimateChange {
    /// e_g1 of the filling's triangles.
    accumulated: Vec<f64>,
    /// Removed vertices and the index of the filling's triangle that each goes to.
    assignments: Vec<(u32, usize)>,
}

impl Estimate {
    /// The estimate at the start, when `surface` is the input.
    pub(crate) fn new(kind: EstimateKind, surface: &Surface) -> Self {
        let (n_slots, n_vertices) = (surface.n_slots(), surface.n_vertices());
        Self {
            sampler: Sampler::new(surface),
            accumulated: (kind != EstimateKind::Removed).then(|| Accumulated::new(n_slots)),
            removed: (kind != EstimateKind::Accumulated).then(|| RemovedVertices::new(n_slots, n_vertices)),
        }
    }

    /// The sampler of local errors.
    pub(crate) fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    /// Errors of replacing the star of `hole` by `filling`. Stops early once a limit is passed.
    pub(crate) fn errors(&self, replacement: Replacement<'_>, limits: Limits) -> Errors {
        let Replacement { surface, hole, filling } = replacement;
        let mut errors = Errors::default();
        if !hole.closed {
            errors.local = boundary_error(hole);
        }
        for i in 0..filling.triangles.len() {
            let triangle = filling.triangle(hole, i);
            let local_sq = self.sampler.local_error_sq(&triangle, hole, limits.local * limits.local);
            errors.local = errors.local.max(local_sq.sqrt());
            if errors.within(limits) {
                errors.global = errors.global.max(self.accumulated_error(hole, filling, i));
            }
            if !errors.within(limits) {
                return errors;
            }
        }
        for v in self.removed.iter().flat_map(|removed| removed.of_hole(hole)) {
            errors.global = errors.global.max(nearest(hole, filling, surface.point(v)).1.sqrt());
            if !errors.within(limits) {
                break;
            }
        }
        errors
    }

    /// e_g1 of the filling's triangle `i`; 0 where it is not asked for.
    fn accumulated_error(&self, hole: &Hole, filling: &Filling, i: usize) -> f64 {
        let Some(accumulated) = &self.accumulated else { return 0.0 };
        let of_star = |i: usize| accumulated.of(hole.slots[i]);
        let error = self.sampler.accumulated_error(&filling.triangle(hole, i), hole, of_star);
        if hole.closed { error } else { error.max(boundary_error(hole)) }
    }

    /// What the replacement changes in the estimates.
    pub(crate) fn change(&self, replacement: Replacement<'_>) -> EstimateChange {
        let Replacement { surface, hole, filling } = replacement;
        let accumulated =
            (0..filling.triangles.len()).map(|i| self.accumulated_error(hole, filling, i)).collect();
        let vertices = self.removed.iter().flat_map(|removed| removed.of_hole(hole));
        let assignments = vertices.map(|v| (v, nearest(hole, filling, surface.point(v)).0)).collect();
        EstimateChange { accumulated, assignments }
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        if let Some(accumulated) = &mut self.accumulated {
            accumulated.renumber_slots(slots);
        }
        if let Some(removed) = &mut self.removed {
            removed.renumber_slots(slots);
        }
    }

    /// Carries the estimates over to the filling.
    pub(crate) fn apply(&mut self, hole: &Hole, change: &EstimateChange) {
        if let Some(accumulated) = &mut self.accumulated {
            hole.slots
                .iter()
                .zip(&change.accumulated)
                .for_each(|(&slot, &error)| accumulated.set(slot, error));
        }
        if let Some(removed) = &mut self.removed {
            removed.clear(hole);
            change.assignments.iter().for_each(|&(v, i)| removed.add(v, hole.slots[i]));
        }
    }
}

/// Distance of a boundary vertex to the boundary edge that replaces its two (JADE, section 3).
fn boundary_error(hole: &Hole) -> f64 {
    let last = hole.points[hole.n_ring() - 1];
    point_segment_distance_sq(hole.apex, [hole.points[0], last]).sqrt()
}
