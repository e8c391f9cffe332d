//! Collapses and splits: triangles change a corner and stay in their slots.

use super::Surface;
use super::surface::GONE;
use crate::flat::canonical;

impl Surface {
    /// Whether two vertices are at the same place, as a vertex and its copy are.
    #[inline]
    pub(crate) fn coincide(&self, a: u32, b: u32) -> bool {
        self.positions[a as usize] == self.positions[b as usize]
    }

    /// Whether a triangle with these corners in this orientation is there. O(valence of the
    /// smallest star).
    pub(crate) fn has_oriented_triangle(&self, corners: [u32; 3]) -> bool {
        let sought = canonical(corners);
        let fewest = corners.into_iter().min_by_key(|&v| self.star(v).len()).unwrap_or(corners[0]);
        self.star(fewest).iter().any(|&slot| canonical(self.corners(slot)) == sought)
    }

    /// A new vertex at the place of `v`, without triangles. No vertex has moved.
    pub(crate) fn add_copy(&mut self, v: u32) -> u32 {
        self.positions.push(self.positions[v as usize]);
        self.stars.add_vertex()
    }

    /// Takes `from` to `into`: of the triangles at `from`, whose slots are `star`, those at `into`
    /// go, the others change the corner. O(sum of the valences around).
    pub(crate) fn collapse(&mut self, from: u32, into: u32, star: &[u32]) {
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

    /// Gives the triangles in `slots`, all of them at `from`, the corner `to` in its place. O(slots
    /// * valence).
    pub(crate) fn rename(&mut self, from: u32, to: u32, slots: &[u32]) {
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
