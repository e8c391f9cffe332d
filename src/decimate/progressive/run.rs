//! The driver (section 4.1): vertices in the order of their errors, collapses while there are any,
//! then splits.

use super::classify::VertexClass;
use super::collapse::{Collapse, still_valid};
use super::options::Settings;
use super::proof::Proof;
use super::schedule::Schedule;
use super::state::State;
use super::turns::{Decision, Judge, REQUEUED_FROM, Turn, judge_all, n_at_once};
use super::{ProgressiveBound, ProgressiveOptions, ProgressiveReport};
use crate::decimate::{Decimated, Input, Stopped, Watch, add_copies};
use crate::mesh::{Repaired, Surface, Wedges, along_a_curve};
use nephrite_formats::TriangleMesh;
use std::ops::ControlFlow;

/// Operations between two calls of the observer.
const WATCH_INTERVAL: usize = 1024;

/// Decimates a mesh until the reduction asked for is reached or the error would be too large. The
/// bound is proven for as long as it can be if it is to be
/// [certified](ProgressiveBound::Certified).
///
/// # Errors
///
/// [`Stopped`] when `watch` breaks.
pub(crate) fn run(
    input: Input<Repaired>,
    options: &ProgressiveOptions,
    watch: Watch<'_>,
) -> Result<Decimated<TriangleMesh, 3, ProgressiveReport>, Stopped> {
    let may_change = input.may_change();
    let Input { mesh, max_error, cos_feature_angle, lock_boundary } = input;
    let Repaired { mut mesh, points, looks, .. } = along_a_curve(mesh);
    let settings = Settings {
        cos_feature_angle,
        max_error: max_error.unwrap_or(f64::INFINITY),
        rounding: mesh.rounding,
        proves: options.bound == ProgressiveBound::Certified,
        options: *options,
    };
    let (triangles, wedges) = Wedges::part(mesh.triangles.clone(), points, looks);
    let mut surface = Surface::new(mesh.positions.clone(), triangles);
    if lock_boundary {
        surface.lock_boundary();
    }
    let n_vertices = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
    let mut state = State::new(surface, wedges, n_vertices, settings);
    // Inside the pool from the start: to enter it for each of the many short parallel parts would
    // cost more than they do.
    if may_change && rayon::scope(|_| state.decimate(watch)).is_break() {
        return Err(Stopped::Interrupted);
    }
    let (history, report) = state.finish();
    add_copies(&mut mesh, report.trace.copies.iter().map(|&copied| (copied, None)));
    Ok(Decimated { mesh, history, report })
}

/// What is to be done next.
enum Next {
    /// Collapses of so many vertices from the queue.
    Collapses(usize),
    /// A split of this vertex.
    Split(u32),
    /// There is no vertex left.
    Nothing,
}

impl State {
    /// Decimates until the reduction asked for is reached, the error would be too large, or `watch`
    /// breaks.
    fn decimate(&mut self, watch: Watch<'_>) -> ControlFlow<()> {
        let n_target = self.n_target();
        if self.settings.options.pre_split {
            self.pre_split();
        }
        if self.settings.proves {
            self.proof = Some(Proof::new(&self.surface, self.settings.rounding));
        }
        self.evaluate_all();
        let mut n_unwatched = WATCH_INTERVAL;
        while self.surface.n_triangles() > n_target {
            if n_unwatched >= WATCH_INTERVAL {
                n_unwatched = 0;
                watch(self.surface.n_triangles(), self.journal.recorder.error())?;
            }
            match self.next() {
                Next::Collapses(n) => {
                    n_unwatched += n;
                    self.take_turns(n, n_target);
                }
                Next::Split(v) => {
                    n_unwatched += 1;
                    self.split(v);
                }
                Next::Nothing => break,
            }
        }
        ControlFlow::Continue(())
    }

    /// What to do next: the vertex with the least error is collapsed. Splits wait until no collapse
    /// is left; from then on, or from the start if the mesh was pre-split, they are ordered by
    /// error among the collapses.
    fn next(&mut self) -> Next {
        let may_split = match (self.schedule.queue.least(), self.schedule.stuck.least()) {
            (None, _) => true,
            (Some(collapse), Some(split)) => self.schedule.splits && split < collapse,
            (Some(_), None) => false,
        };
        self.schedule.splits |= may_split;
        if may_split {
            self.schedule.stuck.pop().map_or(Next::Nothing, |(v, _)| Next::Split(v))
        } else {
            Next::Collapses(if self.schedule.splits { 1 } else { n_at_once(self.schedule.queue.len()) })
        }
    }

