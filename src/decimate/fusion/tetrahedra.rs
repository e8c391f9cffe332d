//! Fusions of tetrahedra, in the order of their costs: the paper's, for as long as they are worth
//! it.

use super::queue::{CostQueue, raise_bound};
use super::state::State;
use crate::decimate::{Stopped, Watch};
use rayon::prelude::*;

/// What is known of a tetrahedron, by slot.
#[derive(Clone, Copy, Default)]
struct TetrahedronCandidate {
    /// Whether its cost in the queue is out of date.
    is_stale: bool,
    /// What it costs with the boundary's error counted in, as far as known: a lower bound.
    cost: f32,
}

/// Fuses tetrahedra that cost no more than the cheapest `share` of them did at the start.
pub(super) fn fuse_tetrahedra(state: &mut State, share: f64, watch: Watch<'_>) -> Result<(), Stopped> {
    #[expect(clippy::cast_possible_truncation, reason = "slots are counted in u32")]
    let n_slots = state.mesh.n_slots() as u32;
    let mut candidates = vec![TetrahedronCandidate::default(); n_slots as usize];
    let cost = |slot: u32| {
        let corners = state.mesh.get(slot)?;
        // What is inverted goes first: a fusion leaves nothing so.
        let is_right = state.mesh.six_volumes(slot) > 0.0;
        Some((slot, if is_right { state.cost(&state.tetrahedron(slot, corners)) } else { 0.0 }))
    };
    let costs: Vec<(u32, f64)> = (0..n_slots).into_par_iter().filter_map(cost).collect();
    let limit = quantile(&costs, share);
    let mut queue = CostQueue::new(costs.into_iter());
    let mut success_rate = SuccessRate::default();
    while !queue.is_first(u32::MAX, limit)
        && let Some(slot) = queue.pop()
    {
        let Some(corners) = state.mesh.get(slot) else { continue };
        let prey = state.tetrahedron(slot, corners);
        let candidate = &mut candidates[slot as usize];
        if std::mem::take(&mut candidate.is_stale) {
            let cost = state.cost(&prey).max(candidate.cost.into());
            if !queue.is_first(slot, cost) {
                queue.push(slot, cost);
                continue;
            }
        }
        let accepted = state.try_fusion(&prey);
        if success_rate.is_low_after(accepted.is_some()) {
            return Ok(());
        }
        let Some(accepted) = accepted else { continue };
        if raise_bound(&mut candidate.cost, accepted.cost) && !queue.is_first(slot, accepted.cost) {
            queue.push(slot, accepted.cost);
            continue;
        }
        state.fuse(&prey, &accepted, |slot| candidates[slot as usize].is_stale = true);
        state.tell(watch)?;
    }
    Ok(())
}

/// The cost that a share of the candidates does not exceed: none for 0, no limit for 1.
fn quantile(costs: &[(u32, f64)], share: f64) -> f64 {
    if share >= 1.0 {
        return f64::INFINITY;
    }
    let mut costs: Vec<f64> = costs.iter().map(|&(_, cost)| cost).collect();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a length")]
    let n_within = (share * costs.len() as f64) as usize;
    match n_within.checked_sub(1) {
        None => -1.0,
        Some(last) => *costs.select_nth_unstable_by(last, f64::total_cmp).1,
    }
}

/// How often tetrahedra could be fused lately. If nearly none can, edges take away more for the
/// same time.
#[derive(Default)]
struct SuccessRate {
    n_tried: u32,
    n_held: u32,
}

impl SuccessRate {
    /// Tries in one count.
    const WINDOW: u32 = 4096;
    /// It is not worth going on if fewer than one of so many holds.
    const LEAST_PART: u32 = 256;

    /// Counts one more try. True at the end of a window in which too few held.
    fn is_low_after(&mut self, holds: bool) -> bool {
        self.n_tried += 1;
        self.n_held += u32::from(holds);
        if self.n_tried < Self::WINDOW {
            return false;
        }
        let is_rare = self.n_held * Self::LEAST_PART < self.n_tried;
        *self = Self::default();
        is_rare
    }
}
