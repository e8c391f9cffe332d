//! The mesh as it grows while a stream is written or read. Writer and reader each keep one, so that
//! a triangle can be named by its place in a star.

use crate::mesh::Stars;
use std::ops::Range;

/// Number of triangles that a stream may move in any case, and additional number for each of its
/// operations. Usual operations move a handful. Without a limit, a stream could move a large star
/// again and again with a few bits each time.
const MOVED_ALWAYS: usize = 1 << 20;
const MOVED_PER_OPERATION: usize = 256;

/// Most neighbours that a link can name: one byte says which, and its last value means none of
/// them.
const MAX_LINK_LEN: usize = u8::MAX as usize;

/// What an operation does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum GrowthKind {
    /// A new vertex takes triangles from an old one, and new triangles appear.
    #[default]
    EdgeSplit,
    /// A vertex is merged into another one.
    VertexMerge,
    /// One triangle appears.
    Triangle,
}

/// One operation, in the order of growth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct GrowthStep {
    pub(super) kind: GrowthKind,
    /// The vertex that appears or disappears.
    pub(super) vertex: u32,
    /// The vertex beside which that happens; the vertex itself for a triangle.
    pub(super) beside: u32,
    moved_start: u32,
    n_moved: u32,
    /// Triangles that appear.
    pub(super) n_triangles: u32,
    /// Vertices that appear.
    pub(super) n_vertices: u32,
}

impl GrowthStep {
    /// Range in [`Growth::moved`] of the triangles that change a corner.
    pub(super) fn moved_range(&self) -> Range<usize> {
        self.moved_start as usize..(self.moved_start + self.n_moved) as usize
    }
}

/// All operations so far, resolved, and the mesh that they lead to.
#[derive(Clone, Debug, Default)]
pub(super) struct Growth {
    pub(super) operations: Vec<GrowthStep>,
    /// Triangles that change a corner, operation by operation.
    pub(super) moved: Vec<u32>,
    /// Every triangle with the corners that it appears with.
    pub(super) born: Vec<[u32; 3]>,
    /// Triangles after each operation, never falling.
    pub(super) n_triangles: Vec<u32>,
    pub(super) n_vertices: u32,
    triangles: Vec<[u32; 3]>,
    stars: Stars,
}

impl Growth {
    /// Triangles at a vertex, in an order that writer and reader share.
    pub(super) fn star(&self, v: u32) -> &[u32] {
        self.stars.of(v)
    }

    /// Corners of a triangle now.
    pub(super) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize]
    }

    /// Whether the next operation may move this many triangles more.
    pub(super) fn may_move(&self, n_triangles: usize) -> bool {
        let limit = MOVED_ALWAYS.saturating_add(MOVED_PER_OPERATION * (self.operations.len() + 1));
        self.moved.len().saturating_add(n_triangles) <= limit
    }

    /// Puts the first neighbours of `v` into `link`, in the order in which its star names them, as
    /// many as a byte can name.
    pub(super) fn link(&self, v: u32, link: &mut Vec<u32>) {
        link.clear();
        for &triangle in self.star(v) {
            if link.len() >= MAX_LINK_LEN {
                break;
            }
            for corner in self.corners(triangle) {
                if corner != v && !link.contains(&corner) {
                    link.push(corner);
                }
            }
        }
    }

    /// A new vertex takes the triangles `moved` from `beside`; the triangles `born` appear, over
    /// `n_vertices` new vertices in all.
    pub(super) fn edge_split(&mut self, beside: u32, moved: &[u32], born: &[[u32; 3]], n_vertices: u32) {
        let vertex = self.n_vertices;
        self.grow(n_vertices);
        self.give(beside, vertex, moved);
        self.bear(born);
        self.push(
            GrowthStep { kind: GrowthKind::EdgeSplit, vertex, beside, n_vertices, ..GrowthStep::default() },
            moved,
            born,
        );
    }

    /// All triangles of `vertex` get the corner `beside` instead.
    pub(super) fn vertex_merge(&mut self, vertex: u32, beside: u32) {
        let moved = self.star(vertex).to_vec();
        self.give(vertex, beside, &moved);
        self.push(
            GrowthStep { kind: GrowthKind::VertexMerge, vertex, beside, ..GrowthStep::default() },
            &moved,
            &[],
        );
    }

    /// One triangle appears, with `n_vertices` new vertices.
    pub(super) fn triangle(&mut self, born: [u32; 3], n_vertices: u32) {
        self.grow(n_vertices);
        self.bear(&[born]);
        let [vertex, ..] = born;
        let operation = GrowthStep {
            kind: GrowthKind::Triangle,
            vertex,
            beside: vertex,
            n_vertices,
            ..GrowthStep::default()
        };
        self.push(operation, &[], &[born]);
    }

    fn grow(&mut self, n_vertices: u32) {
        (0..n_vertices).for_each(|_| {
            self.stars.add_vertex();
        });
        self.n_vertices += n_vertices;
    }

    fn give(&mut self, from: u32, to: u32, moved: &[u32]) {
        for &triangle in moved {
            let corners = &mut self.triangles[triangle as usize];
            *corners = corners.map(|v| if v == from { to } else { v });
            self.stars.add(to, triangle);
            self.stars.remove(from, triangle);
        }
        self.stars.compact(self.triangles.len());
    }

    fn bear(&mut self, born: &[[u32; 3]]) {
        for &triangle in born {
            let index = count(self.triangles.len());
            self.triangles.push(triangle);
            triangle.into_iter().for_each(|v| self.stars.add(v, index));
        }
    }

    fn push(&mut self, operation: GrowthStep, moved: &[u32], born: &[[u32; 3]]) {
        let moved_start = count(self.moved.len());
        self.moved.extend_from_slice(moved);
        self.born.extend_from_slice(born);
        self.n_triangles.push(count(self.triangles.len()));
        let (n_moved, n_triangles) = (count(moved.len()), count(born.len()));
        self.operations.push(GrowthStep { moved_start, n_moved, n_triangles, ..operation });
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the decoder refuses streams that name more than u32 counts"
)]
fn count(len: usize) -> u32 {
    len as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_star_is_not_merged_for_ever() {
        let mut growth = Growth::default();
        growth.triangle([0, 1, 2], 4);
        for _ in 0..3000 {
            growth.triangle([0, 1, 2], 0);
        }
        let mut ends = [0, 3];
        while growth.may_move(growth.star(ends[0]).len()) {
            growth.vertex_merge(ends[0], ends[1]);
            ends.reverse();
        }
        let limit = MOVED_ALWAYS + MOVED_PER_OPERATION * (growth.operations.len() + 1);
        assert!(growth.moved.len() <= limit && growth.moved.len() + 3001 > limit);
    }

    #[test]
    fn a_link_is_no_longer_than_a_byte_can_name() {
        let mut growth = Growth::default();
        growth.triangle([0, 1, 2], 3);
        for v in 3..100_000 {
            growth.triangle([0, v - 1, v], 1);
        }
        let mut link = Vec::new();
        growth.link(0, &mut link);
        assert!((255..=257).contains(&link.len()) && link[..4] == [1, 2, 3, 4]);
    }
}
