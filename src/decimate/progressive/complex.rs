//! The mesh while its topology changes: any triangles over any points.

use crate::geometry::vector::{Vector, widen};
use crate::mesh::{Locked, Stars};

/// Corners of a slot whose triangle is gone.
const GONE: [u32; 3] = [u32::MAX; 3];

/// Triangles in slots, with the star of every point. Nothing is asked of the stars: edges may have any number of triangles.
///
/// A collapse renames a corner of the triangles that survive it, in their slots; a split does the same. So slots are never
/// refilled, and arrays that run parallel to them never grow; points may be added.
#[derive(Clone, Debug)]
pub struct Complex {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    stars: Stars,
    n_triangles: usize,
    locked: Locked,
}

impl Complex {
    /// The complex in which slot `t` holds `triangles[t]`, each with three distinct corners below `positions.len()`.
    pub fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let stars = Stars::new(positions.len(), &triangles);
        Self { n_triangles: triangles.len(), positions, triangles, stars, locked: Locked::default() }
    }

    /// Locks the points on the boundary.
    pub fn lock_boundary(&mut self) {
        self.locked = Locked::boundary_of(self.n_points(), self.iter().map(|(_, corners)| corners));
    }

    /// Whether some points may be locked.
    #[inline]
    pub fn has_locked(&self) -> bool {
        !self.locked.is_empty()
    }

    /// Whether point `v` is to stay.
    #[inline]
    pub fn is_locked(&self, v: u32) -> bool {
        self.locked.has(v)
    }

    /// Points, in use or not.
    pub fn n_points(&self) -> usize {
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

    /// Positions of all points.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Position of point `v`.
    #[inline]
    pub fn point(&self, v: u32) -> Vector {
        widen(self.positions[v as usize])
    }

    /// Whether two points are at the same place, as a point and its copy are.
    #[inline]
    pub fn coincide(&self, a: u32, b: u32) -> bool {
        self.positions[a as usize] == self.positions[b as usize]
    }

    /// Corners of the triangle in `slot`; all `u32::MAX` once it is gone.
    #[inline]
    pub fn corners(&self, slot: u32) -> [u32; 3] {
        self.triangles[slot as usize]
    }

    /// Whether the triangle in `slot` is still there.
    pub fn is_alive(&self, slot: u32) -> bool {
        self.corners(slot) != GONE
    }

    /// Slots in use and their triangles.
    pub fn iter(&self) -> impl Iterator<Item = (u32, [u32; 3])> {
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

    /// Whether a triangle with these corners in this orientation is there. O(valence of the smallest star).
    pub fn has_triangle(&self, corners: [u32; 3]) -> bool {
        let [a, b, c] = corners;
        let fewest = corners.into_iter().min_by_key(|&v| self.star(v).len()).unwrap_or(a);
        self.star(fewest).iter().any(|&slot| {
            let found = self.corners(slot);
            found == [a, b, c] || found == [b, c, a] || found == [c, a, b]
        })
    }

    /// A new point at the place of `v`, without triangles.
    pub fn add_copy(&mut self, v: u32) -> u32 {
        self.positions.push(self.positions[v as usize]);
        self.stars.add_vertex()
    }

    /// Takes `from` to `into`: of the triangles at `from`, whose slots are `star`, those at `into` go, the others
    /// change the corner. O(sum of the valences around).
    pub fn collapse(&mut self, from: u32, into: u32, star: &[u32]) {
        for &slot in star {
            let corners = self.corners(slot);
            if corners.contains(&into) {
                for v in corners.into_iter().filter(|&v| v != from) {
                    self.stars.remove(v, slot);
                }
                self.triangles[slot as usize] = GONE;
                self.n_triangles -= 1;
            } else {
                self.triangles[slot as usize] = corners.map(|v| if v == from { into } else { v });
                self.stars.add(into, slot);
            }
        }
        self.stars.clear(from);
        self.stars.compact(self.n_triangles);
    }

    /// Gives the triangles in `slots`, all of them at `from`, the corner `to` in its place. O(slots * valence).
    pub fn rename(&mut self, from: u32, to: u32, slots: &[u32]) {
        for &slot in slots {
            self.triangles[slot as usize] = self.corners(slot).map(|v| if v == from { to } else { v });
            self.stars.add(to, slot);
        }
        if slots.len() == self.stars.of(from).len() {
            self.stars.clear(from);
        } else {
            slots.iter().for_each(|&slot| self.stars.remove(from, slot));
        }
    }
}
