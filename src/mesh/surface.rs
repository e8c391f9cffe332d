//! The mesh while it is being simplified.

use super::{Locked, Renumbering, Stars};
use crate::flat::NO_INDEX;
use crate::geometry::vector::{Vector, widen};

/// Corners of a slot whose triangle is gone.
pub(super) const GONE: [u32; 3] = [NO_INDEX; 3];

/// So few slots do not close up, nor does an eighth of those of the input: there is no more to be
/// gained.
const MIN_SLOTS: usize = 4096;

/// Triangles in slots, with the star of every vertex.
///
/// Edges may have any number of triangles. A slot holds one triangle at a time. A retriangulated
/// hole has fewer triangles than the star it came from, so new triangles always find room in the
/// slots of the old ones, and arrays that run parallel to the slots never grow; they become shorter
/// when slots [close up](Self::close_up).
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub(super) positions: Vec<[f32; 3]>,
    /// Where the vertices were at the start; empty while none has moved.
    origins: Vec<[f32; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) stars: Stars,
    pub(super) n_triangles: usize,
    locked: Locked,
}

impl Surface {
    /// A surface over `positions` in which slot `t` holds `triangles[t]`.
    pub(crate) fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let stars = Stars::new(positions.len(), &triangles);
        let locked = Locked::default();
        Self { n_triangles: triangles.len(), positions, origins: vec![], triangles, stars, locked }
    }

    /// Locks the vertices on the boundary.
    pub(crate) fn lock_boundary(&mut self) {
        self.locked = Locked::boundary_of(self.n_vertices(), self.iter().map(|(_, corners)| corners));
    }

    /// Whether some vertices may be locked.
    #[inline]
    pub(crate) fn has_locked(&self) -> bool {
        !self.locked.is_empty()
    }

    /// Whether vertex `v` is to stay.
    #[inline]
    pub(crate) fn is_locked(&self, v: u32) -> bool {
        self.locked.has(v)
    }

    /// Whether the edge `a b` may be made: the mesh does not have it yet, and not both ends are
    /// locked. O(valence of the smaller star).
    pub(crate) fn may_join(&self, a: u32, b: u32) -> bool {
        !self.locked.has_both([a, b]) && self.n_faces(a, b) == 0
    }

    /// Vertices, alive or not.
    pub(crate) fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// Slots, in use or not.
    pub(crate) fn n_slots(&self) -> usize {
        self.triangles.len()
    }

    /// Triangles alive.
    pub(crate) fn n_triangles(&self) -> usize {
        self.n_triangles
    }

    /// Positions of all vertices, alive or not.
    pub(crate) fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Gives up everything but the positions.
    pub(crate) fn into_positions(self) -> Vec<[f32; 3]> {
        self.positions
    }

    /// Position of vertex `v`.
    #[inline]
    pub(crate) fn point(&self, v: u32) -> Vector {
        widen(self.positions[v as usize])
    }

    /// Position of vertex `v` at the start.
    #[inline]
    pub(crate) fn origin(&self, v: u32) -> Vector {
        self.origins.get(v as usize).map_or_else(|| self.point(v), |&p| widen(p))
    }

    /// Moves vertex `v`. O(1), and O(vertices) the first time.
    pub(crate) fn move_vertex(&mut self, v: u32, position: [f32; 3]) {
        if self.origins.is_empty() {
            self.origins.clone_from(&self.positions);
        }
        self.positions[v as usize] = position;
    }

    /// Corners of the triangle in `slot`; all [`u32::MAX`] once the slot is empty.
    #[inline]
    pub(crate) fn corners(&self, slot: u32) -> [u32; 3] {
        self.triangles[slot as usize]
    }

    /// Corner positions of the triangle in `slot`, which must be in use.
    #[inline]
    pub(crate) fn triangle(&self, slot: u32) -> [Vector; 3] {
        self.corners(slot).map(|v| self.point(v))
    }

    /// Whether the triangle in `slot` is still there.
    #[inline]
    pub(crate) fn is_alive(&self, slot: u32) -> bool {
        self.corners(slot) != GONE
    }

    /// Slots in use and their triangles.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, [u32; 3])> + Clone {
        (0..).zip(self.triangles.iter().copied()).filter(|&(_, corners)| corners != GONE)
    }

    /// Slots of the triangles at `v`.
    #[inline]
    pub(crate) fn star(&self, v: u32) -> &[u32] {
        self.stars.of(v)
    }

    /// How many triangles have the edge `a b`. O(valence of the smaller star).
    pub(crate) fn n_faces(&self, a: u32, b: u32) -> usize {
        let (fewer, other) = if self.star(a).len() <= self.star(b).len() { (a, b) } else { (b, a) };
        self.star(fewer).iter().filter(|&&slot| self.corners(slot).contains(&other)).count()
    }

    /// Whether some triangle has the three corners, in any order. O(valence of the smallest star).
    pub(crate) fn has_triangle(&self, corners: [u32; 3]) -> bool {
        let fewest =
            corners.map(|v| self.star(v)).into_iter().min_by_key(|star| star.len()).unwrap_or_default();
        fewest.iter().any(|&slot| {
            let found = self.corners(slot);
            corners.iter().all(|v| found.contains(v))
        })
    }

    /// Gives back memory that fillings left behind; cheap enough to call after every round.
    pub(crate) fn compact(&mut self) {
        self.stars.compact(self.n_triangles);
    }

    /// Closes the slots up where a quarter of them has become empty, and gives the new numbers for
    /// all that runs parallel to the slots or names them. O(slots) when it works, O(1) otherwise.
    pub(crate) fn close_up(&mut self) -> Option<Renumbering> {
        let is_short = self.n_slots() < MIN_SLOTS.max(self.n_vertices() / 4);
        if is_short || 4 * self.n_triangles > 3 * self.n_slots() {
            return None;
        }
        let slots = Renumbering::new(self.triangles.iter().map(|&corners| corners != GONE));
        slots.close_up(&mut self.triangles);
        self.stars.renumber(&slots);
        Some(slots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{sphere, torus};
    use crate::mesh::{Filling, Hole};
    use std::collections::BTreeSet;

    /// The fan from the first ring vertex.
    fn fan(hole: &Hole) -> Filling {
        let n = u8::try_from(hole.n_ring()).unwrap();
        let triangles: Vec<[u8; 3]> = (1..n - 1).map(|i| [0, i, i + 1]).collect();
        Filling { n_first_part: triangles.len(), triangles, part_starts: [0, 0] }
    }

    #[test]
    fn stars_are_the_triangles_at_each_vertex_after_every_filling() {
        for mesh in [sphere(5), torus(9, 7)] {
            let mut surface = Surface::new(mesh.positions, mesh.triangles);
            let mut hole = Hole::default();
            let mut n_filled = 0;
            for v in 0..u32::try_from(surface.n_vertices()).unwrap() {
                if hole.gather(&surface, v).is_err() {
                    continue;
                }
                surface.fill(&hole, &fan(&hole));
                n_filled += 1;
                assert_eq!(surface.n_triangles(), surface.iter().count());
                assert!(surface.star(v).is_empty());
                for &r in &hole.ring {
                    let around =
                        surface.iter().filter(|(_, corners)| corners.contains(&r)).map(|(slot, _)| slot);
                    let star = surface.star(r);
                    assert_eq!(star.iter().copied().collect::<BTreeSet<u32>>(), around.collect());
                    assert_eq!(star.len(), star.iter().collect::<BTreeSet<_>>().len());
                }
            }
            assert!(n_filled > 30);
        }
    }
}
