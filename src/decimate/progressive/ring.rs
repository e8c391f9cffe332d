//! The triangles at a vertex in order around it: the paper's loop.
//!
//! Most stars are one fan of a few triangles, and chaining them by trial is the fastest way. Any
//! other star, of many triangles, of several fans, with edges of three faces or with neighbours
//! that disagree about the orientation, is sorted instead.

use crate::flat::{NO_INDEX, to_index};
use crate::geometry::vector::Vector;
use crate::mesh::{Surface, facing_edge};

/// Stars of at most this many triangles are chained by trial.
const MAX_CHAINED_VALENCE: usize = 24;

/// How the triangles at a vertex hang together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Shape {
    /// No triangle.
    #[default]
    Empty,
    /// A full cycle: `vertices[i]`, `vertices[i + 1]` belong to `slots[i]`, and the last slot leads
    /// back to the first vertex.
    Cycle,
    /// A half cycle: one vertex more than slots, the first and the last on the boundary.
    Chain,
    /// Several fans, or a fan whose rim meets itself: not the star of a manifold.
    NonManifold,
}

/// A vertex and its star in order. Reused from vertex to vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ring {
    /// The vertex.
    pub center: u32,
    /// How the star hangs together.
    pub shape: Shape,
    /// Neighbours in order, for a cycle or chain; in the orientation of the first triangle.
    pub vertices: Vec<u32>,
    /// Slots in order; fan by fan where there are several.
    pub slots: Vec<u32>,
    /// Index into `slots` at which each fan starts.
    pub fan_starts: Vec<u32>,
    spokes: Vec<RingSpoke>,
}

/// A triangle of the star, seen from the vertex.
#[derive(Clone, Copy, Debug)]
struct RingSpoke {
    from: u32,
    to: u32,
    slot: u32,
}

impl Ring {
    /// Orders the star of `v`. O(valence log valence), and faster for few triangles.
    pub(crate) fn gather(&mut self, surface: &Surface, v: u32) {
        self.center = v;
        self.vertices.clear();
        self.slots.clear();
        self.fan_starts.clear();
        self.spokes.clear();
        self.spokes.extend(surface.star(v).iter().map(|&slot| {
            let (from, to) = facing_edge(surface.corners(slot), v);
            RingSpoke { from, to, slot }
        }));
        self.shape = if self.spokes.is_empty() {
            Shape::Empty
        } else if self.spokes.len() <= MAX_CHAINED_VALENCE && self.chain() {
            self.take_chain()
        } else {
            self.sort_into_fans()
        };
    }

    /// Number of triangles.
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.slots.len()
    }

    /// Whether the triangles surround the vertex.
    #[inline]
    pub(crate) fn is_cycle(&self) -> bool {
        self.shape == Shape::Cycle
    }

    /// Index of the neighbour after `i`, around the cycle.
    #[inline]
    pub(crate) fn next(&self, i: usize) -> usize {
        if i + 1 == self.vertices.len() { 0 } else { i + 1 }
    }

    /// Whether a triangle of the star has both neighbours `i` and `j`.
    pub(crate) fn are_adjacent(&self, i: usize, j: usize) -> bool {
        let (low, high) = (i.min(j), i.max(j));
        high == low + 1 || (self.is_cycle() && low == 0 && high + 1 == self.vertices.len())
    }

    /// Positions of the neighbours, into `points`.
    pub(crate) fn positions(&self, surface: &Surface, points: &mut Vec<Vector>) {
        points.clear();
        points.extend(self.vertices.iter().map(|&r| surface.point(r)));
    }

    /// Puts the spokes in order by looking for each one's successor; false where that does not give
    /// one fan.
    fn chain(&mut self) -> bool {
        let spokes = &mut self.spokes[..];
        let n = spokes.len();
        let mut n_forward = 1;
        while n_forward < n {
            let at = spokes[n_forward - 1].to;
            let Some(next) = spokes[n_forward..].iter().position(|spoke| spoke.from == at) else { break };
            spokes.swap(n_forward, n_forward + next);
            n_forward += 1;
        }
        let mut start = spokes[0].from;
        for placed in n_forward..n {
            let before = spokes[placed..].iter().position(|spoke| spoke.to == start);
            let Some(before) = before else { return false };
            spokes.swap(placed, placed + before);
            start = spokes[placed].from;
        }
        // Forwards from the first, then backwards from the first: turn the second part round and
        // put it in front.
        spokes[n_forward..].reverse();
        spokes.rotate_left(n_forward);
        true
    }

    /// Takes the chained spokes over, if they are one simple cycle or chain.
    fn take_chain(&mut self) -> Shape {
        let n = self.spokes.len();
        self.vertices.extend(self.spokes.iter().map(|spoke| spoke.from));
        self.slots.extend(self.spokes.iter().map(|spoke| spoke.slot));
        let end = self.spokes[n - 1].to;
        let is_cycle = end == self.vertices[0];
        if !is_cycle {
            self.vertices.push(end);
        }
        let is_simple = self.vertices.iter().enumerate().all(|(i, v)| !self.vertices[i + 1..].contains(v));
        if is_simple && (!is_cycle || n >= 2) {
            self.fan_starts.push(0);
            return if is_cycle { Shape::Cycle } else { Shape::Chain };
        }
        self.vertices.clear();
        self.slots.clear();
        self.sort_into_fans()
    }

    /// Joins triangles over the spokes that exactly two of them share, whatever their orientation.
    fn sort_into_fans(&mut self) -> Shape {
        let links = Links::new(&self.spokes);
        let mut is_taken = vec![false; self.spokes.len()];
        let n = self.spokes.len();
        let mut last_end = None;
        // Fans with an end first, from that end; what is left are cycles.
        for want_end in [true, false] {
            for first in 0..n {
                let end = (0..2).find(|&side| links.across(first, side).is_none());
                if is_taken[first] || (want_end && end.is_none()) {
                    continue;
                }
                self.fan_starts.push(to_index(self.slots.len()));
                // Enter by the open side, or in the triangle's own orientation.
                last_end = Some(self.walk(&links, (first, end.unwrap_or(0)), &mut is_taken));
            }
        }
        let is_one_fan = self.fan_starts.len() == 1;
        match last_end {
            Some(Some(end)) if is_one_fan && !links.is_crowded && end != self.vertices[0] => {
                self.vertices.push(end);
                Shape::Chain
            }
            Some(None) if is_one_fan => Shape::Cycle,
            _ => {
                self.vertices.clear();
                Shape::NonManifold
            }
        }
    }

    /// Takes the triangles of one fan, beginning at a triangle that is entered by one of its sides.
    /// Gives the vertex at which the fan ends, or nothing for a cycle.
    fn walk(&mut self, links: &Links, start: (usize, usize), is_taken: &mut [bool]) -> Option<u32> {
        let (mut at, mut side) = start;
        loop {
            is_taken[at] = true;
            let RingSpoke { from, to, slot } = self.spokes[at];
            let ends = [from, to];
            self.vertices.push(ends[side]);
            self.slots.push(slot);
            let (next, next_side) = match links.across(at, 1 - side) {
                Some(next) => next,
                None => return Some(ends[1 - side]),
            };
            if is_taken[next] {
                return None;
            }
            (at, side) = (next, next_side);
        }
    }
}

