//! What a removal means for the map: where its vertices and edges lie in the star and in the filling.

use super::chains::Portion;
use super::labels::Labels;
use super::{Certified, NOT_ON_RIM};
use crate::bound::Replacement;
use crate::bound::covered::{Covered, Over};
use crate::bound::removed::nearest;
use crate::geometry::distance::{Segment, point_triangle_distance_sq};
use crate::geometry::vector::Vector;
use std::ops::ControlFlow;

/// A hole, its filling, and what the map is before the removal.
#[derive(Clone, Copy)]
pub(super) struct Removal<'a> {
    pub(super) certified: &'a Certified,
    pub(super) replacement: Replacement<'a>,
    pub(super) covered: &'a Covered,
}

impl Removal<'_> {
    /// Index in the star of the triangle in `slot`. Looks at all of it: where a search would end cannot be foretold.
    #[inline]
    pub(super) fn star_index(&self, slot: u32) -> Option<usize> {
        let slots = self.replacement.hole.slots.iter().enumerate();
        let found = slots.fold(usize::MAX, |found, (at, &other)| if other == slot { at } else { found });
        (found != usize::MAX).then_some(found)
    }

    #[expect(clippy::cast_possible_truncation, reason = "ring indices stay below MAX_VALENCE + 1")]
    pub(super) fn ring_index(&self, v: u32) -> u8 {
        let found = self.replacement.hole.ring.iter().position(|&r| r == v);
        debug_assert!(found.is_some(), "a source edge that ends in the hole ends at its ring");
        found.unwrap_or_default() as u8
    }

    /// Shows `take` the source edges whose chain, old or new, has more than one portion and passes through the hole, given where
    /// the vertices go; each once, until it breaks.
    #[inline]
    pub(super) fn try_each_moved_edge(
        &self,
        labels: &Labels,
        mut take: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.try_each_chained_edge(&mut take)?;
        self.try_each_split_edge(labels, &mut take)
    }

    /// Edges with a chain through the star. Each is met in the slot of its first portion there.
    #[inline]
    fn try_each_chained_edge(&self, take: &mut impl FnMut(u32) -> ControlFlow<()>) -> ControlFlow<()> {
        let Certified { chains, contents, .. } = self.certified;
        for &slot in &self.replacement.hole.slots {
            for &edge in contents.edges(slot) {
                let here = chains.of(edge).iter().find(|portion| self.star_index(portion.slot).is_some());
                if here.is_some_and(|portion| portion.slot == slot) {
                    take(edge)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Edges without a chain that are to get one. Both ends are corners of the star or mapped into it: each is met at its lower
    /// end, or at the only one that is mapped.
    #[inline]
    fn try_each_split_edge(
        &self,
        labels: &Labels,
        take: &mut impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Certified { source, chains, .. } = self.certified;
        for &v in &self.covered.vertices {
            let label = labels.get(v).unwrap_or_default();
            for (edge, other) in source.up(v) {
                let is_split = match labels.get(other) {
                    Some(other_label) => other_label != label,
                    None => !self.has_corner(label, other),
                };
                if is_split && !chains.has(edge) {
                    take(edge)?;
                }
            }
            for (edge, other) in source.down(v) {
                if labels.get(other).is_none() && !self.has_corner(label, other) && !chains.has(edge) {
                    take(edge)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// The triangle that the covered vertex at index `at` lies over, or else the nearest one, and its squared distance.
    pub(super) fn near(&self, at: usize, p: Vector, overs: &[Over]) -> (u8, f64) {
        let Replacement { hole, filling, .. } = self.replacement;
        match (0..).zip(overs).find(|&(_, &over)| self.covered.is_over(at, over)) {
            Some((label, _)) => (label, point_triangle_distance_sq(p, &filling.triangle(hole, label.into()))),
            None => self.nearest(p),
        }
    }

    /// Whether the filling's triangle `label` has the corner `v`.
    pub(super) fn has_corner(&self, label: u8, v: u32) -> bool {
        self.replacement.filling.corners(self.replacement.hole, label.into()).contains(&v)
    }

    #[expect(clippy::cast_possible_truncation, reason = "a filling has fewer than MAX_VALENCE triangles")]
    fn nearest(&self, p: Vector) -> (u8, f64) {
        let (label, distance_sq) = nearest(self.replacement.hole, self.replacement.filling, p);
        (label as u8, distance_sq)
    }

    /// End points of the ring edge after ring vertex `i`; for the last one of a chain, of the new boundary edge.
    pub(super) fn ring_edge(&self, i: usize) -> Segment {
        [self.replacement.hole.points[i], self.replacement.hole.points[self.replacement.hole.next(i)]]
    }

    /// For a source vertex on the boundary: the ring edge that its boundary edge is, or becomes.
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
        let slot = self.certified.slot_of[v as usize];
        let corners = self.replacement.surface.corners(slot);
        let (from, to) = (corners[usize::from(corner)], corners[(usize::from(corner) + 1) % 3]);
        let is_replaced = from == hole.removed || to == hole.removed;
        Some(if is_replaced { new_edge } else { self.star_index(slot).unwrap_or_default() })
    }

    /// The corner of its new triangle at which the boundary edge of `v` starts.
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

    /// Takes out what a chain does not need: going over an edge and straight back, and turning about a vertex that is
    /// its own image.
    pub(super) fn shorten(&self, edge: u32, portions: &mut Vec<Portion>) {
        let [low, high] = self.certified.source.ends(edge);
        let mut kept = 0;
        for at in 0..portions.len() {
            let portion = portions[at];
            if kept >= 2 && portions[kept - 2].slot == portion.slot {
                kept -= 1;
                portions[kept - 1].end = portion.end;
            } else if kept >= 1 && portions[kept - 1].slot == portion.slot {
                portions[kept - 1].end = portion.end;
            } else if kept == 1
                && self.stays(low)
                && self.touches(portions[0].slot, low)
                && self.touches(portion.slot, low)
            {
                portions[0] = portion;
            } else {
                portions[kept] = portion;
                kept += 1;
            }
        }
        while kept >= 2
            && self.stays(high)
            && self.touches(portions[kept - 1].slot, high)
            && self.touches(portions[kept - 2].slot, high)
        {
            kept -= 1;
            portions[kept - 1].end = 1.0;
        }
        portions.truncate(kept);
    }

    pub(super) fn stays(&self, v: u32) -> bool {
        v != self.replacement.hole.removed && self.certified.is_alive(v)
    }

    /// Whether the triangle in `slot`, after the removal, has the corner `v`.
    pub(super) fn touches(&self, slot: u32, v: u32) -> bool {
        match self.star_index(slot) {
            Some(i) if i < self.replacement.filling.triangles.len() => {
                self.replacement.filling.corners(self.replacement.hole, i).contains(&v)
            }
            Some(_) => false,
            None => self.replacement.surface.corners(slot).contains(&v),
        }
    }
}
