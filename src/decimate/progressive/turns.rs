//! Vertices whose turn has come: what is to become of each.
//!
//! The paper takes one vertex after the other. Here, while many are queued, some hundred are taken at once and judged side by side;
//! then each that the ones before it have left alone goes its way, in their order. How many are taken depends on the queue
//! alone, and so the result does not depend on the number of threads.

use super::accumulated::Accumulated;
use super::choices::Choices;
use super::classify::Class;
use super::collapse::{Candidate, Collapse, Marks, best_valid, still_valid};
use super::complex::Complex;
use super::decimation::Settings;
use super::shadow::Shadow;
use super::view::View;
use super::wedges::Wedges;
use rayon::prelude::*;

/// A vertex goes back to the queue when its error is found to be so much larger than the one it was queued with.
pub(super) const REQUEUED_FROM: f64 = 1.05;
/// One turn at once for so many vertices in the queue: the order is off by less than half a percent of them.
const QUEUED_PER_TURN: usize = 256;
/// Most turns at once.
const MAX_TURNS: usize = 256;
/// Fewer are judged one by one.
const MIN_TURNS: usize = 24;
/// Into so many parts the turns are divided.
const N_PARTS: usize = 4;

/// A vertex taken from the queue.
#[derive(Clone, Debug, Default)]
pub(super) struct Turn {
    pub(super) vertex: u32,
    /// Error that it was queued with.
    pub(super) queued: f64,
    pub(super) view: View,
    pub(super) verdict: Verdict,
}

/// What is to become of a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Verdict {
    /// It has no triangle.
    #[default]
    Gone,
    /// It has no valid collapse and waits for a split.
    Aside,
    /// It is at a crack's tip, which has to be closed first.
    Crack,
    /// Its error is larger than it was thought to be: local error.
    Later(f64),
    /// The error of its best collapse is larger than it was thought to be.
    ChosenLater(Collapse),
    /// It is collapsed.
    Collapse(Collapse),
}

/// What vertices are judged by; nothing of it changes meanwhile.
#[derive(Clone, Copy)]
pub(super) struct Judge<'a> {
    pub(super) complex: &'a Complex,
    pub(super) wedges: Option<&'a Wedges>,
    pub(super) accumulated: &'a Accumulated,
    pub(super) choices: &'a Choices,
    pub(super) settings: &'a Settings,
}

/// Room for judging, of one thread.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub(super) shadow: Shadow,
    pub(super) marks: Marks,
}

/// Turns at once while so many vertices are queued.
pub(super) fn n_at_once(n_queued: usize) -> usize {
    let n = (n_queued / QUEUED_PER_TURN).min(MAX_TURNS);
    if n < MIN_TURNS { 1 } else { n }
}

/// Judges all turns, on the current rayon pool where there are many.
pub(super) fn judge_all(judge: Judge<'_>, turns: &mut [Turn], scratches: &mut Vec<Scratch>) {
    scratches.resize_with(N_PARTS, Scratch::default);
    let part = if turns.len() < MIN_TURNS { turns.len().max(1) } else { turns.len().div_ceil(N_PARTS) };
    let judge_part = |(turns, scratch): (&mut [Turn], &mut Scratch)| {
        turns.iter_mut().for_each(|turn| judge.judge(turn, scratch));
    };
    if turns.len() <= part {
        scratches.iter_mut().take(1).for_each(|scratch| judge_part((&mut *turns, scratch)));
    } else {
        turns.par_chunks_mut(part).zip(scratches.par_iter_mut()).for_each(judge_part);
    }
}

impl Judge<'_> {
    /// Looks at a vertex and finds its best collapse, unless it is clear before that its turn has not come yet.
    fn judge(&self, turn: &mut Turn, scratch: &mut Scratch) {
        let Turn { vertex, queued, ref mut view, .. } = *turn;
        view.gather(self.complex, self.wedges, vertex, self.settings.cos_feature_angle);
        let limit = queued * REQUEUED_FROM + f64::from(f32::MIN_POSITIVE) - self.accumulated.at(vertex);
        turn.verdict = if view.class == Class::Empty {
            Verdict::Gone
        } else if !view.class.may_collapse() {
            Verdict::Aside
        } else {
            let error = if self.choices.is_measured(vertex) { 0.0 } else { view.error() };
            match (error > limit).then_some(error) {
                Some(error) => Verdict::Later(error),
                None => match self.best_collapse(view, scratch) {
                    None => Verdict::Aside,
                    Some(_) if view.class == Class::CrackTip => Verdict::Crack,
                    Some(collapse) if collapse.distance > limit => Verdict::ChosenLater(collapse),
                    Some(collapse) => Verdict::Collapse(collapse),
                },
            }
        };
    }

    /// The collapse chosen earlier for the vertex, if nothing has come between; otherwise the best one that it has now.
    pub(super) fn best_collapse(&self, view: &View, scratch: &mut Scratch) -> Option<Collapse> {
        let View { ring, geometry, class } = view;
        let Scratch { shadow, marks } = scratch;
        let candidate = Candidate { complex: self.complex, ring, geometry, class: *class };
        let chosen = self.choices.of(ring.center);
        let chosen = chosen.and_then(|choice| still_valid(self.complex, ring, choice, marks));
        chosen.or_else(|| best_valid(candidate, shadow, marks))
    }
}
