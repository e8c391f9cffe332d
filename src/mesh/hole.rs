//! The hole that removing a vertex would leave: its star, in order around it.
//!
//! ```text
//!      r1 ---- r0           ring    r0 r1 r2 r3 ..., counter-clockwise seen from outside
//!     /  \ s0 /  \          slots   s_i holds the triangle (removed, r_i, r_i+1)
//!   r2 s1 \  / s_n-1        closed  an inner vertex: s_n-1 joins the last ring vertex to the first
//!     \    v     \                  a boundary vertex: the ring is a chain, the edge last-first will be new
//! ```

use super::{Surface, facing_edge};
use crate::geometry::vector::{Vector, add, cross, sub};

/// Most triangles of a star that may be removed; larger ones wait until neighbours have gone. A
/// `u8` ring index holds as many.
pub(crate) const MAX_VALENCE: usize = 64;

/// A vertex and its star, ordered. Reused from vertex to vertex, so that nothing is allocated per
/// candidate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hole {
    /// The vertex to be removed.
    pub removed: u32,
    /// Its position.
    pub apex: Vector,
    /// Whether the star surrounds the vertex.
    pub closed: bool,
    /// Link vertices in order.
    pub ring: Vec<u32>,
    /// Their positions.
    pub points: Vec<Vector>,
    /// Slots of the star's triangles in order: one per ring vertex when closed, one fewer
    /// otherwise.
    pub slots: Vec<u32>,
    pub(crate) spokes: Vec<Spoke>,
}

/// A triangle of the star, seen from the removed vertex: `(removed, from, to)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spoke {
    from: u32,
    to: u32,
    slot: u32,
}

/// Why a vertex has no hole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoHole {
    /// The star is not a disk or half disk of consistently oriented triangles, or is empty.
    Complex,
    /// More than [`MAX_VALENCE`] triangles.
    TooLarge,
}

impl Hole {
    /// Orders the star of `v`. O(valence^2), valence at most [`MAX_VALENCE`].
    pub(crate) fn gather(&mut self, surface: &Surface, v: u32) -> Result<(), NoHole> {
        let star = surface.star(v);
        if star.len() > MAX_VALENCE {
            return Err(NoHole::TooLarge);
        }
        self.removed = v;
        self.apex = surface.point(v);
        self.ring.clear();
        self.points.clear();
        self.slots.clear();
        self.spokes.clear();
        self.spokes.extend(star.iter().map(|&slot| {
            let (from, to) = facing_edge(surface.corners(slot), v);
            Spoke { from, to, slot }
        }));
        self.order()?;
        self.points.extend(self.ring.iter().map(|&r| surface.point(r)));
        Ok(())
    }

    /// Chains the spokes into ring and slots. The start is the lowest ring vertex, or the chain's
    /// first, so that the order does not depend on how the star happens to be listed.
    fn order(&mut self) -> Result<(), NoHole> {
        let Self { closed, ring, slots, spokes, .. } = self;
        let onward = |at: u32| spokes.iter().find(|spoke| spoke.from == at);
        let is_first = |v: u32| spokes.iter().all(|spoke| spoke.to != v);
        let chain_start = spokes.iter().map(|spoke| spoke.from).find(|&v| is_first(v));
        *closed = chain_start.is_none();
        let lowest = spokes.iter().map(|spoke| spoke.from).min();
        let Some(start) = chain_start.or(lowest) else { return Err(NoHole::Complex) };
        let mut at = start;
        ring.push(start);
        for _ in 0..spokes.len() {
            let Some(spoke) = onward(at) else { return Err(NoHole::Complex) };
            slots.push(spoke.slot);
            at = spoke.to;
            if at == start {
                break;
            }
            ring.push(at);
        }
        // A chain that meets itself goes round there for ever and comes neither back to the start
        // nor to an end. A chain that does has taken every spoke once.
        let is_disk = if *closed {
            at == start && slots.len() == spokes.len() && ring.len() >= 3
        } else {
            onward(at).is_none()
        };
        if is_disk { Ok(()) } else { Err(NoHole::Complex) }
    }

    /// A copy without positions.
    pub(crate) fn without_points(&self) -> Self {
        let Self { removed, apex, closed, ref ring, ref slots, .. } = *self;
        Self {
            removed,
            apex,
            closed,
            ring: ring.clone(),
            points: vec![],
            slots: slots.clone(),
            spokes: vec![],
        }
    }

