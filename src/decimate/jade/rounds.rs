//! The driver: iterations under rising limits, and in each of them rounds over an independent set.

use super::candidate::{Verdict, judge};
use super::decimation::Decimation;
use super::placement;
use super::removal::{Plan, plan};
use super::thresholds::Thresholds;
use crate::bound::Limits;
use crate::bound::accumulated::round_up;
use crate::mesh::Surface;
use rayon::prelude::*;

/// Most candidates that one thread takes at a time. Of few candidates it takes fewer: the last ones of a history stand for
/// thousands of input vertices each.
const CHUNK: usize = 32;

/// Candidates whose verdicts are kept at a time.
const PART: usize = 8192;

/// Removals that are planned before the first of them is carried out.
const BATCH: usize = 512;

/// What is known of each vertex: the local limit below which it can certainly not be removed.
struct Candidates {
    /// 0 when nothing is known, infinite when it is impossible or the vertex is gone.
    needed: Vec<f32>,
    /// Global error, once it was found removable with its present star.
    removable: Vec<f32>,
    /// Last round in which the vertex or a neighbour of it was picked.
    picked: Vec<u32>,
    /// Vertices that may still be removed.
    open: Vec<u32>,
    /// Removable vertices above the ceiling.
    waiting: Vec<u32>,
    /// Vertices that were above the limit before their star changed. Most still are: they are judged when nothing else is left,
    /// and so once for many changes.
    deferred: Vec<u32>,
}

/// Marks a vertex that has not been found removable.
const UNKNOWN: f32 = f32::INFINITY;

/// Removes vertices until the limits end, or nothing is left to remove, or `go_on` says stop; false in that case.
pub fn run(
    decimation: &mut Decimation,
    mut thresholds: Thresholds,
    go_on: &dyn Fn(&Decimation) -> bool,
) -> bool {
    let mut candidates = Candidates::new(decimation.surface.n_vertices());
    let mut round = 0;
    let mut limits = thresholds.limits();
    loop {
        let mut worklist = candidates.below(limits, &decimation.surface);
        for ceiling in thresholds.ceilings() {
            worklist.extend(candidates.take_waiting());
            while !worklist.is_empty() {
                if !go_on(decimation) {
                    return false;
                }
                judge_all(decimation, &mut candidates, limits, &worklist);
                round += 1;
                let picked = pick(decimation, &mut candidates, round, ceiling, worklist);
                worklist = remove_all(decimation, &mut candidates, limits, &picked);
                if worklist.is_empty() && ceiling >= limits.global {
                    worklist = candidates.take_deferred();
                }
            }
        }
        if placement::is_due(decimation) {
            let moved = placement::improve(decimation, &candidates.open);
            candidates.forget_around(&decimation.surface, &moved);
            if !moved.is_empty() {
                continue;
            }
        }
        let Some(next) = thresholds.advance(candidates.least_needed()) else { return true };
        limits = next;
    }
}

impl Candidates {
    fn new(n_vertices: usize) -> Self {
        Self {
            needed: vec![0.0; n_vertices],
            removable: vec![UNKNOWN; n_vertices],
            picked: vec![0; n_vertices],
            open: (0..).take(n_vertices).collect(),
            waiting: vec![],
            deferred: vec![],
        }
    }

