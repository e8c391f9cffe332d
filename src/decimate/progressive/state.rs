//! The mesh in the middle of its decimation, with all that is kept beside it.

use super::ProgressiveReport;
use super::accumulated::AccumulatedErrors;
use super::deviations::Deviations;
use super::events::EventLog;
use super::journal::{Counts, Journal};
use super::options::Settings;
use super::proof::Proof;
use super::schedule::Schedule;
use super::split::StarPieces;
use super::vanished::Vanished;
use super::view::{QueuePlace, Surroundings};
use crate::history::{History, Recorder};
use crate::mesh::{Surface, Wedges};
use rayon::prelude::*;

/// Stars of more triangles than this are not evaluated again after every change of a neighbour, but
/// once an eighth of the star may have changed: a fan of 100,000 triangles would cost their square.
const LARGE_VALENCE: usize = 64;
/// While fewer vertices are queued, all are looked at as soon as their stars change: the last ones,
/// whose errors are largest, are queued with the errors that they have.
const MIN_LAZY_QUEUE: usize = 2048;

/// What a decimation works on, and what it has done so far.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// The current mesh; its vertices are points.
    pub(super) surface: Surface,
    /// History and operations so far.
    pub(super) journal: Journal,
    /// Changes of topology so far.
    pub(super) events: EventLog,
    /// How many operations of each kind there were.
    pub(super) counts: Counts,
    pub(super) wedges: Option<Wedges>,
    pub(super) proof: Option<Proof>,
    /// Steps whose error is proven, step 0 included.
    pub(super) n_proven: u32,
    pub(super) accumulated: AccumulatedErrors,
    pub(super) deviations: Deviations,
    pub(super) vanished: Vanished,
    pub(super) settings: Settings,
    /// The vertex at hand.
    pub(super) view: Surroundings,
    /// A neighbour of it.
    pub(super) neighbor: Surroundings,
    pub(super) pieces: StarPieces,
    /// Wedges at the vertex and where they go.
    pub(super) pairs: Vec<[u32; 2]>,
    /// When each vertex has its turn.
    pub(super) schedule: Schedule,
}

impl State {
    /// The state at step 0 of `surface`, with the wedges at its corners if it has seams, over
    /// `n_wedges` vertices.
    pub(super) fn new(surface: Surface, wedges: Option<Wedges>, n_wedges: u32, settings: Settings) -> Self {
        let n_points = surface.n_vertices();
        let recorder = Recorder::new(surface.n_slots(), n_wedges as usize, settings.rounding);
        Self {
            journal: Journal::new(recorder, n_wedges),
            events: EventLog::default(),
            counts: Counts::default(),
            wedges,
            proof: None,
            n_proven: u32::from(settings.proves),
            accumulated: AccumulatedErrors::new(n_points),
            deviations: Deviations::new(surface.n_slots()),
            vanished: Vanished::default(),
            schedule: Schedule::new(n_points, settings.options.pre_split),
            settings,
            view: Surroundings::default(),
            neighbor: Surroundings::default(),
            pieces: StarPieces::default(),
            pairs: Vec::new(),
            surface,
        }
    }

    /// The history and the report.
    pub(super) fn finish(self) -> (History, ProgressiveReport) {
        let Self {
            surface, journal: Journal { recorder, trace, .. }, wedges, events, n_proven, counts, ..
        } = self;
        let vertices = |slot: u32, corners| wedges.as_ref().map_or(corners, |wedges| wedges.corners(slot));
        let alive: Vec<_> = surface.iter().map(|(slot, corners)| (slot, vertices(slot, corners))).collect();
        let history = recorder.finish(&alive);
        (history, ProgressiveReport { trace, events, counts, n_certified_steps: n_proven })
    }

    /// Classifies and queues all vertices, on the current rayon pool.
    pub(super) fn evaluate_all(&mut self) {
        let Self { surface, wedges, settings, .. } = self;
        let n_points = u32::try_from(surface.n_vertices()).unwrap_or(u32::MAX);
        let look = |view: &mut Surroundings, v: u32| {
            view.gather(surface, wedges.as_ref(), v, settings.cos_feature_angle);
            view.place()
        };
        let places: Vec<QueuePlace> =
            (0..n_points).into_par_iter().with_min_len(1024).map_init(Surroundings::default, look).collect();
        for (v, place) in (0..).zip(places) {
            self.put(v, place);
        }
    }

    /// Classifies `v` and queues it with its error, or takes it out if it has no triangle.
    /// O(valence).
    pub(super) fn evaluate(&mut self, v: u32) {
        let Self { surface, wedges, neighbor, settings, .. } = self;
        neighbor.gather(surface, wedges.as_ref(), v, settings.cos_feature_angle);
        let place = neighbor.place();
        self.put(v, place);
    }

    fn put(&mut self, v: u32, place: QueuePlace) {
        self.schedule.changed_in[v as usize] = self.schedule.n_rounds;
        let accumulated = self.accumulated.at(v);
        match place {
            QueuePlace::Nowhere => {
                self.schedule.queue.delete(v);
                self.schedule.stuck.delete(v);
            }
            QueuePlace::Queued(error) => {
                self.schedule.stuck.delete(v);
                self.schedule.queue.set(v, error + accumulated);
                self.schedule.choices.measure(v);
            }
            QueuePlace::Stuck(error) => {
                self.schedule.queue.delete(v);
                self.schedule.stuck.set(v, error + accumulated);
            }
        }
    }

    /// The star of `v` has changed. While many vertices are queued, a queued one is evaluated when
    /// its turn comes: its error will rarely have become less. Others are evaluated at once, since
    /// a vertex that waits for a split may have a valid collapse now.
    pub(super) fn note_change(&mut self, v: u32) {
        self.schedule.changed_in[v as usize] = self.schedule.n_rounds;
        self.schedule.choices.forget(v);
        if self.schedule.queue.contains(v) && self.schedule.queue.len() >= MIN_LAZY_QUEUE {
            return;
        }
        self.evaluate_changed(v);
    }

    /// Evaluates `v`, whose star has changed. If the star is large and `v` waits for its turn, only
    /// once an eighth of it may have changed.
    pub(super) fn evaluate_changed(&mut self, v: u32) {
        self.schedule.choices.forget(v);
        let n_changes = &mut self.schedule.n_changes[v as usize];
        let valence = self.surface.star(v).len();
        *n_changes += 1;
        let waits = self.schedule.queue.contains(v) || self.schedule.stuck.contains(v);
        if valence <= LARGE_VALENCE || *n_changes as usize * 8 >= valence || !waits {
            *n_changes = 0;
            self.evaluate(v);
        }
    }

    /// Makes room for a point that copies `v`.
    pub(super) fn add_point(&mut self, v: u32) -> u32 {
        self.accumulated.add_copy(v);
        self.schedule.add_vertex(v);
        self.surface.add_copy(v)
    }

    /// Gathers the surroundings of `v` into [`Self::view`].
    pub(super) fn look_at(&mut self, v: u32) {
        let Self { surface, wedges, view, settings, .. } = self;
        view.gather(surface, wedges.as_ref(), v, settings.cos_feature_angle);
    }

    /// Error of the vertex at hand.
    pub(super) fn error_in_view(&self, v: u32) -> f64 {
        self.view.error() + self.accumulated.at(v)
    }
}