    /// Vertices of the ring.
    pub(crate) fn n_ring(&self) -> usize {
        self.ring.len()
    }

    /// The ring index after `i`, around the hole.
    pub(crate) fn next(&self, i: usize) -> usize {
        if i + 1 == self.ring.len() { 0 } else { i + 1 }
    }

    /// Slot of the star's triangle that follows ring vertex `i`; the last one at the end of a
    /// chain.
    pub(crate) fn slot_after(&self, i: usize) -> u32 {
        self.slots[i.min(self.slots.len() - 1)]
    }

    /// Slot of the star's triangle that leads up to ring vertex `i`; the first one at the start of
    /// a chain.
    pub(crate) fn slot_before(&self, i: usize) -> u32 {
        self.slots[if i > 0 {
            i - 1
        } else if self.closed {
            self.slots.len() - 1
        } else {
            0
        }]
    }

    /// Corner positions of the star's `i`-th triangle.
    pub(crate) fn triangle(&self, i: usize) -> [Vector; 3] {
        [self.apex, self.points[i], self.points[self.next(i)]]
    }

    /// Normal of the star's `i`-th triangle, as long as twice its area.
    pub(crate) fn normal(&self, i: usize) -> Vector {
        let [a, b, c] = self.triangle(i);
        cross(sub(b, a), sub(c, a))
    }

    /// Area-weighted normal of the star: the normal of the average plane, of any length.
    pub(crate) fn average_normal(&self) -> Vector {
        let mut sum = [0.0; 3];
        for i in 0..self.slots.len() {
            sum = add(sum, self.normal(i));
        }
        sum
    }

    /// Whether the ring vertices `i` and `j` are neighbours on the ring by an edge that exists.
    pub(crate) fn is_ring_edge(&self, i: usize, j: usize) -> bool {
        let (low, high) = (i.min(j), i.max(j));
        high == low + 1 || (self.closed && low == 0 && high + 1 == self.ring.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    /// Whether the triangles `(0, from, to)` make one round of at least three, or one chain: no
    /// vertex has two on one side, one piece holds them all, and it has as many edges as a round or
    /// a chain of its vertices has.
    fn is_disk(spokes: &[[u32; 2]]) -> bool {
        let distinct = |side: usize| spokes.iter().map(|spoke| spoke[side]).collect::<BTreeSet<u32>>().len();
        let mut reached: BTreeSet<u32> = spokes[0].into();
        for _ in spokes {
            let more = spokes.iter().filter(|spoke| spoke.iter().any(|v| reached.contains(v))).flatten();
            reached = more.copied().collect();
        }
        let all: BTreeSet<u32> = spokes.iter().flatten().copied().collect();
        let is_round = all.len() == spokes.len();
        distinct(0) == spokes.len()
            && distinct(1) == spokes.len()
            && reached == all
            && (!is_round || spokes.len() >= 3)
    }

    proptest! {
        #[test]
        fn stars_are_disks_half_disks_or_complex(
            spokes in prop::collection::vec((1_u32..6, 1_u32..5).prop_map(|(a, b)| [a, if b < a { b } else { b + 1 }]), 1..6),
            start in 0_usize..5,
            is_tidy in any::<bool>(),
        ) {
            // Half of them a round or a chain in the first place, in some order.
            let n = u32::try_from(spokes.len()).unwrap();
            let tidy: Vec<[u32; 2]> = (0..n).map(|i| [1 + i, 1 + (i + 1) % (n + u32::from(start < 2))]).collect();
            let mut spokes = if is_tidy && n >= 3 { tidy } else { spokes };
            let at = start % spokes.len();
            spokes.rotate_left(at);
            let triangles = spokes.iter().map(|&[from, to]| [0, from, to]).collect();
            let surface = Surface::new(vec![[0.0; 3]; 8], triangles);
            let mut hole = Hole::default();
            let found = hole.gather(&surface, 0);
            prop_assert_eq!(found.is_ok(), is_disk(&spokes));
            if found.is_ok() {
                let of_slot = |&slot: &u32| spokes[slot as usize];
                prop_assert!(hole.slots.iter().map(of_slot).enumerate().all(|(i, [from, to])| from == hole.ring[i] && to == hole.ring[hole.next(i)]));
                prop_assert_eq!(hole.closed, hole.ring.len() == spokes.len());
                prop_assert_eq!(hole.slots.len(), spokes.len());
            }
        }
    }
}
