//! The mesh while it is being simplified.

use super::{Filling, Hole, Renumbering, Stars};
use crate::geometry::vector::{Vector, widen};

/// Corners of a slot whose triangle is gone.
const GONE: [u32; 3] = [u32::MAX; 3];

/// So few slots do not close up, nor does an eighth of those of the input: there is no more to be gained.
const MIN_SLOTS: usize = 4096;

/// Triangles in slots, with the star of every vertex.
///
/// A slot holds one triangle at a time. A retriangulated hole has fewer triangles than the star it came from, so new
/// triangles always find room in the slots of the old ones, and arrays that run parallel to the slots never grow; they
/// become shorter when slots [close up](Self::close_up).
#[derive(Clone, Debug)]
pub struct Surface {
    positions: Vec<[f32; 3]>,
    /// Where the vertices were at the start; empty while none has moved.
    origins: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    stars: Stars,
    n_triangles: usize,
}

impl Surface {
    /// A surface over `positions` in which slot `t` holds `triangles[t]`.
    pub fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let stars = Stars::new(positions.len(), &triangles);
        Self { n_triangles: triangles.len(), positions, origins: vec![], triangles, stars }
    }

    /// Vertices, alive or not.
    pub fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// Slots, in use or not.
    pub fn n_slots(&self) -> usize {
        self.triangles.len()
    }

    /// Triangles alive.
    pub fn n_triangles(&self) -> usize {
        self.n_triangles
    }

    /// Positions of all vertices, alive or not.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Gives up everything but the positions.
    pub fn into_positions(self) -> Vec<[f32; 3]> {
        self.positions
    }

    /// Position of vertex `v`.
    #[inline]
    pub fn point(&self, v: u32) -> Vector {
        widen(self.positions[v as usize])
    }

    /// Position of vertex `v` at the start.
    #[inline]
    pub fn origin(&self, v: u32) -> Vector {
        self.origins.get(v as usize).map_or_else(|| self.point(v), |&p| widen(p))
    }

    /// Moves vertex `v`. O(1), and O(vertices) the first time.
    pub fn move_vertex(&mut self, v: u32, position: [f32; 3]) {
        if self.origins.is_empty() {
            self.origins.clone_from(&self.positions);
        }
        self.positions[v as usize] = position;
    }

    /// Corners of the triangle in `slot`; all `u32::MAX` once the slot is empty.
    #[inline]
    pub fn corners(&self, slot: u32) -> [u32; 3] {
        self.triangles[slot as usize]
    }

    /// Corner positions of the triangle in `slot`, which must be in use.
    #[inline]
    pub fn triangle(&self, slot: u32) -> [Vector; 3] {
        self.corners(slot).map(|v| self.point(v))
    }

    /// Slots in use and their triangles.
    pub fn iter(&self) -> impl Iterator<Item = (u32, [u32; 3])> + Clone {
        (0..).zip(self.triangles.iter().copied()).filter(|&(_, corners)| corners != GONE)
    }

    /// Slots of the triangles at `v`.
    #[inline]
    pub fn star(&self, v: u32) -> &[u32] {
        self.stars.of(v)
    }

    /// How many triangles have the edge `a b`. O(valence of the smaller star).
    pub fn n_faces(&self, a: u32, b: u32) -> usize {
        let (fewer, other) = if self.star(a).len() <= self.star(b).len() { (a, b) } else { (b, a) };
        self.star(fewer).iter().filter(|&&slot| self.corners(slot).contains(&other)).count()
    }

    /// Whether some triangle has the three corners, in any order. O(valence of the smallest star).
    pub fn has_triangle(&self, corners: [u32; 3]) -> bool {
        let fewest =
            corners.map(|v| self.star(v)).into_iter().min_by_key(|star| star.len()).unwrap_or_default();
        fewest.iter().any(|&slot| {
            let found = self.corners(slot);
            corners.iter().all(|v| found.contains(v))
        })
    }

    /// Puts a filling in the place of the star of `hole`, in the first slots of the star. O(sum of the valences around the hole).
    pub fn fill(&mut self, hole: &Hole, filling: &Filling) {
        let n_new = filling.triangles.len();
        debug_assert!(n_new < hole.slots.len());
        for &slot in &hole.slots {
            for v in self.corners(slot).into_iter().filter(|&v| v != hole.removed) {
                self.stars.remove(v, slot);
            }
            self.triangles[slot as usize] = GONE;
        }
        self.stars.clear(hole.removed);
        for (i, &slot) in hole.slots.iter().take(n_new).enumerate() {
            let corners = filling.corners(hole, i);
            self.triangles[slot as usize] = corners;
            for v in corners {
                self.stars.add(v, slot);
            }
        }
        self.n_triangles -= hole.slots.len() - n_new;
    }

    /// Gives back memory that fillings left behind; cheap enough to call after every round.
    pub fn compact(&mut self) {
        self.stars.compact(self.n_triangles);
    }

    /// Closes the slots up where a quarter of them has become empty, and gives the new numbers for all that runs parallel to the slots
    /// or names them. O(slots) when it works, O(1) otherwise.
    pub fn close_up(&mut self) -> Option<Renumbering> {
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
