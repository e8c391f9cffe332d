//! The input, as far as the proof needs it: its edges.

use crate::flat::{Groups, to_index};
use std::ops::Range;

/// Edges of a triangle mesh, in flat arrays. Edges are numbered by their lower end, then by their
/// higher one, so that those to higher vertices lie side by side, and the lower end need not be
/// written down.
///
/// Memory: 4 bytes per edge and per vertex; 12 per triangle more while it is made.
#[derive(Clone, Debug)]
pub(crate) struct SourceEdges {
    /// Higher end of each edge.
    highs: Vec<u32>,
    /// Where the edges that lead up from each vertex start in `highs`.
    first_up: Vec<u32>,
    /// Lower end of the first edge of each block of [`BLOCK`], and a vertex behind all others.
    lows: Vec<u32>,
}

/// Edges between two whose lower end is written down.
const BLOCK: usize = 16;

/// Of at most so many edges the one looked for is found by going through them.
const MAX_LINEAR_SEARCH: usize = 8;

/// More edges up from a vertex than this are not gone through for the sake of a few.
const HUB: usize = 64;

impl SourceEdges {
    /// Edges of `triangles` over `n_vertices` vertices. O(n log valence).
    pub(crate) fn new(n_vertices: usize, triangles: impl Iterator<Item = [u32; 3]> + Clone) -> Self {
        let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| (p.min(q), p.max(q)));
        let (starts, mut highs) = Groups::new(n_vertices, triangles.flat_map(sides)).into_parts();
        let mut first_up = Vec::with_capacity(n_vertices + 1);
        first_up.push(0);
        let mut lows = vec![];
        let mut n_edges = 0;
        for (low, ends) in (0..).zip(starts.windows(2)) {
            n_edges += sort_and_keep_distinct(&mut highs, ends[0] as usize..ends[1] as usize, n_edges);
            lows.resize(n_edges.div_ceil(BLOCK), low);
            first_up.push(to_index(n_edges));
        }
        lows.push(to_index(n_vertices));
        highs.truncate(n_edges);
        highs.shrink_to_fit();
        Self { highs, first_up, lows }
    }

    /// How many edges there are.
    pub(crate) fn n_edges(&self) -> usize {
        self.highs.len()
    }

    /// End vertices of `edge`, the lower one first.
    #[inline]
    pub(crate) fn ends(&self, edge: u32) -> [u32; 2] {
        [self.low(edge), self.highs[edge as usize]]
    }

    /// Lower end of `edge`: the last vertex whose edges start no later, among the few of a block.
    #[inline]
    fn low(&self, edge: u32) -> u32 {
        let block = edge as usize / BLOCK;
        let (first, last) = (self.lows[block], self.lows[block + 1]);
        let starts = &self.first_up[first as usize + 1..=last as usize];
        first + to_index(starts.partition_point(|&start| start <= edge))
    }

    /// Edges from `v` to higher vertices, each with its higher end, in ascending order.
    #[inline]
    pub(crate) fn up(&self, v: u32) -> impl Iterator<Item = (u32, u32)> {
        let (start, end) = (self.first_up[v as usize], self.first_up[v as usize + 1]);
        (start..end).zip(self.highs[start as usize..end as usize].iter().copied())
    }

    /// Those of the edges [up](Self::up) from `v` that lead to one of `others`, and maybe more of
    /// them. O(edges up from `v`), or O(others log edges) at a hub of many edges.
    #[inline]
    pub(crate) fn up_to(&self, v: u32, others: &[u32]) -> impl Iterator<Item = (u32, u32)> {
        let is_hub = self.n_up(v) > HUB.max(others.len());
        let (of_hub, all) = if is_hub { (others, v..v) } else { (&[][..], v..v + 1) };
        let found = of_hub.iter().filter_map(move |&other| Some((self.edge(v, other)?, other)));
        all.flat_map(|v| self.up(v)).chain(found)
    }

    fn n_up(&self, v: u32) -> usize {
        (self.first_up[v as usize + 1] - self.first_up[v as usize]) as usize
    }

    /// The edge from `low` up to `high`. O(log edges).
    #[inline]
    pub(crate) fn edge(&self, low: u32, high: u32) -> Option<u32> {
        let start = self.first_up[low as usize];
        let highs = &self.highs[start as usize..][..self.n_up(low)];
        let found = if highs.len() <= MAX_LINEAR_SEARCH {
            highs.iter().position(|&other| other == high)
        } else {
            highs.binary_search(&high).ok()
        };
        found.map(|at| start + to_index(at))
    }
}

/// Sorts the members of a group, which are at `from`, and writes each of them once to the places
/// from `to` on, which must not be behind theirs. How many there are.
fn sort_and_keep_distinct(members: &mut [u32], from: Range<usize>, to: usize) -> usize {
    members[from.clone()].sort_unstable();
    let mut n_kept = 0;
    for at in from {
        let member = members[at];
        if n_kept == 0 || members[to + n_kept - 1] != member {
            members[to + n_kept] = member;
            n_kept += 1;
        }
    }
    n_kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn edges_are_listed_once_and_at_their_lower_ends(triangles in prop::collection::vec(prop::array::uniform3(0_u32..9), 0..20)) {
            let edges = SourceEdges::new(9, triangles.iter().copied());
            let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let expected: BTreeSet<[u32; 2]> = sides.map(|[p, q]| [p.min(q), p.max(q)]).collect();
            prop_assert_eq!(edges.n_edges(), expected.len());
            prop_assert!((0..).map(|edge| edges.ends(edge)).take(expected.len()).eq(expected.iter().copied()));
            for v in 0..9 {
                let up: BTreeSet<_> = edges.up(v).map(|(edge, high)| { assert_eq!(edges.ends(edge), [v, high]); edge }).collect();
                prop_assert_eq!(up.len(), expected.iter().filter(|ends| ends[0] == v).count());
                for other in 0..9 {
                    prop_assert_eq!(edges.edge(v, other).is_some(), expected.contains(&[v, other]));
                }
            }
        }
    }

    #[test]
    fn a_hub_is_asked_for_the_edges_in_question() {
        let n = 3 * u32::try_from(HUB).unwrap();
        let fan = (1..n).map(|i| [0, i, i + 1]);
        let edges = SourceEdges::new(n as usize + 1, fan);
        let found: Vec<(u32, u32)> = edges.up_to(0, &[7, n, 2]).collect();
        assert_eq!(found, [(6, 7), (n - 1, n), (1, 2)]);
        assert!(edges.up_to(5, &[]).eq(edges.up(5)));
    }
}