    /// Vertices that the limits may admit, in ascending order. Drops those that are gone.
    fn below(&mut self, limits: Limits, surface: &Surface) -> Vec<u32> {
        self.open.retain(|&v| !surface.star(v).is_empty());
        let needed = &self.needed;
        let limit = limits.local;
        self.open.iter().copied().filter(|&v| f64::from(needed[v as usize]) <= limit).collect()
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

    /// Those that wait and whose star is as it was.
    fn take_waiting(&mut self) -> Vec<u32> {
        let mut waiting = sorted(std::mem::take(&mut self.waiting));
        waiting.retain(|&v| self.is_removable(v));
        waiting
    }

    /// Those that were put off, with nothing known of them.
    fn take_deferred(&mut self) -> Vec<u32> {
        let mut deferred = sorted(std::mem::take(&mut self.deferred));
        deferred.retain(|&v| self.needed[v as usize].is_finite());
        deferred.iter().for_each(|&v| self.forget(v));
        deferred
    }

    /// Takes note that the stars of `touched` have changed; gives those to be judged next.
    fn touch(&mut self, limits: Limits, touched: Vec<u32>) -> Vec<u32> {
        let mut next = sorted(touched);
        next.retain(|&v| {
            let needed = self.needed[v as usize];
            let is_above = needed.is_finite() && f64::from(needed) > limits.local;
            if is_above {
                self.deferred.push(v);
            }
            !is_above
        });
        next.iter().for_each(|&v| self.forget(v));
        next
    }

    fn is_removable(&self, v: u32) -> bool {
        self.removable[v as usize] < UNKNOWN
    }

    fn forget(&mut self, v: u32) {
        self.needed[v as usize] = 0.0;
        self.removable[v as usize] = UNKNOWN;
    }

    fn close(&mut self, v: u32) {
        self.needed[v as usize] = f32::INFINITY;
        self.removable[v as usize] = UNKNOWN;
    }
}

/// Distinct vertices in ascending order.
fn sorted(mut vertices: Vec<u32>) -> Vec<u32> {
    vertices.par_sort_unstable();
    vertices.dedup();
    vertices
}

/// Judges every vertex of the worklist of which nothing is known, in parallel, a part at a time so that verdicts take little
/// memory.
fn judge_all(decimation: &Decimation, candidates: &mut Candidates, limits: Limits, worklist: &[u32]) {
    let situation = decimation.situation();
    let judge_chunk = |chunk: &[u32]| {
        let mut scratch = decimation.workers.scratch();
        chunk.iter().map(|&v| judge(situation, v, limits, &mut scratch)).collect::<Vec<_>>()
    };
    let unknown: Vec<u32> = worklist.iter().copied().filter(|&v| !candidates.is_removable(v)).collect();
    for part in unknown.chunks(PART) {
        let verdicts: Vec<Verdict> =
            part.par_chunks(chunk_len(part.len())).flat_map_iter(judge_chunk).collect();
        for (&v, verdict) in part.iter().zip(verdicts) {
            let v = v as usize;
            (candidates.needed[v], candidates.removable[v]) = match verdict {
                Verdict::Removable(errors) => (0.0, round_up(errors.global)),
                Verdict::Above(errors) => {
                    (round_up(errors.local.max(errors.global / decimation.c2)), UNKNOWN)
                }
                Verdict::Impossible => (f32::INFINITY, UNKNOWN),
            };
        }
    }
}

/// An independent set of vertices removable below the ceiling, no two of them neighbours: cheapest first, ties to the lower
/// vertex. Those above the ceiling wait.
fn pick(
    decimation: &Decimation,
    candidates: &mut Candidates,
    round: u32,
    ceiling: f64,
    worklist: Vec<u32>,
) -> Vec<u32> {
    let mut ranked = worklist;
    ranked.retain(|&v| candidates.is_removable(v));
    let is_below = |v: u32| f64::from(candidates.removable[v as usize]) <= ceiling;
    candidates.waiting.extend(ranked.iter().copied().filter(|&v| !is_below(v)));
    ranked.retain(|&v| is_below(v));
    ranked.par_sort_unstable_by(|&a, &b| {
        let error = |v: u32| candidates.removable[v as usize];
        error(a).total_cmp(&error(b)).then(a.cmp(&b))
    });
    ranked.retain(|&v| {
        let is_free = candidates.picked[v as usize] != round;
        if is_free {
            for &slot in decimation.surface.star(v) {
                decimation.surface.corners(slot).iter().for_each(|&r| candidates.picked[r as usize] = round);
            }
        }
        is_free
    });
    ranked
}

/// Removes the picked vertices, one step each, and returns the vertices to be judged anew, in ascending order.
///
/// Plans are made in parallel, a batch at a time so that they never take much memory, and carried out in turn.
fn remove_all(
    decimation: &mut Decimation,
    candidates: &mut Candidates,
    limits: Limits,
    picked: &[u32],
) -> Vec<u32> {
    let mut touched = vec![];
    for batch in picked.chunks(BATCH) {
        decimation.error.compact();
        for (&v, planned) in batch.iter().zip(plan_all(decimation, candidates, limits, batch)) {
            let is_current = |plan: &Plan| plan.is_current(&decimation.surface, &decimation.error);
            let plan = match planned {
                Some(plan) if is_current(&plan) => Some(plan),
                _ => {
                    let known = candidates.removable[v as usize].into();
                    plan(decimation.situation(), v, limits, known, &mut decimation.workers.scratch())
                }
            };
            match plan {
                Some(plan) => {
                    touched.extend_from_slice(&plan.hole.ring);
                    plan.carry_out(decimation);
                    candidates.close(v);
                }
                None => touched.push(v),
            }
        }
    }
    decimation.surface.compact();
    candidates.touch(limits, touched)
}

/// Plans the removal of every vertex of the batch, in parallel.
fn plan_all(
    decimation: &Decimation,
    candidates: &Candidates,
    limits: Limits,
    batch: &[u32],
) -> Vec<Option<Plan>> {
    let known = |v: u32| candidates.removable[v as usize].into();
    let situation = decimation.situation();
    let plan_chunk = |chunk: &[u32]| {
        let mut scratch = decimation.workers.scratch();
        chunk.iter().map(|&v| plan(situation, v, limits, known(v), &mut scratch)).collect::<Vec<_>>()
    };
    batch.par_chunks(chunk_len(batch.len())).flat_map_iter(plan_chunk).collect()
}

/// Length of the chunks into which `n` candidates are cut for the current pool.
fn chunk_len(n: usize) -> usize {
    (n / (8 * rayon::current_num_threads())).clamp(1, CHUNK)
}
