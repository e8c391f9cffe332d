//! Removed vertices and the triangles that stand for them: the estimate e_g2 (JADE, section 4).
//!
//! Each removed vertex belongs to one triangle of the current mesh. When a star is replaced, its
//! vertices go to the nearest of the new triangles. The largest distance is the estimate, and a
//! true one-sided distance as far as the vertices go; what lies between them, and the other
//! direction, it cannot see.

use crate::flat::NO_INDEX;
use crate::geometry::distance::point_triangle_distance_sq;
use crate::geometry::vector::Vector;
use crate::mesh::{Filling, Hole, Renumbering};

/// For every slot the list of removed vertices that belong to its triangle, linked through the
/// vertices.
#[derive(Clone, Debug)]
pub(crate) struct RemovedVertices {
    first: Vec<u32>,
    next: Vec<u32>,
}

impl RemovedVertices {
    /// Empty lists for `n_slots` slots over `n_vertices` vertices.
    pub(crate) fn new(n_slots: usize, n_vertices: usize) -> Self {
        Self { first: vec![NO_INDEX; n_slots], next: vec![NO_INDEX; n_vertices] }
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        slots.close_up(&mut self.first);
    }

    /// Vertices that belong to `slot`.
    pub(crate) fn of(&self, slot: u32) -> impl Iterator<Item = u32> + '_ {
        let some = |v: u32| (v != NO_INDEX).then_some(v);
        std::iter::successors(some(self.first[slot as usize]), move |&v| some(self.next[v as usize]))
    }

    /// Vertices that belong to the star of `hole`, and the one being removed.
    pub(crate) fn of_hole<'a>(&'a self, hole: &'a Hole) -> impl Iterator<Item = u32> + 'a {
        std::iter::once(hole.removed).chain(hole.slots.iter().flat_map(|&slot| self.of(slot)))
    }

    /// Empties the lists of the star of `hole`.
    pub(crate) fn clear(&mut self, hole: &Hole) {
        for &slot in &hole.slots {
            self.first[slot as usize] = NO_INDEX;
        }
    }

    /// Gives `v`, which is in no list, to `slot`.
    pub(crate) fn add(&mut self, v: u32, slot: u32) {
        self.next[v as usize] = self.first[slot as usize];
        self.first[slot as usize] = v;
    }
}

/// The triangle of the filling nearest to `p`, and the squared distance; the first one where
/// several are as near.
pub(crate) fn nearest(hole: &Hole, filling: &Filling, p: Vector) -> (usize, f64) {
    (0..filling.triangles.len())
        .map(|i| (i, point_triangle_distance_sq(p, &filling.triangle(hole, i))))
        .fold((0, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_what_was_added_since_they_were_cleared() {
        let mut removed = RemovedVertices::new(3, 10);
        [(4, 1), (7, 1), (2, 0)].into_iter().for_each(|(v, slot)| removed.add(v, slot));
        assert_eq!(removed.of(1).collect::<Vec<_>>(), [7, 4]);
        let hole = Hole { removed: 9, slots: vec![1, 0], ..Hole::default() };
        assert_eq!(removed.of_hole(&hole).collect::<Vec<_>>(), [9, 7, 4, 2]);
        removed.clear(&hole);
        assert_eq!(removed.of_hole(&hole).collect::<Vec<_>>(), [9]);
    }
}
