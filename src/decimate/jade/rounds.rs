//! The driver: iterations under rising limits, and in each of them rounds over an independent set.
//!
//! A heap would need the error of every neighbour again after every removal. Here what was last found of a vertex stands until
//! its turn comes, however much its star has changed since: it only decides whose turn it is. The ceilings rise so finely that
//! removals go nearly in the order of their errors all the same, and a vertex is judged as often as it is tried.

use super::candidate::Verdict;
use super::decimation::Decimation;
use super::placement;
use super::removal::{Plan, plan};
use super::thresholds::Thresholds;
use crate::bound::Limits;
use crate::bound::accumulated::round_up;
use crate::mesh::{Surface, TooMany};
use rayon::prelude::*;

/// Most candidates that one thread takes at a time. Of few candidates it takes fewer: the last ones of a history stand for
/// thousands of input vertices each.
const CHUNK: usize = 32;

/// Removals that are planned before the first of them is carried out.
const BATCH: usize = 512;

/// The part of a ceiling's worklist that is left to the next ceiling: rounds over a few candidates each would end it.
const FEW: usize = 3;

/// What was last found of each vertex.
struct Candidates {
    /// The local limit that would have admitted it, or less: 0 when nothing is known, infinite when it was impossible or the
    /// vertex is gone.
    needed: Vec<f32>,
    /// The global error of its removal, or less where it was above the limit; 0 when nothing is known.
    found: Vec<f32>,
    /// Last round in which the vertex or a neighbour of it was picked.
    picked: Vec<u32>,
    /// Vertices that may still be removed.
    open: Vec<u32>,
    /// Vertices below the limits of this iteration and above the ceiling.
    waiting: Vec<u32>,
    /// Vertices above the last limits whose star has changed since they were tried: no later iteration will try them again.
    changed: Vec<u32>,
}

/// Why a run ended before there was nothing left to remove.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfinished {
    /// `go_on` said stop.
    Stopped,
    /// What the proof has to remember has outgrown ids of 32 bits.
    TooLarge(TooMany),
}

/// Removes vertices until the limits end, or nothing is left to remove.
///
/// # Errors
///
/// [`Unfinished`]: `go_on` said stop, or there is no room to go on.
pub fn run(
    decimation: &mut Decimation,
    mut thresholds: Thresholds,
    go_on: &dyn Fn(&Decimation) -> bool,
) -> Result<(), Unfinished> {
    let mut candidates = Candidates::new(decimation.surface.n_vertices());
    let mut round = 0;
    let mut limits = thresholds.limits();
    loop {
        candidates.admit(limits, &decimation.surface);
        let is_last = thresholds.is_last();
        for ceiling in thresholds.ceilings() {
            let waiting = std::mem::take(&mut candidates.waiting);
            let mut worklist = candidates.sort_out(limits, ceiling, waiting);
            let few = if is_last { 0 } else { worklist.len() / FEW };
            while worklist.len() > few {
                if !go_on(decimation) {
                    return Err(Unfinished::Stopped);
                }
                round += 1;
                let (picked, others) = candidates.pick(&decimation.surface, round, worklist);
                let under = Limits { global: ceiling, ..limits };
                let touched =
                    remove_all(decimation, &mut candidates, under, &picked).map_err(Unfinished::TooLarge)?;
                let next = candidates.touch(limits, is_last, touched).into_iter().chain(picked).chain(others);
                worklist = candidates.sort_out(limits, ceiling, next.collect());
                if worklist.is_empty() && ceiling >= limits.global {
                    worklist.extend(candidates.take_changed());
                }
            }
            candidates.waiting.extend(worklist);
        }
        if placement::is_due(decimation) {
            let moved = placement::improve(decimation, &candidates.open);
            candidates.forget_around(&decimation.surface, &moved);
            if !moved.is_empty() {
                continue;
            }
        }
        let Some(next) = thresholds.advance(candidates.least_needed()) else { return Ok(()) };
        limits = next;
    }
}

impl Candidates {
    fn new(n_vertices: usize) -> Self {
        Self {
            needed: vec![0.0; n_vertices],
            found: vec![0.0; n_vertices],
            picked: vec![0; n_vertices],
            open: (0..).take(n_vertices).collect(),
            waiting: vec![],
            changed: vec![],
        }
    }

    /// Lets all wait that the limits may admit. Drops vertices that are gone.
    fn admit(&mut self, limits: Limits, surface: &Surface) {
        self.open.retain(|&v| !surface.star(v).is_empty());
        let needed = &self.needed;
        let is_below = |v: &u32| is_admitted(needed[*v as usize], limits);
        self.waiting = self.open.iter().copied().filter(is_below).collect();
    }

    /// The least local limit that could admit anything.
    fn least_needed(&self) -> f64 {
        self.open.iter().map(|&v| f64::from(self.needed[v as usize])).fold(f64::INFINITY, f64::min)
    }

    /// Forgets what is known of the given vertices and their neighbours, all alive.
    fn forget_around(&mut self, surface: &Surface, vertices: &[u32]) {
        for &v in vertices {
            for &slot in surface.star(v) {
                surface.corners(slot).into_iter().for_each(|neighbour| self.forget(neighbour));
            }
        }
    }

