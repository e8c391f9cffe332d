//! Writes the history down while a decimator runs.

use super::{History, NEVER};

/// Turns the comings and goings of simplices in slots into lifetimes.
#[derive(Clone, Debug)]
pub struct Recorder<const CORNERS: usize = 3> {
    history: History<CORNERS>,
    birth_in_slot: Vec<u32>,
}

impl<const CORNERS: usize> Recorder<CORNERS> {
    /// A recorder for an input of `n_slots` simplices over `n_vertices` vertices, at step 0 with the given error.
    pub fn new(n_slots: usize, n_vertices: usize, error: f64) -> Self {
        let history =
            History { vertex_death: vec![0; n_vertices], errors: vec![error], ..History::default() };
        Self { history, birth_in_slot: vec![0; n_slots] }
    }

    /// Makes room for so many simplices in all, so that none is moved while they come.
    pub fn reserve(&mut self, n_simplices: usize) {
        let History { simplices, birth, death, .. } = &mut self.history;
        simplices.reserve(n_simplices);
        birth.reserve(n_simplices);
        death.reserve(n_simplices);
    }

    /// Starts the next step. Its error is `error`, or that of the step before if that is larger.
    pub fn step(&mut self, error: f64) {
        let last = self.history.errors.last().copied().unwrap_or_default();
        self.history.errors.push(error.max(last));
    }

    /// Steps so far, the number of the current one.
    pub fn n_steps(&self) -> u32 {
        self.now()
    }

    /// Error of the current step.
    pub fn error(&self) -> f64 {
        self.history.errors.last().copied().unwrap_or_default()
    }

    /// The simplex in `slot` dies at this step.
    pub fn death(&mut self, slot: u32, simplex: [u32; CORNERS]) {
        let now = self.now();
        self.record(slot, simplex, now);
    }

    /// A simplex is born into `slot` at this step.
    pub fn birth(&mut self, slot: u32) {
        self.birth_in_slot[slot as usize] = self.now();
    }

    /// A vertex is born at this step; gives its index, the next after those there are. It dies like any other.
    pub fn vertex(&mut self) -> u32 {
        let now = self.now();
        let History { vertex_birth, vertex_death, .. } = &mut self.history;
        vertex_birth.resize(vertex_death.len(), 0);
        vertex_birth.push(now);
        vertex_death.push(0);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "`History::check` refuses more vertices than u32 counts"
        )]
        let vertex = (vertex_death.len() - 1) as u32;
        vertex
    }

    /// The whole history, given what is alive now. A vertex dies with the last simplex that uses it.
    pub fn finish(mut self, alive: impl Iterator<Item = (u32, [u32; CORNERS])>) -> History<CORNERS> {
        alive.for_each(|(slot, simplex)| self.record(slot, simplex, NEVER));
        let History { simplices, death, vertex_death, .. } = &mut self.history;
        for (simplex, &death) in simplices.iter().zip(death.iter()) {
            for &v in simplex {
                let last = &mut vertex_death[v as usize];
                *last = death.max(*last);
            }
        }
        self.history
    }

    fn record(&mut self, slot: u32, simplex: [u32; CORNERS], death: u32) {
        self.history.simplices.push(simplex);
        self.history.birth.push(self.birth_in_slot[slot as usize]);
        self.history.death.push(death);
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "fewer steps than vertices, and vertices are counted in u32"
    )]
    fn now(&self) -> u32 {
        (self.history.errors.len() - 1) as u32
    }
}