/// Which triangle of a star lies across each of its spokes.
struct Links {
    /// Two per triangle, `2 * triangle + side`: the other triangle and its side, or [`NO_INDEX`].
    across: Vec<u32>,
    /// Whether some spoke has more than two triangles.
    is_crowded: bool,
}

impl Links {
    fn new(spokes: &[RingSpoke]) -> Self {
        let mut ends: Vec<(u32, u32)> = spokes
            .iter()
            .zip(0..)
            .flat_map(|(spoke, at)| [(spoke.from, 2 * at), (spoke.to, 2 * at + 1)])
            .collect();
        ends.sort_unstable();
        let mut across = vec![NO_INDEX; ends.len()];
        let mut is_crowded = false;
        for shared in ends.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a), (_, b)] = *shared {
                across[a as usize] = b;
                across[b as usize] = a;
            }
            is_crowded |= shared.len() > 2;
        }
        Self { across, is_crowded }
    }

    fn across(&self, triangle: usize, side: usize) -> Option<(usize, usize)> {
        let link = self.across[2 * triangle + side];
        (link != NO_INDEX).then_some(((link / 2) as usize, (link % 2) as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(triangles: &[[u32; 3]]) -> Ring {
        let n = triangles.as_flattened().iter().max().map_or(0, |&v| v as usize + 1);
        let mut ring = Ring::default();
        ring.gather(&Surface::new(vec![[0.0; 3]; n], triangles.to_vec()), 0);
        ring
    }

    #[test]
    fn cycles_and_chains_are_put_in_order() {
        let cycle = ring(&[[0, 3, 4], [2, 0, 1], [0, 2, 3], [4, 1, 0]]);
        assert_eq!((cycle.shape, cycle.vertices.len(), cycle.len()), (Shape::Cycle, 4, 4));
        assert_eq!(cycle.vertices[0], 3);
        let chain = ring(&[[0, 2, 3], [0, 3, 4], [0, 1, 2]]);
        assert_eq!((chain.shape, &chain.vertices[..]), (Shape::Chain, &[1, 2, 3, 4][..]));
        assert_eq!(chain.slots, [2, 0, 1]);
        let sheet = ring(&[[0, 1, 2], [0, 2, 1]]);
        assert_eq!((sheet.shape, &sheet.vertices[..]), (Shape::Cycle, &[1, 2][..]));
    }

    #[test]
    fn neighbours_may_disagree_about_the_orientation() {
        let chain = ring(&[[0, 1, 2], [0, 3, 2], [0, 3, 4]]);
        assert_eq!(chain.shape, Shape::Chain);
        assert_eq!(chain.vertices, [1, 2, 3, 4]);
        let cycle = ring(&[[0, 1, 2], [0, 3, 2], [0, 3, 1]]);
        assert_eq!((cycle.shape, cycle.len()), (Shape::Cycle, 3));
    }

    #[test]
    fn fans_of_other_stars_are_told_apart() {
        let bow_tie = ring(&[[0, 1, 2], [0, 3, 4], [0, 2, 5]]);
        assert_eq!((bow_tie.shape, &bow_tie.fan_starts[..]), (Shape::NonManifold, &[0, 2][..]));
        let three_pages = ring(&[[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
        assert_eq!((three_pages.shape, three_pages.fan_starts.len()), (Shape::NonManifold, 3));
        let two_cones = ring(&[[0, 1, 2], [0, 2, 3], [0, 3, 1], [0, 4, 5], [0, 5, 6], [0, 6, 4]]);
        assert_eq!((two_cones.shape, two_cones.fan_starts.len()), (Shape::NonManifold, 2));
        assert_eq!(ring(&[[1, 2, 3]]).shape, Shape::Empty);
    }

    #[test]
    fn large_stars_are_sorted() {
        let n = 100_000;
        let fan: Vec<[u32; 3]> = (1..n).rev().map(|i| [0, i, i + 1]).collect();
        let chain = ring(&fan);
        assert_eq!((chain.shape, chain.len()), (Shape::Chain, n as usize - 1));
        assert!(chain.vertices.windows(2).all(|pair| pair[0].abs_diff(pair[1]) == 1));
    }
}
