//! Vertices whose turn has come, and what is decided for each.
//!
//! The paper takes one vertex after the other. Here, while many are queued, some hundred are taken
//! at once and judged side by side; then what was decided is carried out in order for each whose
//! star the earlier ones left as it was. How many are taken depends on the queue alone, and so the
//! result does not depend on the number of threads.

use super::accumulated::AccumulatedErrors;
use super::choices::Choices;
use super::classify::VertexClass;
use super::collapse::{Collapse, CollapseCandidate, VertexMarks, best_valid, still_valid};
use super::options::Settings;
use super::shadow::Shadow;
use super::view::Surroundings;
use crate::mesh::{Surface, Wedges};
use rayon::prelude::*;

/// A vertex goes back to the queue if its error exceeds the one it was queued with by this factor.
pub(super) const REQUEUED_FROM: f64 = 1.05;
/// One turn at once for so many vertices in the queue: the order is off by less than half a percent
/// of them.
const QUEUED_PER_TURN: usize = 256;
/// Most turns at once.
const MAX_TURNS: usize = 256;
/// Fewer are judged one by one.
const MIN_TURNS: usize = 24;
/// Parts that turns are divided into.
const N_PARTS: usize = 4;

/// A vertex taken from the queue.
#[derive(Clone, Debug, Default)]
pub(super) struct Turn {
    pub(super) vertex: u32,
    /// Error that it was queued with.
    pub(super) queued: f64,
    pub(super) view: Surroundings,
    pub(super) decision: Decision,
}

/// What is decided for a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Decision {
    /// It has no triangle.
    #[default]
    Gone,
    /// It has no valid collapse and waits for a split.
    Aside,
    /// It is at a crack's tip, which has to be closed first.
    Crack,
    /// Its local error is larger than the error it was queued with.
    Later(f64),
    /// The error of its best collapse is larger than the error it was queued with.
    ChosenLater(Collapse),
    /// It is collapsed.
    Collapse(Collapse),
}

/// What vertices are judged by; nothing of it changes meanwhile.
#[derive(Clone, Copy)]
pub(super) struct Judge<'a> {
    pub(super) surface: &'a Surface,
    pub(super) wedges: Option<&'a Wedges>,
    pub(super) accumulated: &'a AccumulatedErrors,
    pub(super) choices: &'a Choices,
    pub(super) settings: &'a Settings,
}

/// Room for judging, of one thread.
#[derive(Clone, Debug, Default)]
pub(super) struct JudgeBuffers {
    pub(super) shadow: Shadow,
    pub(super) marks: VertexMarks,
}

/// Turns at once while so many vertices are queued.
pub(super) fn n_at_once(n_queued: usize) -> usize {
    let n = (n_queued / QUEUED_PER_TURN).min(MAX_TURNS);
    if n < MIN_TURNS { 1 } else { n }
}

/// Judges all turns, on the current rayon pool where there are many.
pub(super) fn judge_all(judge: Judge<'_>, turns: &mut [Turn], scratches: &mut Vec<JudgeBuffers>) {
    scratches.resize_with(N_PARTS, JudgeBuffers::default);
    let part = if turns.len() < MIN_TURNS { turns.len().max(1) } else { turns.len().div_ceil(N_PARTS) };
    let judge_part = |(turns, scratch): (&mut [Turn], &mut JudgeBuffers)| {
        turns.iter_mut().for_each(|turn| judge.judge(turn, scratch));
    };
    if turns.len() <= part {
        scratches.iter_mut().take(1).for_each(|scratch| judge_part((&mut *turns, scratch)));
    } else {
        turns.par_chunks_mut(part).zip(scratches.par_iter_mut()).for_each(judge_part);
    }
}

impl Judge<'_> {
    /// Evaluates a vertex and finds its best collapse, unless its local error already sends it back
    /// to the queue.
    fn judge(&self, turn: &mut Turn, scratch: &mut JudgeBuffers) {
        let Turn { vertex, queued, ref mut view, .. } = *turn;
        view.gather(self.surface, self.wedges, vertex, self.settings.cos_feature_angle);
        let limit = queued * REQUEUED_FROM + f64::from(f32::MIN_POSITIVE) - self.accumulated.at(vertex);
        turn.decision = if view.class == VertexClass::Empty {
            Decision::Gone
        } else if !view.class.may_collapse() {
            Decision::Aside
        } else {
            let error = if self.choices.is_measured(vertex) { 0.0 } else { view.error() };
            match (error > limit).then_some(error) {
                Some(error) => Decision::Later(error),
                None => match self.best_collapse(view, scratch) {
                    None => Decision::Aside,
                    Some(_) if view.class == VertexClass::CrackTip => Decision::Crack,
                    Some(collapse) if collapse.distance > limit => Decision::ChosenLater(collapse),
                    Some(collapse) => Decision::Collapse(collapse),
                },
            }
        };
    }

    /// The collapse chosen earlier for the vertex if it is still valid, otherwise the best one now.
    pub(super) fn best_collapse(&self, view: &Surroundings, scratch: &mut JudgeBuffers) -> Option<Collapse> {
        let Surroundings { ring, geometry, class } = view;
        let JudgeBuffers { shadow, marks } = scratch;
        let candidate = CollapseCandidate { surface: self.surface, ring, geometry, class: *class };
        let chosen = self.choices.of(ring.center);
        let chosen = chosen.and_then(|choice| still_valid(self.surface, ring, choice, marks));
        chosen.or_else(|| best_valid(candidate, shadow, marks))
    }
}