    /// Triangles at which to stop.
    fn n_target(&self) -> usize {
        let kept = 1.0 - self.settings.options.reduction.unwrap_or(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a count")]
        let n_target = (self.surface.n_triangles() as f64 * kept).floor() as usize;
        n_target
    }

    /// Takes `n` vertices from the queue and carries out what is decided for each, until `n_target`
    /// triangles are left.
    fn take_turns(&mut self, n: usize, n_target: usize) {
        self.schedule.n_rounds += 1;
        let mut turns = std::mem::take(&mut self.schedule.turns);
        turns.resize_with(n.max(turns.len()), Turn::default);
        let mut n_taken = 0;
        while let Some((vertex, queued)) = if n_taken < n { self.schedule.queue.pop() } else { None } {
            (turns[n_taken].vertex, turns[n_taken].queued) = (vertex, queued);
            n_taken += 1;
        }
        let mut scratches = std::mem::take(&mut self.schedule.scratches);
        let Self { surface, wedges, accumulated, schedule: Schedule { choices, .. }, settings, .. } = &*self;
        let judge = Judge { surface, wedges: wedges.as_ref(), accumulated, choices, settings };
        judge_all(judge, &mut turns[..n_taken], &mut scratches);
        self.schedule.scratches = scratches;
        for turn in &mut turns[..n_taken] {
            if self.surface.n_triangles() <= n_target {
                break;
            }
            self.take_turn(turn);
        }
        self.schedule.turns = turns;
    }

    /// Carries out what was decided for a vertex unless its star has changed since. If its error is
    /// larger than the one it was queued with, it goes back to the queue with that error.
    fn take_turn(&mut self, turn: &mut Turn) {
        let v = turn.vertex;
        if self.schedule.changed_in[v as usize] == self.schedule.n_rounds {
            // Its star has changed since it was taken. It has been evaluated again unless that was
            // put off.
            if !self.schedule.queue.contains(v) && !self.schedule.stuck.contains(v) {
                self.evaluate(v);
            }
            return;
        }
        let accumulated = self.accumulated.at(v);
        match turn.decision {
            Decision::Gone => {}
            Decision::Later(error) => {
                self.schedule.choices.measure(v);
                self.schedule.queue.set(v, error + accumulated);
            }
            Decision::ChosenLater(Collapse { into, distance, .. }) => {
                self.schedule.choices.choose(v, turn.view.ring.vertices[into], distance);
                self.schedule.queue.set(v, distance + accumulated);
            }
            Decision::Aside | Decision::Crack | Decision::Collapse(_) => {
                std::mem::swap(&mut self.view, &mut turn.view);
                self.carry_out(v, turn.decision, turn.queued);
            }
        }
    }

    fn carry_out(&mut self, v: u32, decision: Decision, queued: f64) {
        match decision {
            Decision::Crack => self.close_crack_and_collapse(v),
            Decision::Collapse(collapse) => {
                let has_changed = |r: &u32| self.schedule.changed_in[*r as usize] == self.schedule.n_rounds;
                let collapse = if self.view.ring.vertices.iter().any(has_changed) {
                    // The triangles beyond its star decide what its collapse does to the topology.
                    let choice = (self.view.ring.vertices[collapse.into], collapse.distance);
                    let marks = &mut self.schedule.scratches[0].marks;
                    still_valid(&self.surface, &self.view.ring, choice, marks)
                } else {
                    Some(collapse)
                };
                match collapse {
                    Some(collapse) => self.collapse_or_wait(v, collapse, queued),
                    None => {
                        self.schedule.choices.forget(v);
                        self.schedule.queue.set(v, queued);
                    }
                }
            }
            _ => self.set_aside(v),
        }
    }

    /// Collapses the vertex at hand. The last triangle of a part waits until it is the turn of its
    /// distance from the rest.
    fn collapse_or_wait(&mut self, v: u32, collapse: Collapse, queued: f64) {
        match self.distance_of_last() {
            Some(distance) if distance > queued * REQUEUED_FROM + f64::from(f32::MIN_POSITIVE) => {
                let into = self.view.ring.vertices[collapse.into];
                self.schedule.choices.choose(v, into, (distance - self.accumulated.at(v)).max(0.0));
                self.schedule.queue.set(v, distance);
            }
            _ => {
                self.collapse(collapse);
            }
        }
    }

    /// Closes the crack that ends at `v`, so that it cannot travel, and collapses what is then a
    /// simple vertex.
    fn close_crack_and_collapse(&mut self, v: u32) {
        if !self.schedule.keeps_crack[v as usize] && self.close_crack() {
            self.look_at(v);
            if self.view.ring.is_cycle() {
                self.view.class = VertexClass::Simple;
            }
            if let Some(collapse) = self.best_collapse() {
                self.schedule.keeps_crack[v as usize] = !self.collapse(collapse);
                return;
            }
        }
        self.schedule.keeps_crack[v as usize] = true;
        self.set_aside(v);
    }

    fn best_collapse(&mut self) -> Option<Collapse> {
        let Self {
            surface,
            wedges,
            accumulated,
            schedule: Schedule { choices, scratches, .. },
            settings,
            view,
            ..
        } = self;
        let judge = Judge { surface, wedges: wedges.as_ref(), accumulated, choices, settings };
        judge.best_collapse(view, scratches.first_mut()?)
    }

    /// Puts the vertex at hand among those that wait for a split.
    fn set_aside(&mut self, v: u32) {
        self.schedule.stuck.set(v, self.error_in_view(v) + self.view.size());
    }
}
