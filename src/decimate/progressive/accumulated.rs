//! Errors that deletions have left behind (equation 5): they decide whose turn it is.

use super::ring::Ring;
use crate::bound::accumulated::round_up;

/// Errors that deletions have left at each vertex (equation 5).
#[derive(Clone, Debug)]
pub(crate) struct AccumulatedErrors {
    errors: Vec<f32>,
}

impl AccumulatedErrors {
    /// Nothing was deleted yet.
    pub(crate) fn new(n_vertices: usize) -> Self {
        Self { errors: vec![0.0; n_vertices] }
    }

    /// What was left at `v`.
    #[inline]
    pub(crate) fn at(&self, v: u32) -> f64 {
        f64::from(self.errors[v as usize])
    }

    /// The vertex takes what was left at the one that it copies.
    pub(crate) fn add_copy(&mut self, v: u32) {
        self.errors.push(self.errors[v as usize]);
    }

    /// The ring's centre goes: each neighbour is left with the distance and the error that had come
    /// together at the centre or at itself.
    pub(crate) fn distribute(&mut self, ring: &Ring, distance: f64) {
        let own = self.at(ring.center);
        for &r in &ring.vertices {
            self.errors[r as usize] = round_up(own.max(self.at(r)) + distance);
        }
    }

    /// `from` goes into `into`, at the same place.
    pub(crate) fn merge(&mut self, from: u32, into: u32) {
        self.errors[into as usize] = self.errors[into as usize].max(self.errors[from as usize]);
    }
}
