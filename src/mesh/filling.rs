//! The triangles that close a hole.

use super::surface::GONE;
use super::{Hole, Surface};
use crate::geometry::vector::Vector;

/// Triangles over ring indices, each in the order of the ring and so oriented like the star it
/// replaces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Filling {
    /// Ring indices, three per triangle.
    pub triangles: Vec<[u8; 3]>,
    /// How many of them make up the first part, when the hole was split along a feature line. All
    /// of them otherwise.
    pub n_first_part: usize,
    /// Ring index at which each part starts; a part runs from there round to the other's start, or
    /// to the ring's end.
    pub part_starts: [u8; 2],
}

impl Filling {
    /// Corner positions of triangle `i`.
    pub(crate) fn triangle(&self, hole: &Hole, i: usize) -> [Vector; 3] {
        self.triangles[i].map(|corner| hole.points[corner as usize])
    }

    /// Vertices of triangle `i`.
    pub(crate) fn corners(&self, hole: &Hole, i: usize) -> [u32; 3] {
        self.triangles[i].map(|corner| hole.ring[corner as usize])
    }

    /// Ring index at which the part of triangle `i` starts.
    pub(crate) fn part_start(&self, i: usize) -> u8 {
        self.part_starts[usize::from(i >= self.n_first_part)]
    }

    /// Edges that are not on the ring, as pairs of ring indices with the lower first; an edge
    /// between two triangles comes once. Includes the new boundary edge of a half disk.
    pub(crate) fn inner_edges<'a>(&'a self, hole: &'a Hole) -> impl Iterator<Item = [u8; 2]> + 'a {
        self.triangles.iter().flat_map(move |&[a, b, c]| {
            [[a, b], [b, c], [c, a]].into_iter().filter_map(move |[i, j]| {
                // Two triangles run along their common edge in opposite directions, and only one
                // runs upwards; the boundary edge of a half disk is run once, downwards from the
                // last ring vertex to the first.
                let is_boundary = !hole.closed && j == 0 && usize::from(i) + 1 == hole.n_ring();
                let is_inner = !hole.is_ring_edge(i.into(), j.into());
                (is_inner && (i < j || is_boundary)).then_some([i.min(j), i.max(j)])
            })
        })
    }
}

impl Surface {
    /// Puts a filling in the place of the star of `hole`: its triangles, fewer than the star has,
    /// go into the first slots of the star. O(sum of the valences around the hole).
    pub(crate) fn fill(&mut self, hole: &Hole, filling: &Filling) {
        let n_new = filling.triangles.len();
        debug_assert!(n_new < hole.slots.len());
        let new = |i: usize| if i < n_new { filling.corners(hole, i) } else { GONE };
        // A corner that the old and the new triangle of a slot have in common keeps it. First some
        // make room, then others take it.
        for (i, &slot) in hole.slots.iter().enumerate() {
            let (old, new) = (self.corners(slot), new(i));
            for v in old.into_iter().filter(|v| *v != hole.removed && !new.contains(v)) {
                self.stars.remove(v, slot);
            }
        }
        self.stars.clear(hole.removed);
        for (i, &slot) in hole.slots.iter().enumerate() {
            let new = new(i);
            let old = std::mem::replace(&mut self.triangles[slot as usize], new);
            if new != GONE {
                for v in new.into_iter().filter(|v| !old.contains(v)) {
                    self.stars.add(v, slot);
                }
            }
        }
        self.n_triangles -= hole.slots.len() - n_new;
    }
}
