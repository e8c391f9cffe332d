//! The dual tree of a filling: triangles of a hole as nodes, inner edges between them as links.
//!
//! A triangulated polygon has no inner vertex, so its dual has no cycle, and between two of its
//! triangles runs exactly one path. That is what makes the image of a source edge across a hole a
//! matter of its two ends alone.

use crate::mesh::{Filling, Hole, MAX_VALENCE};

/// Most triangles of a filling.
const MAX_TRIANGLES: usize = MAX_VALENCE;

/// Parents and depths of a filling's triangles, rooted at triangle 0, and the triangle at each ring
/// edge.
#[derive(Clone, Debug)]
pub(crate) struct DualTree {
    parent: [u8; MAX_TRIANGLES],
    depth: [u8; MAX_TRIANGLES],
    /// Ring indices of the edge between a triangle and its parent.
    link: [[u8; 2]; MAX_TRIANGLES],
    at_ring_edge: [u8; MAX_TRIANGLES + 1],
}

impl Default for DualTree {
    fn default() -> Self {
        Self {
            parent: [0; MAX_TRIANGLES],
            depth: [0; MAX_TRIANGLES],
            link: [[0; 2]; MAX_TRIANGLES],
            at_ring_edge: [0; MAX_TRIANGLES + 1],
        }
    }
}

/// A step along a path: over this edge, given by ring indices, into that triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Crossing {
    /// Ring indices of the edge's ends.
    pub edge: [u8; 2],
    /// Index of the triangle behind it.
    pub into: u8,
}

impl DualTree {
    /// Makes this the dual tree of `filling`. O(n^2) for n triangles.
    #[expect(clippy::cast_possible_truncation, reason = "a filling has fewer than MAX_VALENCE triangles")]
    pub(crate) fn build(&mut self, hole: &Hole, filling: &Filling) {
        let n = filling.triangles.len();
        let mut reached = [false; MAX_TRIANGLES];
        let mut waiting = [0_u8; MAX_TRIANGLES];
        let mut n_waiting = 1;
        reached[0] = true;
        self.depth[0] = 0;
        while n_waiting > 0 {
            n_waiting -= 1;
            let at = waiting[n_waiting];
            for (other, is_reached) in reached.iter_mut().enumerate().take(n) {
                if *is_reached {
                    continue;
                }
                if let Some(edge) = shared_edge(filling.triangles[usize::from(at)], filling.triangles[other])
                {
                    *is_reached = true;
                    self.parent[other] = at;
                    self.depth[other] = self.depth[usize::from(at)] + 1;
                    self.link[other] = edge;
                    waiting[n_waiting] = other as u8;
                    n_waiting += 1;
                }
            }
        }
        for (t, &[a, b, c]) in (0_u8..).zip(&filling.triangles) {
            for [i, j] in [[a, b], [b, c], [c, a]] {
                if hole.next(i.into()) == usize::from(j) {
                    self.at_ring_edge[usize::from(i)] = t;
                }
            }
        }
    }

    /// The triangle at the edge from ring vertex `i` to the next; for the last one of a chain, at
    /// the new boundary edge.
    pub(crate) fn at_ring_edge(&self, i: usize) -> u8 {
        self.at_ring_edge[i]
    }

    /// A triangle at ring vertex `i`.
    pub(crate) fn at_ring_vertex(&self, i: u8) -> u8 {
        self.at_ring_edge[usize::from(i)]
    }

    /// Appends the crossings on the way from triangle `from` to triangle `to` to `path`.
    pub(crate) fn path(&self, from: u8, to: u8, path: &mut Vec<Crossing>) {
        let [depth, parent] = [&self.depth, &self.parent];
        let (mut up, mut down) = (from, to);
        // To where the ways from both to the root meet.
        while up != down {
            if depth[usize::from(up)] >= depth[usize::from(down)] {
                let into = parent[usize::from(up)];
                path.push(Crossing { edge: self.link[usize::from(up)], into });
                up = into;
            } else {
                down = parent[usize::from(down)];
            }
        }
        let n_up = path.len();
        down = to;
        while down != up {
            path.push(Crossing { edge: self.link[usize::from(down)], into: down });
            down = parent[usize::from(down)];
        }
        path[n_up..].reverse();
    }
}

/// The edge that two triangles have in common.
fn shared_edge(first: [u8; 3], second: [u8; 3]) -> Option<[u8; 2]> {
    let [a, b, c] = first;
    [[a, b], [b, c], [c, a]].into_iter().find(|edge| edge.iter().all(|corner| second.contains(corner)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A heptagon cut into a fan's half and a zigzag; triangle 0 in the middle of the dual.
    fn filling() -> (Hole, Filling) {
        let triangles = vec![[1, 3, 5], [1, 2, 3], [3, 4, 5], [0, 1, 5], [0, 5, 6]];
        let hole = Hole { closed: true, ring: (10..17).collect(), ..Hole::default() };
        (hole, Filling { triangles, n_first_part: 5, part_starts: [0; 2] })
    }

    #[test]
    fn paths_cross_one_shared_edge_after_another() {
        let (hole, filling) = filling();
        let mut tree = DualTree::default();
        tree.build(&hole, &filling);
        for from in 0..5 {
            for to in 0..5 {
                let mut path = vec![];
                tree.path(from, to, &mut path);
                let mut at = from;
                for Crossing { edge, into } in &path {
                    let (here, there) =
                        (filling.triangles[usize::from(at)], filling.triangles[usize::from(*into)]);
                    assert!(edge.iter().all(|corner| here.contains(corner) && there.contains(corner)));
                    at = *into;
                }
                assert_eq!(at, to);
            }
        }
        let mut path = vec![];
        tree.path(1, 4, &mut path);
        assert_eq!(path.iter().map(|c| c.into).collect::<Vec<_>>(), [0, 3, 4]);
    }

    #[test]
    fn ring_edges_know_their_triangle() {
        let (hole, filling) = filling();
        let mut tree = DualTree::default();
        tree.build(&hole, &filling);
        assert_eq!((0..7).map(|i| tree.at_ring_edge(i)).collect::<Vec<_>>(), [3, 1, 1, 2, 2, 4, 4]);
    }
}
