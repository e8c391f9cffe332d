//! The driver (section 4.1): vertices in the order of their errors, collapses while there are any, then splits.

use super::classify::{Class, Geometry, classify};
use super::collapse::{Collapse, Marks, best_valid};
use super::complex::Complex;
use super::error::{Accumulated, local_error};
use super::events::EventLog;
use super::journal::{Counts, Journal};
use super::proof::Proof;
use super::queue::Queue;
use super::ring::Ring;
use super::split::Pieces;
use super::wedges::Wedges;
use super::{Passage, ProgressiveOptions};
use crate::history::{History, Recorder};

/// Stars of more triangles than this are not looked at again after every change of a neighbour, but after every
/// so many that a part of the star may have changed: a fan of a hundred thousand triangles would cost their square.
const LARGE_VALENCE: usize = 64;
/// A vertex is queued again when its error is found to be so much larger than the one it was queued with.
const REQUEUED_FROM: f64 = 1.05;
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
    pub(super) queue: Queue,
    /// Vertices without a valid collapse: to be split once nothing else is left.
    pub(super) stuck: Queue,
    pub(super) settings: Settings,
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
    pub(super) marks: Marks,
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

/// A step to be tried.
enum Next {
    /// A collapse of this vertex, queued with this error.
    Collapse(u32, f64),
    /// A split of this vertex.
    Split(u32),
    /// There is no vertex left.
    Nothing,
}

/// A vertex with its surroundings.
#[derive(Clone, Debug, Default)]
pub(super) struct View {
    pub(super) ring: Ring,
    pub(super) geometry: Geometry,
    pub(super) class: Class,
}

impl View {
    fn gather(&mut self, complex: &Complex, wedges: Option<&Wedges>, v: u32, cos_feature_angle: f64) {
        self.ring.gather(complex, v);
        self.geometry.gather(complex, wedges, &self.ring, cos_feature_angle);
        self.class = classify(complex, &self.ring, &self.geometry);
    }

