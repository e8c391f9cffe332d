//! The driver (section 4.1): vertices in the order of their errors, collapses while there are any, then splits.

use super::accumulated::Accumulated;
use super::choices::Choices;
use super::classify::Class;
use super::collapse::{Collapse, still_valid};
use super::complex::Complex;
use super::deviations::Deviations;
use super::events::EventLog;
use super::journal::{Counts, Journal};
use super::proof::Proof;
use super::queue::Queue;
use super::split::Pieces;
use super::turns::{Judge, REQUEUED_FROM, Scratch, Turn, Verdict, judge_all, n_at_once};
use super::vanished::Vanished;
use super::view::{Place, View};
use super::wedges::Wedges;
use super::{ProgressiveOptions, ProgressiveReport};
use crate::history::{History, Recorder};
use rayon::prelude::*;

/// Stars of more triangles than this are not looked at again after every change of a neighbour, but after every
/// so many that a part of the star may have changed: a fan of a hundred thousand triangles would cost their square.
const LARGE_VALENCE: usize = 64;
/// So many vertices in the queue are many: the last ones, whose errors are largest, are always queued with what they are.
const MANY: usize = 2048;
/// Operations between two calls of the observer.
const WATCH_INTERVAL: usize = 1024;

/// What a decimation works on, and what it has done so far.
#[derive(Clone, Debug)]
pub struct Decimation {
    /// The current mesh; its vertices are points.
    pub complex: Complex,
    /// History and operations so far.
    pub journal: Journal,
    /// Changes of topology so far.
    pub events: EventLog,
    /// How many operations of each kind there were.
    pub counts: Counts,
    pub(super) wedges: Option<Wedges>,
    pub(super) proof: Option<Proof>,
    /// Steps whose error is proven, step 0 included.
    pub(super) n_proven: u32,
    pub(super) accumulated: Accumulated,
    pub(super) deviations: Deviations,
    pub(super) vanished: Vanished,
    pub(super) queue: Queue,
    /// Vertices without a valid collapse: to be split once nothing else is left.
    pub(super) stuck: Queue,
    pub(super) settings: Settings,
    /// What is known of vertices in the queue.
    choices: Choices,
    /// Whether splits have their turn.
    splits: bool,
    /// Changes around vertices of large valence since they were last looked at.
    n_changes: Vec<u32>,
    /// Vertices at which closing a crack has led to nothing: it is not tried again, or cracks might open and close for ever.
    keeps_crack: Vec<bool>,
    /// The vertex at hand.
    pub(super) view: View,
    /// A neighbour of it.
    neighbor: View,
    /// Vertices taken from the queue, and room to judge them.
    turns: Vec<Turn>,
    scratches: Vec<Scratch>,
    /// How often vertices were taken from the queue, and for each vertex when its star last changed in that count.
    n_rounds: u32,
    changed_in: Vec<u32>,
    pub(super) pieces: Pieces,
    /// Wedges at the vertex and where they go.
    pub(super) pairs: Vec<[u32; 2]>,
}

/// What the decimation is to do.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Cosine of the feature angle.
    pub cos_feature_angle: f64,
    /// Nothing is done that would make the error larger than this.
    pub max_error: f64,
    /// How far the worst vertex was moved when the mesh was read: part of every error.
    pub rounding: f64,
    /// Whether to prove the error while that can be done.
    pub proves: bool,
    /// Reduction and splits.
    pub options: ProgressiveOptions,
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

impl Decimation {
    /// A decimation of `complex`, with the wedges at its corners if it has seams, over `n_wedges` vertices.
    pub fn new(complex: Complex, wedges: Option<Wedges>, n_wedges: u32, settings: Settings) -> Self {
        let n_points = complex.n_points();
        let recorder = Recorder::new(complex.n_slots(), n_wedges as usize, settings.rounding);
        Self {
            journal: Journal::new(recorder, n_wedges),
            events: EventLog::default(),
            counts: Counts::default(),
            wedges,
            proof: None,
            n_proven: u32::from(settings.proves),
            accumulated: Accumulated::new(n_points),
            deviations: Deviations::new(complex.n_slots()),
            vanished: Vanished::default(),
            queue: Queue::new(n_points),
            stuck: Queue::new(n_points),
            choices: Choices::new(n_points),
            splits: settings.options.pre_split,
            settings,
            n_changes: vec![0; n_points],
            keeps_crack: vec![false; n_points],
            view: View::default(),
            neighbor: View::default(),
            turns: Vec::new(),
            scratches: vec![Scratch::default()],
            n_rounds: 0,
            changed_in: vec![0; n_points],
            pieces: Pieces::default(),
            pairs: Vec::new(),
            complex,
        }
    }

