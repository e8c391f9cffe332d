//! The driver: candidates from the queue, each tried, the ones that hold made. First tetrahedra, as the paper has it; where no
//! tetrahedron can be fused any more, edges.

use super::attempt::Accepted;
use super::options::FusionOptions;
use super::prey::Prey;
use super::queue::Queue;
use super::state::{Fused, State};
use nephrite_formats::TetrahedronMesh;
use rayon::prelude::*;

/// The observer asked to stop.
pub(crate) struct Stopped;

/// Fusions between two calls of the observer.
const OBSERVED: usize = 256;

/// Told the tetrahedra left and the error of the boundary; says whether to go on.
pub(crate) type GoOn<'a> = &'a dyn Fn(usize, f64) -> bool;

/// Fuses the tetrahedra of a mesh as far as it goes, or until the error of the boundary would exceed `max_error`.
///
/// # Errors
///
/// [`Stopped`] when `go_on` says so.
pub(crate) fn run(
    mesh: &TetrahedronMesh,
    options: &FusionOptions,
    cos_feature_angle: f64,
    max_error: Option<f64>,
    go_on: GoOn<'_>,
) -> Result<Fused, Stopped> {
    let mut state = State::new(mesh, options, cos_feature_angle, max_error);
    let max_error = state.max_error;
    state.max_error = max_error.min(state.fine_error);
    fuse_tetrahedra(&mut state, options.tetrahedron_share, go_on)?;
    state.max_error = max_error;
    let by_tetrahedra = [state.n_fusions, state.mesh.n_alive()];
    fuse_edges(&mut state, go_on)?;
    Ok(state.finish(mesh, by_tetrahedra))
}

/// What is known of a candidate, by slot or by vertex.
#[derive(Clone, Copy, Default)]
struct Candidate {
    /// Whether its cost in the queue is out of date.
    is_stale: bool,
    /// What it costs with the boundary's error counted in, as far as known: a lower bound.
    cost: f32,
    /// Fusion after which it was refused, or the first of its edges were.
    refused: u32,
    /// Edges refused then, the cheapest ones.
    n_refused: u8,
}

