//! The input, as far as the proof needs it: its edges.

/// Edges of a triangle mesh and the edges at each vertex, in flat arrays.
#[derive(Clone, Debug)]
pub struct SourceEdges {
    ends: Vec<[u32; 2]>,
    first: Vec<u32>,
    incident: Vec<u32>,
}

impl SourceEdges {
    /// Edges of `triangles` over `n_vertices` vertices. O(n log n).
    pub fn new(n_vertices: usize, triangles: impl Iterator<Item = [u32; 3]>) -> Self {
        let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
        let mut ends: Vec<[u32; 2]> = triangles.flat_map(sides).collect();
        ends.sort_unstable();
        ends.dedup();
        ends.shrink_to_fit();
        let mut first = vec![0; n_vertices + 1];
        for &v in ends.as_flattened() {
            first[v as usize + 1] += 1;
        }
        for v in 0..n_vertices {
            first[v + 1] += first[v];
        }
        let mut next = first.clone();
        let mut incident = vec![0; 2 * ends.len()];
        for (edge, pair) in (0..).zip(&ends) {
            for &v in pair {
                incident[next[v as usize] as usize] = edge;
                next[v as usize] += 1;
            }
        }
        Self { ends, first, incident }
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

    /// Edges at vertex `v`, in ascending order.
    #[inline]
    pub fn at(&self, v: u32) -> &[u32] {
        &self.incident[self.first[v as usize] as usize..self.first[v as usize + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_listed_once_and_at_both_ends() {
        let edges = SourceEdges::new(5, [[0, 1, 2], [2, 1, 3]].into_iter());
        assert_eq!(edges.n_edges(), 5);
        let at = |v| edges.at(v).iter().map(|&e| edges.ends(e)).collect::<Vec<_>>();
        assert_eq!(at(1), [[0, 1], [1, 2], [1, 3]]);
        assert_eq!(at(3), [[1, 3], [2, 3]]);
        assert_eq!(at(4), [[0; 2]; 0]);
    }
}