    /// Effective edge length of the star (equation 4): what is lost at most when pieces of it vanish.
    fn size(&self) -> f64 {
        self.geometry.area.sqrt()
    }
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
            queue: Queue::new(n_points),
            stuck: Queue::new(n_points),
            splits: settings.options.pre_split,
            settings,
            n_changes: vec![0; n_points],
            keeps_crack: vec![false; n_points],
            view: View::default(),
            neighbor: View::default(),
            marks: Marks::default(),
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
        for v in (0..).take(self.complex.n_points()) {
            self.evaluate(v);
        }
        let mut n_operations = 0_usize;
        while self.complex.n_triangles() > n_target {
            if n_operations.is_multiple_of(WATCH_INTERVAL) && !go_on(self) {
                return false;
            }
            n_operations += 1;
            match self.next() {
                Next::Collapse(v, queued) => self.try_collapse(v, queued),
                Next::Split(v) => self.split(v),
                Next::Nothing => break,
            }
        }
        true
    }

    /// The history, and all else that is left.
    pub fn finish(self) -> (History, Passage) {
        let Self {
            complex, journal: Journal { recorder, trace, .. }, wedges, events, n_proven, counts, ..
        } = self;
        let vertices = |slot: u32, corners| wedges.as_ref().map_or(corners, |wedges| wedges.corners(slot));
        let history = recorder.finish(complex.iter().map(|(slot, corners)| (slot, vertices(slot, corners))));
        (history, Passage { trace, events, counts, n_certified_steps: n_proven })
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
        let (from, to_split) = if may_split { (&mut self.stuck, true) } else { (&mut self.queue, false) };
        match from.pop() {
            Some((v, _)) if to_split => Next::Split(v),
            Some((v, queued)) => Next::Collapse(v, queued),
            None => Next::Nothing,
        }
    }

    /// Triangles at which to stop.
    fn n_target(&self) -> usize {
        let kept = 1.0 - self.settings.options.reduction.unwrap_or(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a count")]
        let n_target = (self.complex.n_triangles() as f64 * kept).floor() as usize;
        n_target
    }

    /// Classifies `v` and queues it with its error; takes it out where nothing is left of it. O(valence).
    pub(super) fn evaluate(&mut self, v: u32) {
        let Self { complex, wedges, neighbor, settings, .. } = self;
        neighbor.gather(complex, wedges.as_ref(), v, settings.cos_feature_angle);
        let class = neighbor.class;
        let error = local_error(class, &neighbor.ring, &neighbor.geometry) + self.accumulated.at(v);
        match class {
            Class::Empty => {
                self.queue.delete(v);
                self.stuck.delete(v);
            }
            _ if class.may_collapse() => {
                self.stuck.delete(v);
                self.queue.set(v, error);
            }
            _ => {
                self.queue.delete(v);
                self.stuck.set(v, error + self.neighbor.size());
            }
        }
    }

    /// Looks at a vertex whose star has changed. A large star is put off until an eighth of it may have.
    pub(super) fn evaluate_changed(&mut self, v: u32) {
        let n_changes = &mut self.n_changes[v as usize];
        let valence = self.complex.star(v).len();
        *n_changes += 1;
        if valence <= LARGE_VALENCE || *n_changes as usize * 8 >= valence {
            *n_changes = 0;
            self.evaluate(v);
        }
    }

    /// Makes room for a point that copies `v`.
    pub(super) fn add_point(&mut self, v: u32) -> u32 {
        self.accumulated.add_copy(v);
        self.queue.add_vertex();
        self.stuck.add_vertex();
        self.n_changes.push(0);
        self.keeps_crack.push(self.keeps_crack[v as usize]);
        self.complex.add_copy(v)
    }

    /// Gathers what lies around `v` into [`Self::view`].
    pub(super) fn look_at(&mut self, v: u32) {
        let Self { complex, wedges, view, settings, .. } = self;
        view.gather(complex, wedges.as_ref(), v, settings.cos_feature_angle);
    }

    /// Collapses `v` if it has a valid edge within the limits; sets it aside otherwise. Where the actual error is larger than
    /// the measure that it was queued with, it goes back to where it belongs.
    fn try_collapse(&mut self, v: u32, queued: f64) {
        self.look_at(v);
        match self.best_valid() {
            Some(_) if self.view.class == Class::CrackTip => self.close_crack_and_collapse(v),
            Some(collapse) => {
                let error = collapse.distance + self.accumulated.at(v);
                if error > queued * REQUEUED_FROM + f64::from(f32::MIN_POSITIVE) {
                    self.queue.set(v, error);
                } else {
                    self.collapse(collapse);
                }
            }
            None => self.set_aside(v),
        }
    }

    /// Closes the crack that ends at `v`, so that it cannot travel, and collapses what is then a simple vertex.
    fn close_crack_and_collapse(&mut self, v: u32) {
        if !self.keeps_crack[v as usize] && self.close_crack() {
            self.look_at(v);
            if self.view.ring.is_cycle() {
                self.view.class = Class::Simple;
            }
            if let Some(collapse) = self.best_valid() {
                self.collapse(collapse);
                return;
            }
        }
        self.keeps_crack[v as usize] = true;
        self.set_aside(v);
    }

    fn best_valid(&mut self) -> Option<Collapse> {
        let Self { complex, view: View { ring, geometry, class }, marks, .. } = self;
        best_valid(complex, ring, geometry, *class, marks)
    }

    /// Leaves the vertex at hand for the time when there is nothing but splits.
    fn set_aside(&mut self, v: u32) {
        self.stuck.set(v, self.error_in_view(v) + self.view.size());
    }

    /// Error of the vertex at hand.
    pub(super) fn error_in_view(&self, v: u32) -> f64 {
        let View { ring, geometry, class } = &self.view;
        local_error(*class, ring, geometry) + self.accumulated.at(v)
    }
}
