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
use super::worklists::{Candidates, Stage};
use crate::bound::Limits;
use crate::mesh::TooMany;

/// Removals that are planned before the first of them is carried out.
const BATCH: usize = 512;

/// Candidates under one ceiling that are worked off together. They lie side by side on the surface, so that all that their removals
/// read and write stays in the cache from round to round; fewer would leave too little for the threads.
const BLOCK: usize = 4096;

/// The part of a block that is left to the next ceiling: rounds over a few candidates each would end it.
const FEW: usize = 3;

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
        candidates.admit(limits, thresholds.ceilings().collect(), &decimation.surface);
        for (step, ceiling) in thresholds.ceilings().enumerate() {
            let stage = Stage { limits, ceiling, step, is_last: thresholds.is_last() };
            for block in candidates.take_below(stage).chunks(BLOCK) {
                work_off(decimation, &mut candidates, &mut claims, stage, block, go_on)?;
            }
        }
        if placement::is_due(decimation) {
            let moved = placement::improve(decimation, candidates.open());
            candidates.forget_around(&decimation.surface, &moved);
            if !moved.is_empty() {
                continue;
            }
        }
        let Some(next) = thresholds.advance(candidates.least_needed()) else { return Ok(()) };
        limits = next;
    }
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
    let Stage { limits, ceiling, is_last, .. } = stage;
    // Other blocks have touched this one.
    let mut worklist = candidates.sort_out(stage, block.to_vec());
    let few = if is_last { 0 } else { worklist.len() / FEW };
    while worklist.len() > few {
        if !go_on(decimation) {
            return Err(Unfinished::Stopped);
        }
        let under = Limits { global: ceiling, ..limits };
        let Round { touched, mut left } =
            remove_all(decimation, candidates, claims, under, &worklist).map_err(Unfinished::TooLarge)?;
        left.extend(candidates.touch(stage, touched));
        worklist = candidates.sort_out(stage, left);
        if worklist.is_empty() && ceiling >= limits.global {
            worklist.extend(candidates.take_changed());
        }
    }
    candidates.put_off(stage, worklist);
    Ok(())
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
/// Plans are made in parallel, a batch at a time so that they never take much memory; meanwhile those carried out are dropped and the
/// next batch is picked. A plan that another one of its batch has overtaken is made anew with the next.
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
    candidates.start_round();
    let mut batch = candidates.pick(&decimation.surface, BATCH, &mut worklist, &mut left);
    let mut done: Vec<Box<Plan>> = vec![];
    while !batch.is_empty() {
        let (judged, next) = rayon::join(
            || plan_all(decimation, limits, &batch),
            || {
                done.clear();
                candidates.pick(&decimation.surface, BATCH, &mut worklist, &mut left)
            },
        );
        let mut found = vec![];
        for Judged { plans, verdicts } in judged {
            found.extend(plans);
            for (v, verdict) in verdicts {
                left.push(v);
                candidates.set_verdict(v, verdict, decimation.c2);
            }
        }
        let (plans, overtaken) = claims.take_independent(found);
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
