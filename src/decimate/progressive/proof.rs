//! The certified bound, for as long as one can be stated.
//!
//! A collapse that changes no topology is the removal of a vertex whose hole is filled by a fan,
//! which is all that [`crate::bound::certified`] asks for. The first change of topology ends the
//! proof: its map is no longer onto, or no longer continuous. Splits made before anything else do
//! not matter: they leave the point set as it is, and the map starts on it.

use super::ring::Ring;
use crate::bound::Replacement;
use crate::bound::certified::{Certified, MapChange, Transfer};
use crate::mesh::{Filling, Hole, Surface};

/// The map from the input onto the current mesh, and that mesh once more in the form that the map
/// refers to.
#[derive(Clone, Debug)]
pub(crate) struct Proof {
    surface: Surface,
    certified: Certified,
    hole: Hole,
    filling: Filling,
    transfer: Transfer,
}

impl Proof {
    /// The identity on `mesh`, which is the input but for `rounding`.
    pub(crate) fn new(mesh: &Surface, rounding: f64) -> Self {
        let triangles = mesh.iter().map(|(_, corners)| corners).collect();
        let surface = Surface::new(mesh.positions().to_vec(), triangles);
        Self {
            certified: Certified::new(&surface, rounding),
            surface,
            hole: Hole::default(),
            filling: Filling::default(),
            transfer: Transfer::default(),
        }
    }

    /// Plans the collapse of the ring's centre into neighbour `into`, which carries the map over to
    /// the fan that is left. The plan fails if no bound of at most `limit` follows. `None` if the
    /// star is not one that the proof can follow. O(input mapped into the star).
    pub(crate) fn plan(
        &mut self,
        ring: &Ring,
        into: usize,
        limit: f64,
    ) -> Option<Result<Plan<'_>, AboveLimit>> {
        let Self { surface, certified, hole, filling, transfer } = self;
        hole.gather(surface, ring.center).ok()?;
        let target = hole.ring.iter().position(|&r| r == ring.vertices[into])?;
        fill_with_fan(hole, target, filling);
        if filling.triangles.len() + 2 != hole.n_ring()
            || filling.triangles.is_empty()
            || is_lid(surface, hole)
        {
            return None;
        }
        Some(match certified.change(Replacement { surface, hole, filling }, limit, transfer) {
            Ok((error, change)) => Ok(Plan { proof: self, error, change }),
            Err(_) => Err(AboveLimit),
        })
    }
}

/// No bound within the limit was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct AboveLimit;

/// A collapse whose bound is known. Holds the change of the map that the bound was found for, so
/// that no other one can be carried out under this bound.
#[derive(Debug)]
pub(crate) struct Plan<'a> {
    proof: &'a mut Proof,
    error: f64,
    change: MapChange,
}

impl Plan<'_> {
    /// A bound on the error of the mesh inside the ring after the collapse.
    pub(crate) fn error(&self) -> f64 {
        self.error
    }

    /// Applies the change to the map and to the mesh of the proof. False if there is no room for
    /// it; then the proof ends here.
    pub(crate) fn carry_out(self) -> bool {
        let Self { proof: Proof { surface, certified, hole, filling, .. }, change, .. } = self;
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

/// Whether the fan is one triangle with the corners of another, in either orientation: the two
/// would share all edges, and a chain from one to the other would not tell which it crosses.
fn is_lid(surface: &Surface, hole: &Hole) -> bool {
    hole.closed && hole.n_ring() == 3 && surface.has_triangle([hole.ring[0], hole.ring[1], hole.ring[2]])
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
