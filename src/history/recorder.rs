//! Records the history while a decimator runs.

use super::deaths::{Deaths, Record};
use super::{History, NEVER};
use crate::mesh::Renumbering;

/// Larger than the distance between any two points with `f32` coordinates.
const FARTHEST: f64 = 4.0 * f32::MAX as f64;

/// Turns births and deaths of simplices in slots into lifetimes.
///
/// Memory: 4 bytes per slot, some 7 per dead triangle, and 16 each time the error rises.
#[derive(Clone, Debug)]
pub(crate) struct Recorder<const CORNERS: usize = 3> {
    deaths: Deaths<CORNERS>,
    birth_in_slot: Vec<u32>,
    /// Steps at which the error rises, and the error from there on; step 0 first.
    rises: Vec<(u32, f64)>,
    now: u32,
    n_vertices_in: usize,
    /// Births of the vertices that are not vertices of the input.
    vertex_births: Vec<u32>,
}

impl<const CORNERS: usize> Recorder<CORNERS> {
    /// A recorder for an input of `n_slots` simplices over `n_vertices` vertices, at step 0 with
    /// the given error.
    pub(crate) fn new(n_slots: usize, n_vertices: usize, error: f64) -> Self {
        Self {
            deaths: Deaths::new(),
            birth_in_slot: vec![0; n_slots],
            rises: vec![(0, error)],
            now: 0,
            n_vertices_in: n_vertices,
            vertex_births: vec![],
        }
    }

    /// Starts the next step. Its error is `error`, or that of the last step if that is larger. NaN
    /// and finite values beyond the largest possible distance are clamped to it; an infinite error
    /// says that there is no bound.
    pub(crate) fn step(&mut self, error: f64) {
        self.now += 1;
        let error = if error == f64::INFINITY { error } else { error.min(FARTHEST) };
        if error > self.error() {
            self.rises.push((self.now, error));
        }
    }

    /// Number of steps so far, which is the number of the current step.
    pub(crate) fn n_steps(&self) -> u32 {
        self.now
    }

    /// Error of the current step.
    pub(crate) fn error(&self) -> f64 {
        self.rises.last().map_or(0.0, |&(_, error)| error)
    }

    /// The simplex in `slot` dies at this step.
    pub(crate) fn death(&mut self, slot: u32, simplex: [u32; CORNERS]) {
        self.deaths.push(Record { simplex, birth: self.birth_in_slot[slot as usize], death: self.now });
    }

    /// A simplex is born into `slot` at this step.
    pub(crate) fn birth(&mut self, slot: u32) {
        self.birth_in_slot[slot as usize] = self.now;
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        slots.close_up(&mut self.birth_in_slot);
    }

    /// Gives birth to a vertex at this step and returns its index, the next free one. It dies like
    /// any other vertex.
    pub(crate) fn vertex(&mut self) -> u32 {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "`History::check` refuses more vertices than u32 counts"
        )]
        let vertex = (self.n_vertices_in + self.vertex_births.len()) as u32;
        self.vertex_births.push(self.now);
        vertex
    }

    /// The whole history, given the simplices that are alive now and their slots. A vertex dies
    /// with the last simplex that uses it.
    pub(crate) fn finish(self, alive: &[(u32, [u32; CORNERS])]) -> History<CORNERS> {
        let Self { deaths, birth_in_slot, rises, now, n_vertices_in, vertex_births } = self;
        let n_simplices = deaths.len() + alive.len();
        let mut history = History {
            simplices: Vec::with_capacity(n_simplices),
            birth: Vec::with_capacity(n_simplices),
            death: Vec::with_capacity(n_simplices),
            vertex_death: vec![0; n_vertices_in + vertex_births.len()],
            errors: errors(&rises, now),
            ..History::default()
        };
        if !vertex_births.is_empty() {
            history.vertex_birth = vec![0; n_vertices_in];
            history.vertex_birth.extend(vertex_births);
        }
        let mut add = |Record { simplex, birth, death }| {
            history.simplices.push(simplex);
            history.birth.push(birth);
            history.death.push(death);
            for v in simplex {
                let last = &mut history.vertex_death[v as usize];
                *last = death.max(*last);
            }
        };
        deaths.drain(&mut add);
        for &(slot, simplex) in alive {
            add(Record { simplex, birth: birth_in_slot[slot as usize], death: NEVER });
        }
        history
    }
}

/// The error of each step up to `now`.
fn errors(rises: &[(u32, f64)], now: u32) -> Vec<f64> {
    let mut errors = Vec::with_capacity(now as usize + 1);
    let ends = rises.iter().skip(1).map(|&(step, _)| step).chain([now + 1]);
    for (&(_, error), end) in rises.iter().zip(ends) {
        errors.resize(end as usize, error);
    }
    errors
}