/// Fuses tetrahedra that cost no more than the cheapest `share` of them did at the start.
fn fuse_tetrahedra(state: &mut State, share: f64, go_on: GoOn<'_>) -> Result<(), Stopped> {
    #[expect(clippy::cast_possible_truncation, reason = "slots are counted in u32")]
    let n_slots = state.mesh.n_slots() as u32;
    let mut candidates = vec![Candidate::default(); n_slots as usize];
    let cost = |slot: u32| {
        let corners = state.mesh.get(slot)?;
        // What is inverted goes first: a fusion leaves nothing so.
        let is_right = state.mesh.six_volumes(slot) > 0.0;
        Some((slot, if is_right { state.cost(&Prey::tetrahedron(corners)) } else { 0.0 }))
    };
    let costs: Vec<(u32, f64)> = (0..n_slots).into_par_iter().filter_map(cost).collect();
    let limit = quantile(&costs, share);
    let mut queue = Queue::new(costs.into_iter());
    let mut luck = Luck::default();
    while !queue.is_first(u32::MAX, limit)
        && let Some(slot) = queue.pop()
    {
        let Some(corners) = state.mesh.get(slot) else { continue };
        let prey = Prey::tetrahedron(corners);
        let candidate = &mut candidates[slot as usize];
        if std::mem::take(&mut candidate.is_stale) {
            let cost = state.cost(&prey).max(candidate.cost.into());
            if !queue.is_first(slot, cost) {
                queue.push(slot, cost);
                continue;
            }
        }
        let accepted = state.try_fusion(&prey);
        if luck.has_left(accepted.is_some()) {
            return Ok(());
        }
        let Some(accepted) = accepted else { continue };
        if comes_later(candidate, accepted.cost) && !queue.is_first(slot, accepted.cost) {
            queue.push(slot, accepted.cost);
            continue;
        }
        state.fuse(&prey, &accepted, |slot| candidates[slot as usize].is_stale = true);
        observe(state, go_on)?;
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

/// How often tetrahedra could be fused lately. Where nearly none can, edges take away more for the same time.
#[derive(Default)]
struct Luck {
    n_tried: u32,
    n_held: u32,
}

impl Luck {
    /// Tries in one count.
    const WINDOW: u32 = 4096;
    /// Fewer that hold than this part of them are not worth it.
    const LEAST_PART: u32 = 64;

    fn has_left(&mut self, holds: bool) -> bool {
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

/// Takes down what a candidate costs with the boundary's error counted in; true where that is more than was known.
#[expect(clippy::cast_possible_truncation, reason = "the order needs no more digits")]
fn comes_later(candidate: &mut Candidate, cost: f64) -> bool {
    let cost = cost as f32;
    let is_news = cost > candidate.cost;
    candidate.cost = candidate.cost.max(cost);
    is_news
}

/// Told now and then how far it has come.
fn observe(state: &State, go_on: GoOn<'_>) -> Result<(), Stopped> {
    let is_time = state.n_fusions.is_multiple_of(OBSERVED);
    if is_time && !go_on(state.mesh.n_alive(), state.recorder.error()) { Err(Stopped) } else { Ok(()) }
}

/// Fuses edges, in the order of the least cost of any edge at a vertex.
fn fuse_edges(state: &mut State, go_on: GoOn<'_>) -> Result<(), Stopped> {
    let mut candidates = vec![Candidate::default(); state.mesh.n_vertices()];
    let mut edges = Edges::default();
    let mut queue = Queue::default();
    queue_edges(state, &candidates, &mut edges, &mut queue);
    loop {
        let before = state.n_fusions;
        while let Some(v) = queue.pop() {
            edges.find(state, v);
            match turn(state, &edges, &queue, v, &mut candidates[v as usize]) {
                Turn::None => {}
                Turn::Later(cost) => queue.push(v, cost),
                Turn::Now(prey, accepted) => {
                    let new = state.fuse(&prey, &accepted, |_| {});
                    candidates.resize(state.mesh.n_vertices(), Candidate::default());
                    edges.find(state, new);
                    edges.costs.first().iter().for_each(|(cost, _)| queue.push(new, *cost));
                    observe(state, go_on)?;
                }
            }
        }
        if state.n_fusions == before || !queue_edges(state, &candidates, &mut edges, &mut queue) {
            return Ok(());
        }
    }
}

/// The cheapest edges at a vertex are tried in order; no more than this many.
const TRIED_EDGES: u8 = 4;

/// What comes of a vertex that is first in the queue.
enum Turn {
    /// No edge of it can be fused.
    None,
    /// It costs more than what is next in the queue.
    Later(f64),
    Now(Prey, Accepted),
}

/// Tries the edges at a vertex in the order of their costs, each only when it is first: where a cheap edge is refused, the next may
/// cost a thousand times as much.
fn turn(state: &mut State, edges: &Edges, queue: &Queue, v: u32, candidate: &mut Candidate) -> Turn {
    if state.touched[v as usize] > candidate.refused {
        candidate.n_refused = 0;
    }
    let range = edges.costs.len().min(TRIED_EDGES.into());
    for &(cost, w) in edges.costs[..range].iter().skip(candidate.n_refused.into()) {
        let cost = cost.max(candidate.cost.into());
        if !queue.is_first(v, cost) {
            return Turn::Later(cost);
        }
        let prey = Prey::edge([v, w]);
        let Some(accepted) = state.try_fusion(&prey) else {
            candidate.n_refused += 1;
            candidate.refused = state.now();
            continue;
        };
        if comes_later(candidate, accepted.cost) && !queue.is_first(v, accepted.cost) {
            return Turn::Later(accepted.cost);
        }
        return Turn::Now(prey, accepted);
    }
    Turn::None
}

fn queue_edges(state: &mut State, candidates: &[Candidate], edges: &mut Edges, queue: &mut Queue) -> bool {
    let mut is_any = false;
    for (v, candidate) in (0..).zip(candidates) {
        let is_changed = candidate.refused == 0 || state.touched[v as usize] > candidate.refused;
        if is_changed {
            edges.find(state, v);
            if let Some(&(cost, _)) = edges.costs.first() {
                queue.push(v, cost.max(candidate.cost.into()));
                is_any = true;
            }
        }
    }
    is_any
}

/// The edges at one vertex with their costs, the least first. Kept and filled anew.
#[derive(Default)]
struct Edges {
    costs: Vec<(f64, u32)>,
    neighbours: Vec<u32>,
}

impl Edges {
    fn find(&mut self, state: &mut State, v: u32) {
        state.mesh.purge(v);
        self.neighbours.clear();
        for &slot in state.mesh.slots_at(v) {
            if let Some(corners) = state.mesh.get(slot).filter(|corners| corners.contains(&v)) {
                self.neighbours.extend(corners.into_iter().filter(|&w| w != v));
            }
        }
        self.neighbours.sort_unstable();
        self.neighbours.dedup();
        self.costs.clear();
        self.costs.extend(self.neighbours.iter().map(|&w| (state.cost(&Prey::edge([v, w])), w)));
        self.costs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
}
