//! What a removal means for the map: where its vertices and edges lie in the star and in the
//! filling.

use super::labels::Labels;
use super::star::OUTSIDE;
use super::{Certified, NOT_ON_RIM};
use crate::bound::removed::nearest;
use crate::bound::replacement::Replacement;
use crate::geometry::distance::{Segment, point_triangle_distance_sq};
use crate::geometry::vector::Vector;
use std::ops::ControlFlow;

/// A source edge with a chain, found in a triangle of the star.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChainInStar {
    pub(super) edge: u32,
    /// Index of the triangle in the star.
    pub(super) at: u8,
}

/// A hole, its filling, and what the map is before the removal.
#[derive(Clone, Copy)]
pub(super) struct Removal<'a> {
    pub(super) certified: &'a Certified,
    pub(super) replacement: Replacement<'a>,
    /// The source vertices mapped into the star.
    pub(super) covered: &'a [u32],
}

impl Removal<'_> {
    #[expect(clippy::cast_possible_truncation, reason = "ring indices stay below MAX_VALENCE + 1")]
    pub(super) fn ring_index(&self, v: u32) -> u8 {
        let found = self.replacement.hole.ring.iter().position(|&r| r == v);
        debug_assert!(found.is_some(), "a source edge that ends in the hole ends at its ring");
        found.unwrap_or_default() as u8
    }

    /// Shows `take` the source edges with a chain through the star, in each slot that lists them,
    /// until it breaks.
    #[inline]
    pub(super) fn try_each_chained_edge(
        &self,
        mut take: impl FnMut(ChainInStar) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for (at, &slot) in (0..).zip(&self.replacement.hole.slots) {
            for &edge in self.certified.contents.edges(slot) {
                take(ChainInStar { edge, at })?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Shows `take` the source edges without a chain that are to get one, with their ends, given
    /// where the vertices go, each once, until it breaks. Both ends are corners of the star or
    /// mapped into it; an edge is found at its lower end.
    #[inline]
    pub(super) fn try_each_split_edge(
        &self,
        labels: &Labels,
        mut take: impl FnMut(u32, [u32; 2]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Certified { source, chains, .. } = self.certified;
        for &v in self.covered {
            let label = labels.get(v).unwrap_or_default();
            for (edge, other) in source.up(v) {
                let is_split = match labels.get(other) {
                    Some(other_label) => other_label != label,
                    None => !self.has_corner(label, other),
                };
                if is_split && !chains.has(edge) {
                    take(edge, [v, other])?;
                }
            }
        }
        for &v in &self.replacement.hole.ring {
            for (edge, other) in source.up_to(v, self.covered) {
                let is_split = labels.get(other).is_some_and(|label| !self.has_corner(label, v));
                if is_split && !chains.has(edge) {
                    take(edge, [v, other])?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// A triangle for a covered vertex, and its squared distance: the one that it lies over if that
    /// is within the limit, or else the nearest one.
    #[expect(clippy::cast_possible_truncation, reason = "a filling has fewer than MAX_VALENCE triangles")]
    #[inline]
    pub(super) fn near(&self, p: Vector, over: Option<usize>, limit_sq: f64) -> (u8, f64) {
        let Replacement { hole, filling, .. } = self.replacement;
        let below = over.map(|label| (label, point_triangle_distance_sq(p, &filling.triangle(hole, label))));
        let is_enough = |&(_, distance_sq): &(usize, f64)| distance_sq <= limit_sq;
        let (label, distance_sq) = below.filter(is_enough).unwrap_or_else(|| nearest(hole, filling, p));
        (label as u8, distance_sq)
    }

    /// Whether the filling's triangle `label` has the corner `v`.
    pub(super) fn has_corner(&self, label: u8, v: u32) -> bool {
        self.replacement.filling.corners(self.replacement.hole, label.into()).contains(&v)
    }

    /// End points of the ring edge after ring vertex `i`; for the last one of a chain, of the new
    /// boundary edge.
    pub(super) fn ring_edge(&self, i: usize) -> Segment {
        [self.replacement.hole.points[i], self.replacement.hole.points[self.replacement.hole.next(i)]]
    }

    /// For a source vertex on the boundary: the ring edge that its boundary edge is, or becomes.
    #[inline]
    pub(super) fn rim_edge(&self, v: u32) -> Option<usize> {
        let hole = self.replacement.hole;
        let new_edge = hole.n_ring() - 1;
        if v == hole.removed {
            return (!hole.closed).then_some(new_edge);
        }
        let corner = self.certified.rim_corner[v as usize];
        if corner == NOT_ON_RIM {
            return None;
        }
        let &slot = self.certified.rim_slots.get(&v)?;
        let corners = self.replacement.surface.corners(slot);
        let (from, to) = (corners[usize::from(corner)], corners[(usize::from(corner) + 1) % 3]);
        if from == hole.removed || to == hole.removed {
            return Some(new_edge);
        }
        hole.slots.iter().position(|&other| other == slot)
    }

    /// The corner of its new triangle at which the boundary edge of `v` starts.
    #[inline]
    pub(super) fn new_rim(&self, v: u32) -> Option<u8> {
        let from = self.rim_edge(v)?;
        let to = self.replacement.hole.next(from);
        let runs = |&[a, b, c]: &[u8; 3]| {
            (0..)
                .zip([[a, b], [b, c], [c, a]])
                .find(|&(_, [i, j])| usize::from(i) == from && usize::from(j) == to)
        };
        self.replacement.filling.triangles.iter().find_map(runs).map(|(corner, _)| corner)
    }

    pub(super) fn stays(&self, v: u32) -> bool {
        v != self.replacement.hole.removed && self.certified.is_alive(v)
    }

    /// Whether the triangle in `slot`, which is `label` of the filling or outside the hole, has the
    /// corner `v`.
    #[inline]
    pub(super) fn touches(&self, slot: u32, label: u8, v: u32) -> bool {
        if label == OUTSIDE {
            self.replacement.surface.corners(slot).contains(&v)
        } else {
            self.has_corner(label, v)
        }
    }
}
