//! The driver: iterations under rising limits, and in each of them rounds over an independent set.
//!
//! A heap would need the error of every neighbour again after every removal. Here what was last found of a vertex stands until
//! its turn comes, however much its star has changed since: it only decides whose turn it is. The ceilings rise so finely that
//! removals go nearly in the order of their errors all the same, and a vertex is judged as often as it is tried.

use super::batch::{Claims, Judged, carry_out, plan_all};
use super::candidate::Verdict;
use super::decimation::Decimation;
use super::placement;
use super::removal::Plan;
use super::thresholds::Thresholds;
use crate::bound::Limits;
use crate::bound::accumulated::round_up;
use crate::mesh::{Surface, TooMany};
use rayon::prelude::*;

/// Removals that are planned before the first of them is carried out.
const BATCH: usize = 512;

/// Candidates under one ceiling that are worked off together. They lie side by side on the surface, so that all that their removals
/// read and write stays in the cache from round to round; fewer would leave too little for the threads.
const BLOCK: usize = 4096;

/// The part of a block that is left to the next ceiling: rounds over a few candidates each would end it.
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
    /// The current round.
    round: u32,
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
    let mut claims = Claims::default();
    let mut limits = thresholds.limits();
    loop {
        candidates.admit(limits, &decimation.surface);
        for ceiling in thresholds.ceilings() {
            let stage = Stage { limits, ceiling, is_last: thresholds.is_last() };
            for block in candidates.take_below(limits, ceiling).chunks(BLOCK) {
                work_off(decimation, &mut candidates, &mut claims, stage, block, go_on)?;
            }
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

/// The part of an iteration under one ceiling.
#[derive(Clone, Copy, Debug)]
struct Stage {
    /// The limits of the iteration.
    limits: Limits,
    /// Most that a removal may err now, at most the global limit.
    ceiling: f64,
    /// Whether no other iteration follows.
    is_last: bool,
}

/// Removes what is within the ceiling of a block and of what its removals touch, in rounds; the few that are left wait for the next
/// ceiling.
///
/// # Errors
///
/// As [`run`].
fn work_off(
    decimation: &mut Decimation,
    candidates: &mut Candidates,
    claims: &mut Claims,
    stage: Stage,
    block: &[u32],
    go_on: &dyn Fn(&Decimation) -> bool,
) -> Result<(), Unfinished> {
    let Stage { limits, ceiling, is_last } = stage;
    // Other blocks have touched this one.
    let mut worklist = candidates.sort_out(limits, ceiling, block.to_vec());
    let few = if is_last { 0 } else { worklist.len() / FEW };
    while worklist.len() > few {
        if !go_on(decimation) {
            return Err(Unfinished::Stopped);
        }
        let under = Limits { global: ceiling, ..limits };
        let Round { touched, mut left } =
            remove_all(decimation, candidates, claims, under, &worklist).map_err(Unfinished::TooLarge)?;
        left.extend(candidates.touch(limits, is_last, touched));
        worklist = candidates.sort_out(limits, ceiling, left);
        if worklist.is_empty() && ceiling >= limits.global {
            worklist.extend(candidates.take_changed());
        }
    }
    candidates.waiting.extend(worklist);
    Ok(())
}

impl Candidates {
    fn new(n_vertices: usize) -> Self {
        Self {
            needed: vec![0.0; n_vertices],
            found: vec![0.0; n_vertices],
            picked: vec![0; n_vertices],
            round: 0,
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

    /// Takes those below the ceiling off those that wait, in ascending order: neighbours in it are neighbours on the surface.
    fn take_below(&mut self, limits: Limits, ceiling: f64) -> Vec<u32> {
        let mut below = std::mem::take(&mut self.waiting);
        self.retain_below(limits, ceiling, &mut below);
        below.par_sort_unstable();
        below.dedup();
        below
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

    /// Those of the given vertices below the ceiling, each once: cheapest first, as far as is known, ties to the lower vertex.
    #[expect(clippy::cast_possible_truncation, reason = "the lower half of a key is the vertex")]
    fn sort_out(&mut self, limits: Limits, ceiling: f64, mut vertices: Vec<u32>) -> Vec<u32> {
        self.retain_below(limits, ceiling, &mut vertices);
        // The bits of what is not negative are in its order.
        let key = |v: u32| u64::from(self.found[v as usize].to_bits()) << u32::BITS | u64::from(v);
        let mut keys: Vec<u64> = vertices.into_iter().map(key).collect();
        keys.sort_unstable();
        keys.dedup();
        keys.into_iter().map(|key| key as u32).collect()
    }

    /// Keeps the vertices below the ceiling. Those above it wait, or are left to a later iteration.
    fn retain_below(&mut self, limits: Limits, ceiling: f64, vertices: &mut Vec<u32>) {
        let Self { needed, found, waiting, .. } = self;
        vertices.retain(|&v| {
            let is_within = is_admitted(needed[v as usize], limits);
            let is_below = f64::from(found[v as usize]) <= ceiling;
            if is_within && !is_below {
                waiting.push(v);
            }
            is_within && is_below
        });
    }

    /// Picks the next vertices of the worklist for a batch, no two of the round neighbours, and takes them off it. Who comes first is
    /// picked; those passed over go to `left`.
    fn pick(&mut self, surface: &Surface, worklist: &mut &[u32], left: &mut Vec<u32>) -> Vec<u32> {
        let Self { picked, round, .. } = self;
        let mut batch = vec![];
        while let (true, [v, rest @ ..]) = (batch.len() < BATCH, *worklist) {
            *worklist = rest;
            if picked[*v as usize] == *round {
                left.push(*v);
                continue;
            }
            batch.push(*v);
            for &slot in surface.star(*v) {
                surface.corners(slot).iter().for_each(|&r| picked[r as usize] = *round);
            }
        }
        batch
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

/// What a round leaves to be looked at.
#[derive(Clone, Debug, Default)]
struct Round {
    /// Vertices whose stars changed; they may repeat.
    touched: Vec<u32>,
    /// Those of the worklist that were not removed.
    left: Vec<u32>,
}

/// Removes an independent set of the worklist, as far as it is within the limits, one step each: who comes first is in it.
///
/// Plans are made in parallel, a batch at a time so that they never take much memory; meanwhile the next batch is picked. A plan that
/// another one of its batch has overtaken is made anew with the next.
///
/// # Errors
///
/// When there is no room for a batch.
fn remove_all(
    decimation: &mut Decimation,
    candidates: &mut Candidates,
    claims: &mut Claims,
    limits: Limits,
    mut worklist: &[u32],
) -> Result<Round, TooMany> {
    let Round { mut touched, mut left } = Round::default();
    candidates.round += 1;
    let mut batch = candidates.pick(&decimation.surface, &mut worklist, &mut left);
    let mut done: Vec<Box<Plan>> = vec![];
    while !batch.is_empty() {
        let (judged, next) = rayon::join(
            || plan_all(decimation, limits, &batch),
            || candidates.pick(&decimation.surface, &mut worklist, &mut left),
        );
        let (plans, verdicts): (Vec<_>, Vec<_>) =
            judged.into_iter().map(|Judged { plans, verdicts }| (plans, verdicts)).unzip();
        let note = || {
            done.clear();
            for (v, verdict) in verdicts.into_iter().flatten() {
                left.push(v);
                candidates.set_verdict(v, verdict, decimation.c2);
            }
        };
        let ((plans, overtaken), ()) = rayon::join(|| claims.sort_out(plans.into_iter().flatten()), note);
        carry_out(decimation, &plans)?;
        for (hole, _) in plans.iter().map(|plan| plan.change()) {
            candidates.set_verdict(hole.removed, Verdict::Impossible, decimation.c2);
            touched.extend(&hole.ring);
        }
        done = plans;
        batch = overtaken;
        batch.extend(next);
    }
    decimation.close_up();
    Ok(Round { touched, left })
}
