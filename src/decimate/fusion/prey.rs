//! What is fused: the four vertices of a tetrahedron, or the two of an edge where no tetrahedron can be fused any more.

use crate::flat::NO_INDEX;

/// Vertices that are to become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Prey {
    /// Padded with [`NO_INDEX`].
    vertices: [u32; 4],
    len: usize,
}

impl Prey {
    pub(super) fn tetrahedron(vertices: [u32; 4]) -> Self {
        Self { vertices, len: 4 }
    }

    pub(super) fn edge([a, b]: [u32; 2]) -> Self {
        Self { vertices: [a, b, NO_INDEX, NO_INDEX], len: 2 }
    }

    #[inline(always)]
    pub(super) fn vertices(&self) -> &[u32] {
        &self.vertices[..self.len]
    }

    #[inline(always)]
    pub(super) fn contains(&self, v: u32) -> bool {
        let [a, b, c, d] = self.vertices;
        // Without branches: this is asked of every corner of every tetrahedron around.
        (v == a) | (v == b) | (v == c) | (v == d)
    }

    /// Bit `i` for each corner `i` that is among the vertices.
    #[inline(always)]
    pub(super) fn corners_in(&self, corners: [u32; 4]) -> u32 {
        let [a, b, c, d] = corners.map(|v| u32::from(self.contains(v)));
        a | b << 1 | c << 2 | d << 3
    }
}
