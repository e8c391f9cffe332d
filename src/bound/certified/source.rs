//! The input, as far as the proof needs it: its edges.

/// Edges of a triangle mesh and the edges at each vertex, in flat arrays. Edges are numbered by their lower end, then by
/// their higher one, so that those to higher vertices lie side by side.
///
/// Memory: 12 bytes per edge and 8 per vertex; 24 per triangle more while it is made.
#[derive(Clone, Debug)]
pub struct SourceEdges {
    ends: Vec<[u32; 2]>,
    /// Where the edges that lead up from each vertex start in `ends`.
    first_up: Vec<u32>,
    /// Edges that lead down from each vertex, vertex by vertex.
    down: Vec<u32>,
    first_down: Vec<u32>,
}

impl SourceEdges {
    /// Edges of `triangles` over `n_vertices` vertices. O(n log valence).
    pub fn new(n_vertices: usize, triangles: impl Iterator<Item = [u32; 3]> + Clone) -> Self {
        let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
        let all = triangles.flat_map(sides);
        let mut highs = Groups::new(n_vertices, all.clone());
        let mut ends = Vec::with_capacity(all.count() / 2);
        let mut first_up = Vec::with_capacity(n_vertices + 1);
        first_up.push(0);
        for low in (0..).take(n_vertices) {
            let group = highs.group(low);
            group.sort_unstable();
            for &mut high in group {
                if ends.last() != Some(&[low, high]) {
                    ends.push([low, high]);
                }
            }
            first_up.push(index(ends.len()));
        }
        drop(highs);
        let n_edges = index(ends.len());
        let edges_by_high = (0..n_edges).rev().map(|edge| [ends[edge as usize][1], edge]);
        let Groups { members: down, first: first_down } = Groups::new(n_vertices, edges_by_high);
        Self { ends, first_up, down, first_down }
    }

    /// How many edges there are.
    pub fn n_edges(&self) -> usize {
        self.ends.len()
    }

    /// End vertices of `edge`, the lower one first.
    #[inline]
    pub fn ends(&self, edge: u32) -> [u32; 2] {
        self.ends[edge as usize]
    }

    /// Edges from `v` to higher vertices, each with its higher end, in ascending order.
    #[inline]
    pub fn up(&self, v: u32) -> impl Iterator<Item = (u32, u32)> {
        let (start, end) = (self.first_up[v as usize], self.first_up[v as usize + 1]);
        (start..end).zip(&self.ends[start as usize..end as usize]).map(|(edge, &[_, high])| (edge, high))
    }

    /// Edges from `v` to lower vertices, each with its lower end, in ascending order.
    #[inline]
    pub fn down(&self, v: u32) -> impl Iterator<Item = (u32, u32)> {
        let (start, end) = (self.first_down[v as usize], self.first_down[v as usize + 1]);
        self.down[start as usize..end as usize].iter().map(|&edge| (edge, self.ends[edge as usize][0]))
    }
}

/// The second numbers of pairs, grouped by the first, by counting; the last pair of a group comes first.
struct Groups {
    first: Vec<u32>,
    members: Vec<u32>,
}

impl Groups {
    fn new(n_groups: usize, pairs: impl Iterator<Item = [u32; 2]> + Clone) -> Self {
        let mut first = vec![0; n_groups + 1];
        pairs.clone().for_each(|[group, _]| first[group as usize] += 1);
        let mut end = 0;
        for count in &mut first {
            end += *count;
            *count = end;
        }
        // Each entry of `first` begins at the end of its group and ends at its start.
        let mut members = vec![0; end as usize];
        pairs.for_each(|[group, member]| {
            let at = &mut first[group as usize];
            *at -= 1;
            members[*at as usize] = member;
        });
        Self { first, members }
    }

    fn group(&mut self, group: u32) -> &mut [u32] {
        let group = group as usize;
        &mut self.members[self.first[group] as usize..self.first[group + 1] as usize]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a mesh of u32 vertices and triangles has u32 edges")]
fn index(at: usize) -> u32 {
    at as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn edges_are_listed_once_and_at_both_ends(triangles in prop::collection::vec(prop::array::uniform3(0_u32..9), 0..20)) {
            let edges = SourceEdges::new(9, triangles.iter().copied());
            let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let expected: BTreeSet<[u32; 2]> = sides.map(|[p, q]| [p.min(q), p.max(q)]).collect();
            prop_assert_eq!(edges.n_edges(), expected.len());
            prop_assert!((0..).map(|edge| edges.ends(edge)).take(expected.len()).eq(expected.iter().copied()));
            for v in 0..9 {
                let up: BTreeSet<_> = edges.up(v).map(|(edge, high)| { assert_eq!(edges.ends(edge), [v, high]); edge }).collect();
                let down: BTreeSet<_> = edges.down(v).map(|(edge, low)| { assert_eq!(edges.ends(edge), [low, v]); edge }).collect();
                prop_assert_eq!(up.len(), expected.iter().filter(|ends| ends[0] == v).count());
                prop_assert_eq!(down.len(), expected.iter().filter(|ends| ends[1] == v).count());
            }
        }
    }
}