    /// Those above the last limits whose star changed since they were tried, with nothing known of them. In ascending order, each once.
    fn take_changed(&mut self) -> Vec<u32> {
        let mut changed = std::mem::take(&mut self.changed);
        changed.par_sort_unstable();
        changed.dedup();
        changed.retain(|&v| self.needed[v as usize].is_finite());
        changed.iter().for_each(|&v| self.forget(v));
        changed
    }

    /// Takes note that the stars of `touched` have changed; gives those that may be tried under these limits.
    fn touch(&mut self, limits: Limits, is_last: bool, mut touched: Vec<u32>) -> Vec<u32> {
        touched.retain(|&v| {
            let needed = self.needed[v as usize];
            if needed.is_infinite() {
                self.forget(v);
            }
            let is_above = needed.is_finite() && f64::from(needed) > limits.local;
            if is_above && is_last {
                self.changed.push(v);
            }
            !is_above
        });
        touched
    }

    /// Those of the given vertices below the ceiling, each once: cheapest first, as far as is known, ties to the lower vertex. Those
    /// above it wait, or are left to a later iteration.
    fn sort_out(&mut self, limits: Limits, ceiling: f64, mut vertices: Vec<u32>) -> Vec<u32> {
        let Self { needed, found, waiting, .. } = self;
        vertices.retain(|&v| is_admitted(needed[v as usize], limits));
        waiting.extend(vertices.extract_if(.., |v| f64::from(found[*v as usize]) > ceiling));
        vertices
            .par_sort_unstable_by(|&a, &b| found[a as usize].total_cmp(&found[b as usize]).then(a.cmp(&b)));
        vertices.dedup();
        vertices
    }

    /// Parts the worklist into an independent set, no two of them neighbours, and the others. Who comes first is picked.
    fn pick(&mut self, surface: &Surface, round: u32, worklist: Vec<u32>) -> (Vec<u32>, Vec<u32>) {
        let picked = &mut self.picked;
        worklist.into_iter().partition(|&v| {
            let is_free = picked[v as usize] != round;
            if is_free {
                for &slot in surface.star(v) {
                    surface.corners(slot).iter().for_each(|&r| picked[r as usize] = round);
                }
            }
            is_free
        })
    }

    /// Takes note of what a vertex needs.
    fn set_verdict(&mut self, v: u32, verdict: Verdict, c2: f64) {
        let (needed, found) = match verdict {
            Verdict::Above(errors) => {
                let found = round_up(errors.global);
                // What is beyond `f32` is beyond every limit.
                let is_known = found.is_finite();
                let needed =
                    if is_known { round_up(errors.local.max(errors.global / c2)) } else { f32::INFINITY };
                (needed, if is_known { found } else { 0.0 })
            }
            Verdict::Impossible => (f32::INFINITY, 0.0),
        };
        self.needed[v as usize] = needed;
        self.found[v as usize] = found;
    }

    fn forget(&mut self, v: u32) {
        self.needed[v as usize] = 0.0;
        self.found[v as usize] = 0.0;
    }
}

/// Whether what a vertex needs is within the limits: what is impossible is not, even where they have no end.
fn is_admitted(needed: f32, limits: Limits) -> bool {
    needed.is_finite() && f64::from(needed) <= limits.local
}

/// Removes those of the picked vertices that are within the limits, one step each, and returns the vertices whose stars changed;
/// those may repeat.
///
/// Plans are made in parallel, a batch at a time so that they never take much memory, and carried out in turn.
///
/// # Errors
///
/// When there is no room for one.
fn remove_all(
    decimation: &mut Decimation,
    candidates: &mut Candidates,
    limits: Limits,
    picked: &[u32],
) -> Result<Vec<u32>, TooMany> {
    let mut touched = vec![];
    for batch in picked.chunks(BATCH) {
        decimation.error.compact();
        for (&v, planned) in batch.iter().zip(plan_all(decimation, limits, batch)) {
            let is_current = |plan: &Plan| plan.is_current(&decimation.surface, &decimation.error);
            let planned = match planned {
                Ok(overtaken) if !is_current(&overtaken) => {
                    plan(decimation.situation(), v, limits, &mut decimation.workers.scratch())
                }
                planned => planned,
            };
            let verdict = match planned {
                Ok(plan) => {
                    touched.extend_from_slice(&plan.hole.ring);
                    plan.carry_out(decimation)?;
                    Verdict::Impossible
                }
                Err(verdict) => verdict,
            };
            candidates.set_verdict(v, verdict, decimation.c2);
        }
    }
    decimation.compact();
    Ok(touched)
}

/// Plans the removal of every vertex of the batch, in parallel.
fn plan_all(decimation: &Decimation, limits: Limits, batch: &[u32]) -> Vec<Result<Plan, Verdict>> {
    let situation = decimation.situation();
    let plan_chunk = |chunk: &[u32]| {
        let mut scratch = decimation.workers.scratch();
        chunk.iter().map(|&v| plan(situation, v, limits, &mut scratch)).collect::<Vec<_>>()
    };
    batch.par_chunks(chunk_len(batch.len())).flat_map_iter(plan_chunk).collect()
}

/// Length of the chunks into which `n` candidates are cut for the current pool.
fn chunk_len(n: usize) -> usize {
    (n / (8 * rayon::current_num_threads())).clamp(1, CHUNK)
}
