//! What is fused: the four points of a tetrahedron, or the two of an edge where no tetrahedron can
//! be fused any more.

use crate::flat::NO_INDEX;

/// Points that are to become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Prey {
    /// Padded with [`NO_INDEX`].
    points: [u32; 4],
    /// The vertices at the points: of the tetrahedron, or of one at the edge. Padded as well.
    vertices: [u32; 4],
    len: usize,
}

impl Prey {
    pub(super) fn tetrahedron(points: [u32; 4], vertices: [u32; 4]) -> Self {
        Self { points, vertices, len: 4 }
    }

    pub(super) fn edge(points: [u32; 2], vertices: [u32; 2]) -> Self {
        let padded = |[a, b]: [u32; 2]| [a, b, NO_INDEX, NO_INDEX];
        Self { points: padded(points), vertices: padded(vertices), len: 2 }
    }

    #[inline(always)]
    pub(super) fn points(&self) -> &[u32] {
        &self.points[..self.len]
    }

    #[inline(always)]
    pub(super) fn vertices(&self) -> &[u32] {
        &self.vertices[..self.len]
    }

    /// The vertex at one of the points.
    #[inline(always)]
    pub(super) fn vertex(&self, point: u32) -> u32 {
        self.points().iter().position(|&p| p == point).map_or(point, |at| self.vertices[at])
    }

    #[inline(always)]
    pub(super) fn contains(&self, point: u32) -> bool {
        let [a, b, c, d] = self.points;
        // Without branches: this is asked of every corner of every tetrahedron around.
        (point == a) | (point == b) | (point == c) | (point == d)
    }

    /// Bit `i` for each corner `i` that is among the points.
    #[inline(always)]
    pub(super) fn corners_in(&self, corners: [u32; 4]) -> u32 {
        let [a, b, c, d] = corners.map(|v| u32::from(self.contains(v)));
        a | b << 1 | c << 2 | d << 3
    }
}
