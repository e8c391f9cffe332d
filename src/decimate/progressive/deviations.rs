//! A bound on how far the mesh and the input are apart, triangle by triangle.
//!
//! Every triangle carries a bound: no point of it is farther from the input, and no point of the
//! input that it stands for is farther from it. A collapse puts a fan in the place of a star. If no
//! point of either is farther than `d` from the other, then the bound of the star's worst triangle
//! and `d` together hold for all triangles of the fan. The proof of [`proof`](super::proof) states
//! less as long as it lasts; this goes on through changes of topology.

use super::ring::Ring;
use crate::bound::accumulated::round_up;

/// The bound of the triangle in each slot.
#[derive(Clone, Debug)]
pub(crate) struct Deviations {
    of_slot: Vec<f32>,
}

impl Deviations {
    /// Of the input from itself.
    pub(crate) fn new(n_slots: usize) -> Self {
        Self { of_slot: vec![0.0; n_slots] }
    }

    /// The largest bound among the triangles of a star.
    pub(crate) fn of_star(&self, ring: &Ring) -> f64 {
        let bounds = ring.slots.iter().map(|&slot| self.of_slot[slot as usize]);
        f64::from(bounds.fold(0.0, f32::max))
    }

    /// The triangles of a star have changed.
    pub(crate) fn set_star(&mut self, ring: &Ring, bound: f64) {
        let bound = round_up(bound);
        ring.slots.iter().for_each(|&slot| self.of_slot[slot as usize] = bound);
    }

    /// The triangle in `slot` now also stands for points at this distance from it.
    pub(crate) fn raise(&mut self, slot: u32, bound: f64) {
        let of_slot = &mut self.of_slot[slot as usize];
        *of_slot = of_slot.max(round_up(bound));
    }
}
