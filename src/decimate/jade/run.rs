//! The driver: iterations under rising limits, and in each of them rounds over an independent set.
//!
//! A heap would need the error of every neighbour again after every removal. Here what was last
//! found of a vertex stands until its turn comes, however much its star has changed since: it only
//! decides whose turn it is. The ceilings rise so finely that removals go nearly in the order of
//! their errors all the same, and a vertex is judged as often as it is tried.

use super::batch::{Claims, Judged, carry_out, plan_all};
use super::candidate::Refusal;
use super::options::JadeOptions;
use super::placement;
use super::removal::Plan;
use super::state::State;
use super::thresholds::Thresholds;
use super::worklists::{Candidates, Stage};
use crate::bound::Limits;
use crate::decimate::{Decimated, Input, Stopped, Watch};
use crate::geometry::bounds::bounding_diagonal;
use crate::mesh::{Repaired, TooMany};
use nephrite_formats::TriangleMesh;

/// Most removals that are planned before the first of them is carried out.
const BATCH: usize = 512;

/// Candidates under one ceiling that are processed together. They lie side by side on the surface,
/// so that all that their removals read and write stays in the cache from round to round; fewer
/// would leave too little for the threads.
const BLOCK: usize = 4096;

/// One of so many candidates of a block is left to the next ceiling: a block would end in rounds
/// over a few candidates each.
const LEFT_OVER_DIVISOR: usize = 3;

/// Decimates a mesh until the limits end or nothing is left to remove. The mesh that it gives has
/// no triangles: those of the input are the ones of the history that are born at step 0.
///
/// # Errors
///
/// [`Stopped`]: `watch` broke, or the proof has outgrown ids of 32 bits.
pub(crate) fn run(
    input: Input<Repaired>,
    options: &JadeOptions,
    watch: Watch<'_>,
) -> Result<Decimated<TriangleMesh, 3, ()>, Stopped> {
    let diagonal = bounding_diagonal(&input.mesh.mesh.positions);
    let thresholds = input.may_change().then(|| Thresholds::new(input.max_error, diagonal, options));
    let mut state = State::new(input, options);
    if let Some(thresholds) = thresholds {
        remove_under_rising_limits(&mut state, thresholds, watch)?;
    }
    Ok(state.finish())
}

/// Goes through the iterations: each removes what is within its limits, ceiling by ceiling.
fn remove_under_rising_limits(
    state: &mut State,
    mut thresholds: Thresholds,
    watch: Watch<'_>,
) -> Result<(), Stopped> {
    let mut candidates = Candidates::new(state.surface.n_vertices());
    let mut claims = Claims::default();
    let mut limits = thresholds.limits();
    loop {
        candidates.admit(limits, thresholds.ceilings().collect(), &state.surface);
        for (step, ceiling) in thresholds.ceilings().enumerate() {
            let stage = Stage { limits, ceiling, step, is_last: thresholds.is_last() };
            for block in candidates.take_below(stage).chunks(BLOCK) {
                process_block(state, &mut candidates, &mut claims, stage, block, watch)?;
            }
        }
        if placement::is_due(state) {
            let moved = placement::improve(state, candidates.open());
            candidates.forget_around(&state.surface, &moved);
            // Removals find new room under the same limits.
            if !moved.is_empty() {
                continue;
            }
        }
        let Some(next) = thresholds.advance(candidates.least_needed()) else { return Ok(()) };
        limits = next;
    }
}

/// Removes what is below the ceiling in a block and among what its removals touch, in rounds. The
/// last few wait for the next ceiling.
fn process_block(
    state: &mut State,
    candidates: &mut Candidates,
    claims: &mut Claims,
    stage: Stage,
    block: &[u32],
    watch: Watch<'_>,
) -> Result<(), Stopped> {
    let Stage { limits, ceiling, is_last, .. } = stage;
    // Other blocks have touched this one since it was listed.
    let mut worklist = candidates.sort_out(stage, block.to_vec());
    let n_left_over = if is_last { 0 } else { worklist.len() / LEFT_OVER_DIVISOR };
    while worklist.len() > n_left_over {
        if watch(state.surface.n_triangles(), state.recorder.error()).is_break() {
            return Err(Stopped::Interrupted);
        }
        let under = Limits { global: ceiling, ..limits };
        let Round { touched, mut left } = remove_independent(state, candidates, claims, under, &worklist)?;
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

/// Removes an independent set of the worklist, as far as it is within the limits, one step each:
/// the first ones of the list are in it.
///
/// Plans are made in parallel, a batch at a time so that they never take much memory; meanwhile
/// those carried out are dropped and the next batch is picked. A plan that another one of its
/// batch has overtaken is made anew with the next batch.
///
/// # Errors
///
/// When there is no room for what the proof has to remember.
fn remove_independent(
    state: &mut State,
    candidates: &mut Candidates,
    claims: &mut Claims,
    limits: Limits,
    mut worklist: &[u32],
) -> Result<Round, TooMany> {
    let Round { mut touched, mut left } = Round::default();
    candidates.start_round();
    let mut batch = candidates.pick(&state.surface, BATCH, &mut worklist, &mut left);
    let mut done: Vec<Box<Plan>> = vec![];
    while !batch.is_empty() {
        let (judged, next) = rayon::join(
            || plan_all(state, limits, &batch),
            || {
                done.clear();
                candidates.pick(&state.surface, BATCH, &mut worklist, &mut left)
            },
        );
        let mut found = vec![];
        for Judged { plans, refusals } in judged {
            found.extend(plans);
            for (v, refusal) in refusals {
                left.push(v);
                candidates.set_refusal(v, refusal, state.options.c2);
            }
        }
        let (plans, overtaken) = claims.take_independent(found);
        carry_out(state, &plans)?;
        for (hole, _) in plans.iter().map(|plan| plan.change()) {
            candidates.set_refusal(hole.removed, Refusal::Impossible, state.options.c2);
            touched.extend(&hole.ring);
        }
        done = plans;
        batch = overtaken;
        batch.extend(next);
    }
    state.close_up();
    Ok(Round { touched, left })
}