    /// Decimates until the reduction asked for is reached, or the error would be too large, or `go_on` says stop; false in
    /// that last case.
    pub fn run(&mut self, go_on: &dyn Fn(&Self) -> bool) -> bool {
        let n_target = self.n_target();
        if self.settings.options.pre_split {
            self.pre_split();
        }
        if self.settings.proves {
            self.proof = Some(Proof::new(&self.complex, self.settings.rounding));
        }
        self.evaluate_all();
        let mut n_unwatched = WATCH_INTERVAL;
        while self.complex.n_triangles() > n_target {
            if n_unwatched >= WATCH_INTERVAL {
                n_unwatched = 0;
                if !go_on(self) {
                    return false;
                }
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
        true
    }

    /// The history, and all else that is left.
    pub fn finish(self) -> (History, ProgressiveReport) {
        let Self {
            complex, journal: Journal { recorder, trace, .. }, wedges, events, n_proven, counts, ..
        } = self;
        let vertices = |slot: u32, corners| wedges.as_ref().map_or(corners, |wedges| wedges.corners(slot));
        let alive: Vec<_> = complex.iter().map(|(slot, corners)| (slot, vertices(slot, corners))).collect();
        let history = recorder.finish(&alive);
        (history, ProgressiveReport { trace, events, counts, n_certified_steps: n_proven })
    }

    /// What to do next: the vertex with the least error is collapsed. Splits wait until there is no collapse left; from then on,
    /// or with a pre-split mesh from the start, they have their turn in the same order.
    fn next(&mut self) -> Next {
        let may_split = match (self.queue.least(), self.stuck.least()) {
            (None, _) => true,
            (Some(collapse), Some(split)) => self.splits && split < collapse,
            (Some(_), None) => false,
        };
        self.splits |= may_split;
        if may_split {
            self.stuck.pop().map_or(Next::Nothing, |(v, _)| Next::Split(v))
        } else {
            Next::Collapses(if self.splits { 1 } else { n_at_once(self.queue.len()) })
        }
    }

    /// Triangles at which to stop.
    fn n_target(&self) -> usize {
        let kept = 1.0 - self.settings.options.reduction.unwrap_or(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a count")]
        let n_target = (self.complex.n_triangles() as f64 * kept).floor() as usize;
        n_target
    }

    /// Classifies and queues all vertices, on the current rayon pool.
    fn evaluate_all(&mut self) {
        let Self { complex, wedges, settings, .. } = self;
        let n_points = u32::try_from(complex.n_points()).unwrap_or(u32::MAX);
        let look = |view: &mut View, v: u32| {
            view.gather(complex, wedges.as_ref(), v, settings.cos_feature_angle);
            view.place()
        };
        let places: Vec<Place> =
            (0..n_points).into_par_iter().with_min_len(1024).map_init(View::default, look).collect();
        for (v, place) in (0..).zip(places) {
            self.put(v, place);
        }
    }

    /// Classifies `v` and queues it with its error; takes it out where nothing is left of it. O(valence).
    pub(super) fn evaluate(&mut self, v: u32) {
        let Self { complex, wedges, neighbor, settings, .. } = self;
        neighbor.gather(complex, wedges.as_ref(), v, settings.cos_feature_angle);
        let place = neighbor.place();
        self.put(v, place);
    }

    fn put(&mut self, v: u32, place: Place) {
        self.changed_in[v as usize] = self.n_rounds;
        let accumulated = self.accumulated.at(v);
        match place {
            Place::Nowhere => {
                self.queue.delete(v);
                self.stuck.delete(v);
            }
            Place::Queued(error) => {
                self.stuck.delete(v);
                self.queue.set(v, error + accumulated);
                self.choices.measure(v);
            }
            Place::Stuck(error) => {
                self.queue.delete(v);
                self.stuck.set(v, error + accumulated);
            }
        }
    }

    /// The star of `v` has changed. While many are queued a vertex among them is looked at when its turn comes: its error will rarely
    /// have become less. Others are looked at at once, as one that waits for a split may be free now.
    pub(super) fn note_change(&mut self, v: u32) {
        self.changed_in[v as usize] = self.n_rounds;
        self.choices.forget(v);
        if self.queue.contains(v) && self.queue.len() >= MANY {
            return;
        }
        self.evaluate_changed(v);
    }

    /// Looks at `v`, whose star has changed; where that is large and waits for its turn, only when an eighth of it may have changed.
    pub(super) fn evaluate_changed(&mut self, v: u32) {
        self.choices.forget(v);
        let n_changes = &mut self.n_changes[v as usize];
        let valence = self.complex.star(v).len();
        *n_changes += 1;
        let waits = self.queue.contains(v) || self.stuck.contains(v);
        if valence <= LARGE_VALENCE || *n_changes as usize * 8 >= valence || !waits {
            *n_changes = 0;
            self.evaluate(v);
        }
    }

    /// Makes room for a point that copies `v`.
    pub(super) fn add_point(&mut self, v: u32) -> u32 {
        self.accumulated.add_copy(v);
        self.queue.add_vertex();
        self.stuck.add_vertex();
        self.choices.add_vertex();
        self.changed_in.push(self.n_rounds);
        self.n_changes.push(0);
        self.keeps_crack.push(self.keeps_crack[v as usize]);
        self.complex.add_copy(v)
    }

    /// Gathers what lies around `v` into [`Self::view`].
    pub(super) fn look_at(&mut self, v: u32) {
        let Self { complex, wedges, view, settings, .. } = self;
        view.gather(complex, wedges.as_ref(), v, settings.cos_feature_angle);
    }

    /// Takes `n` vertices from the queue and does with each what is found to be right, until `n_target` triangles are left.
    fn take_turns(&mut self, n: usize, n_target: usize) {
        self.n_rounds += 1;
        let mut turns = std::mem::take(&mut self.turns);
        turns.resize_with(n.max(turns.len()), Turn::default);
        let mut n_taken = 0;
        while let Some((vertex, queued)) = if n_taken < n { self.queue.pop() } else { None } {
            (turns[n_taken].vertex, turns[n_taken].queued) = (vertex, queued);
            n_taken += 1;
        }
        let mut scratches = std::mem::take(&mut self.scratches);
        let Self { complex, wedges, accumulated, choices, settings, .. } = &*self;
        let judge = Judge { complex, wedges: wedges.as_ref(), accumulated, choices, settings };
        judge_all(judge, &mut turns[..n_taken], &mut scratches);
        self.scratches = scratches;
        for turn in &mut turns[..n_taken] {
            if self.complex.n_triangles() <= n_target {
                break;
            }
            self.take_turn(turn);
        }
        self.turns = turns;
    }

    /// Does what was found right for a vertex, unless something has come between. Where its error is larger than the one that it
    /// was queued with, it goes back to where it belongs.
    fn take_turn(&mut self, turn: &mut Turn) {
        let v = turn.vertex;
        if self.changed_in[v as usize] == self.n_rounds {
            // Its star has changed since it was taken. It was looked at anew, unless that was put off.
            if !self.queue.contains(v) && !self.stuck.contains(v) {
                self.evaluate(v);
            }
            return;
        }
        let accumulated = self.accumulated.at(v);
        match turn.verdict {
            Verdict::Gone => {}
            Verdict::Later(error) => {
                self.choices.measure(v);
                self.queue.set(v, error + accumulated);
            }
            Verdict::ChosenLater(Collapse { into, distance, .. }) => {
                self.choices.choose(v, turn.view.ring.vertices[into], distance);
                self.queue.set(v, distance + accumulated);
            }
            Verdict::Aside | Verdict::Crack | Verdict::Collapse(_) => {
                std::mem::swap(&mut self.view, &mut turn.view);
                self.carry_out(v, turn.verdict, turn.queued);
            }
        }
    }

    fn carry_out(&mut self, v: u32, verdict: Verdict, queued: f64) {
        match verdict {
            Verdict::Crack => self.close_crack_and_collapse(v),
            Verdict::Collapse(collapse) => {
                let has_changed = |r: &u32| self.changed_in[*r as usize] == self.n_rounds;
                let collapse = if self.view.ring.vertices.iter().any(has_changed) {
                    // The triangles beyond its star decide what its collapse does to the topology.
                    let choice = (self.view.ring.vertices[collapse.into], collapse.distance);
                    let marks = &mut self.scratches[0].marks;
                    still_valid(&self.complex, &self.view.ring, choice, marks)
                } else {
                    Some(collapse)
                };
                match collapse {
                    Some(collapse) => self.collapse_or_wait(v, collapse, queued),
                    None => {
                        self.choices.forget(v);
                        self.queue.set(v, queued);
                    }
                }
            }
            _ => self.set_aside(v),
        }
    }

    /// Collapses the vertex at hand. The last triangle of a part waits until it is the turn of its distance from the rest.
    fn collapse_or_wait(&mut self, v: u32, collapse: Collapse, queued: f64) {
        match self.distance_of_last() {
            Some(distance) if distance > queued * REQUEUED_FROM + f64::from(f32::MIN_POSITIVE) => {
                let into = self.view.ring.vertices[collapse.into];
                self.choices.choose(v, into, (distance - self.accumulated.at(v)).max(0.0));
                self.queue.set(v, distance);
            }
            _ => {
                self.collapse(collapse);
            }
        }
    }

    /// Closes the crack that ends at `v`, so that it cannot travel, and collapses what is then a simple vertex.
    fn close_crack_and_collapse(&mut self, v: u32) {
        if !self.keeps_crack[v as usize] && self.close_crack() {
            self.look_at(v);
            if self.view.ring.is_cycle() {
                self.view.class = Class::Simple;
            }
            if let Some(collapse) = self.best_collapse() {
                self.keeps_crack[v as usize] = !self.collapse(collapse);
                return;
            }
        }
        self.keeps_crack[v as usize] = true;
        self.set_aside(v);
    }

    fn best_collapse(&mut self) -> Option<Collapse> {
        let Self { complex, wedges, accumulated, choices, settings, view, scratches, .. } = self;
        let judge = Judge { complex, wedges: wedges.as_ref(), accumulated, choices, settings };
        judge.best_collapse(view, scratches.first_mut()?)
    }

    /// Leaves the vertex at hand for the time when there is nothing but splits.
    fn set_aside(&mut self, v: u32) {
        self.stuck.set(v, self.error_in_view(v) + self.view.size());
    }

    /// Error of the vertex at hand.
    pub(super) fn error_in_view(&self, v: u32) -> f64 {
        self.view.error() + self.accumulated.at(v)
    }
}
