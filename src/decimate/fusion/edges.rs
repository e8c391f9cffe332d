//! Fusions of edges, in the order of the least cost of any edge at a vertex.
//!
//! An edge belongs to the newer of its vertices, so that each is looked at once. Where a vertex is
//! fused its edges go, and those that come belong to the fusion point: an older vertex only loses
//! edges, and what it was queued with stays a lower bound.

use super::prey::Prey;
use super::queue::{CostQueue, raise_bound};
use super::state::{Accepted, State};
use crate::decimate::{Stopped, Watch};
use rayon::prelude::*;

/// What is known of a vertex.
#[derive(Clone, Copy, Default)]
struct EdgeCandidate {
    /// What it costs with the boundary's error counted in, as far as known: a lower bound.
    cost: f32,
    /// The other end of its cheapest edge.
    cheapest: u32,
    /// Fusion after which its edges were found.
    found: u32,
    /// Edges refused since, the cheapest ones.
    n_refused: u8,
}

/// The cheapest edges at a vertex are tried in order; no more than this many.
const TRIED_EDGES: u8 = 4;

/// Fuses edges until none can be fused.
pub(super) fn fuse_edges(state: &mut State, watch: Watch<'_>) -> Result<(), Stopped> {
    let mut candidates = vec![EdgeCandidate::default(); state.mesh.n_vertices()];
    let mut edges = Edges::default();
    let mut queue = find_all(state, &mut candidates, |_, _| true);
    loop {
        let before = state.n_fusions;
        while let Some(v) = queue.pop() {
            match turn(state, &mut edges, &queue, v, &mut candidates[v as usize]) {
                EdgeTurn::None => {}
                EdgeTurn::Later(cost) => queue.push(v, cost),
                EdgeTurn::Now(prey, accepted) => {
                    let new = state.fuse(&prey, &accepted, |_| {});
                    candidates.push(EdgeCandidate::default());
                    if let Some(cost) = edges.find(state, new, &mut candidates[new as usize]) {
                        queue.push(new, cost);
                    }
                    state.tell(watch)?;
                }
            }
        }
        if state.n_fusions == before {
            return Ok(());
        }
        queue = find_all(state, &mut candidates, |candidate, touched| touched > candidate.found);
    }
}

/// A queue of all vertices that are to be looked at, by what is known of them and the fusion that
/// last changed their star.
fn find_all(
    state: &State,
    candidates: &mut [EdgeCandidate],
    is_meant: fn(&EdgeCandidate, u32) -> bool,
) -> CostQueue {
    let find = |edges: &mut Edges, (v, candidate): (usize, &mut EdgeCandidate)| {
        if !is_meant(candidate, state.touched[v]) {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "vertices are counted in u32")]
        let v = v as u32;
        let cost = edges.find(state, v, candidate)?;
        Some((v, cost.max(candidate.cost.into())))
    };
    let costs: Vec<Option<(u32, f64)>> =
        candidates.par_iter_mut().enumerate().map_init(Edges::default, find).collect();
    CostQueue::new(costs.into_iter().flatten())
}

/// What is decided for the vertex that is first in the queue.
enum EdgeTurn {
    /// No edge of it can be fused.
    None,
    /// It costs more than what is next in the queue.
    Later(f64),
    Now(Prey, Accepted),
}

/// Tries the edges of a vertex in the order of their costs, each only when it is first: where a
/// cheap edge is refused, the next may cost a thousand times as much.
fn turn(
    state: &mut State,
    edges: &mut Edges,
    queue: &CostQueue,
    v: u32,
    candidate: &mut EdgeCandidate,
) -> EdgeTurn {
    let is_changed = state.touched[v as usize] > candidate.found;
    // If the star has not changed, the cheapest edge is known and comes first.
    let mut is_known = !is_changed && candidate.n_refused == 0;
    if !is_known {
        let n_refused = candidate.n_refused;
        edges.find(state, v, candidate);
        candidate.n_refused = if is_changed { 0 } else { n_refused };
    }
    while candidate.n_refused < TRIED_EDGES {
        let w = if is_known {
            candidate.cheapest
        } else {
            let Some((cost, w)) = edges.nth(candidate.n_refused) else { break };
            let cost = cost.max(candidate.cost.into());
            if !queue.is_first(v, cost) {
                return EdgeTurn::Later(cost);
            }
            w
        };
        let prey = state.edge(v, w);
        if let Some(accepted) = state.try_fusion(&prey) {
            let is_later =
                raise_bound(&mut candidate.cost, accepted.cost) && !queue.is_first(v, accepted.cost);
            return if is_later { EdgeTurn::Later(accepted.cost) } else { EdgeTurn::Now(prey, accepted) };
        }
        if std::mem::take(&mut is_known) {
            edges.find(state, v, candidate);
        }
        candidate.n_refused += 1;
    }
    EdgeTurn::None
}

/// The edges of one vertex with their costs. Kept and filled anew.
#[derive(Default)]
struct Edges {
    costs: Vec<(f64, u32)>,
    neighbours: Vec<u32>,
}

fn by_cost(a: &&(f64, u32), b: &&(f64, u32)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

impl Edges {
    /// Finds the edges from `v` to older vertices, of those that may be fused; gives the least
    /// cost.
    fn find(&mut self, state: &State, v: u32, candidate: &mut EdgeCandidate) -> Option<f64> {
        self.neighbours.clear();
        let slots = if state.is_crowded(v) { &[] } else { state.mesh.slots_at(v) };
        for &slot in slots {
            // The tetrahedra of a fused vertex live on without it.
            if let Some(corners) = state.mesh.get(slot).filter(|corners| corners.contains(&v)) {
                self.neighbours.extend(corners.into_iter().filter(|&w| w < v));
            }
        }
        self.neighbours.sort_unstable();
        self.neighbours.dedup();
        self.neighbours.retain(|&w| !state.is_crowded(w) && state.may_meet(v, w));
        self.costs.clear();
        self.costs.extend(self.neighbours.iter().map(|&w| (state.cost(&state.edge(v, w)), w)));
        candidate.found = state.now();
        candidate.n_refused = 0;
        let &(cost, cheapest) = self.costs.iter().min_by(by_cost)?;
        candidate.cheapest = cheapest;
        Some(cost)
    }

    /// The edge found last that has so many cheaper ones beside it.
    fn nth(&mut self, n_cheaper: u8) -> Option<(f64, u32)> {
        let n_cheaper = usize::from(n_cheaper);
        let is_there = n_cheaper < self.costs.len();
        is_there.then(|| *self.costs.select_nth_unstable_by(n_cheaper, |a, b| by_cost(&a, &b)).1)
    }
}
