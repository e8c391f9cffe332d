//! Vertices that stay: they are neither removed nor moved, and no new edge joins two of them.
//!
//! The border between two meshes that meet stays the same at all levels of both if its vertices are
//! locked on either side: a new edge between two of them could pass by a third.

/// A bit per vertex; none is locked where there is no bit.
#[derive(Clone, Debug, Default)]
pub(crate) struct Locked {
    bits: Vec<u64>,
}

impl Locked {
    /// The vertices on the boundary: those with an edge that has one triangle. O(n log n).
    pub(crate) fn boundary_of(n_vertices: usize, triangles: impl Iterator<Item = [u32; 3]>) -> Self {
        let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
        let mut edges: Vec<[u32; 2]> = triangles.flat_map(sides).collect();
        edges.sort_unstable();
        let mut locked = Self { bits: vec![0; n_vertices.div_ceil(64)] };
        let of_one = edges.chunk_by(|a, b| a == b).filter(|faces| faces.len() == 1);
        of_one.flatten().flatten().for_each(|&v| locked.bits[v as usize / 64] |= 1 << (v % 64));
        locked
    }

    /// Whether no vertex is locked.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.bits.is_empty()
    }

    /// Whether vertex `v` is locked.
    #[inline]
    pub(crate) fn has(&self, v: u32) -> bool {
        self.bits.get(v as usize / 64).is_some_and(|bits| bits >> (v % 64) & 1 == 1)
    }

    /// Whether both ends of an edge are locked.
    #[inline]
    pub(crate) fn has_both(&self, [a, b]: [u32; 2]) -> bool {
        self.has(a) && self.has(b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_of_edges_with_one_triangle_are_locked() {
        // Two triangles side by side, a third on their common edge, and a closed tetrahedron.
        let triangles = [[0, 1, 2], [2, 1, 3], [1, 2, 70], [4, 5, 6], [4, 6, 7], [4, 7, 5], [5, 7, 6]];
        let locked = Locked::boundary_of(80, triangles.into_iter());
        let found: Vec<u32> = (0..200).filter(|&v| locked.has(v)).collect();
        assert_eq!(found, [0, 1, 2, 3, 70]);
        assert!(locked.has_both([0, 70]) && !locked.has_both([0, 4]) && !Locked::default().has(0));
    }
}
