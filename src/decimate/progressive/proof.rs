//! The certified bound, for as long as one can be stated.
//!
//! A collapse that changes no topology is the removal of a vertex whose hole is filled by a fan, which is all that
//! [`crate::bound::certified`] asks for. The first change of topology ends the proof: its map is no longer onto, or no longer
//! continuous. Splits made before anything else do not matter: they leave the point set as it is, and the map starts on it.

use super::complex::Complex;
use super::ring::Ring;
use crate::bound::Replacement;
use crate::bound::certified::{Certified, Transfer};
use crate::mesh::{Filling, Hole, Surface};

/// The map from the input onto the current mesh, and that mesh once more in the form that the map refers to.
#[derive(Clone, Debug)]
pub struct Proof {
    surface: Surface,
    certified: Certified,
    hole: Hole,
    filling: Filling,
    transfer: Transfer,
}

impl Proof {
    /// The identity on `complex`, which is the input but for `rounding`.
    pub fn new(complex: &Complex, rounding: f64) -> Self {
        let triangles = complex.iter().map(|(_, corners)| corners).collect();
        let surface = Surface::new(complex.positions().to_vec(), triangles);
        Self {
            certified: Certified::new(&surface, rounding),
            surface,
            hole: Hole::default(),
            filling: Filling::default(),
            transfer: Transfer::default(),
        }
    }

    /// A bound on the error once the ring's centre has gone into neighbour `into`, or some value above `limit`. Nothing where the
    /// star is none that the proof can follow. O(input mapped into the star).
    pub fn bound(&mut self, ring: &Ring, into: usize, limit: f64) -> Option<f64> {
        let Self { surface, certified, hole, filling, transfer } = self;
        hole.gather(surface, ring.center).ok()?;
        let target = hole.ring.iter().position(|&r| r == ring.vertices[into])?;
        fill_with_fan(hole, target, filling);
        if filling.triangles.len() + 2 != hole.n_ring() || filling.triangles.is_empty() {
            return None;
        }
        Some(certified.bound(Replacement { surface, hole, filling }, limit, transfer))
    }

    /// Carries the map over to the fan that [`Self::bound`] was asked about last; false where there is no room for it, and the
    /// proof ends.
    pub fn carry_out(&mut self) -> bool {
        let Self { surface, certified, hole, filling, transfer } = self;
        let found = certified.change(Replacement { surface, hole, filling }, f64::INFINITY, transfer);
        let Ok((_, change)) = found else { return false };
        let changes = std::iter::once((&*hole, &change));
        if certified.check_room(changes.clone()).is_err() {
            return false;
        }
        certified.apply_all(changes);
        certified.compact();
        surface.fill(hole, filling);
        surface.compact();
        true
    }
}

/// The fan from ring vertex `target`: as the collapse leaves it, over the order that the hole has.
fn fill_with_fan(hole: &Hole, target: usize, filling: &mut Filling) {
    #[expect(clippy::cast_possible_truncation, reason = "holes have at most MAX_VALENCE + 1 ring vertices")]
    let label = |i: usize| i as u8;
    filling.triangles.clear();
    let pairs = (0..hole.slots.len()).map(|i| [i, hole.next(i)]).filter(|pair| !pair.contains(&target));
    filling.triangles.extend(pairs.map(|[i, j]| [label(target), label(i), label(j)]));
    filling.n_first_part = filling.triangles.len();
    filling.part_starts = [label(target); 2];
}
