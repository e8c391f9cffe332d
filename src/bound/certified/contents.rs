//! What of the input is mapped into each triangle of the current mesh.
//!
//! A removal reads the contents of the star's slots and writes those of the filling's; in between nothing changes but that
//! a chain may be shortened where it no longer needs a triangle. So the contents of a slot are written once, side by side, and an
//! edge may be listed in a slot that its chain has left since: whoever reads asks the chain.

/// Nothing in the slot.
const NONE: u32 = u32::MAX;

/// Source vertices in each slot, and source edges whose chain has a portion there.
///
/// Memory: 4 bytes per slot, 4 per vertex, edge through a slot and slot in use twice, and half as much again in gaps at most.
#[derive(Clone, Debug)]
pub struct Contents {
    /// Where the record of each slot starts in `words`.
    first: Vec<u32>,
    /// Records: the number of vertices, the number of edges, the vertices, the edges.
    words: Vec<u32>,
    n_used: usize,
}

impl Contents {
    /// Nothing, in any of `n_slots` slots.
    pub fn new(n_slots: usize) -> Self {
        Self { first: vec![NONE; n_slots], words: vec![], n_used: 0 }
    }

    /// Source vertices whose image is in the triangle in `slot`.
    #[inline]
    pub fn vertices(&self, slot: u32) -> &[u32] {
        match self.words.get(self.first[slot as usize] as usize..) {
            Some([n_vertices, _, rest @ ..]) => &rest[..*n_vertices as usize],
            _ => &[],
        }
    }

    /// Source edges that had a portion in the triangle in `slot` when it was born, each once.
    #[inline]
    pub fn edges(&self, slot: u32) -> &[u32] {
        match self.words.get(self.first[slot as usize] as usize..) {
            Some([n_vertices, n_edges, rest @ ..]) => &rest[*n_vertices as usize..][..*n_edges as usize],
            _ => &[],
        }
    }

    /// Entries of the pool, gaps included: at most [`MAX_PLACES`](crate::mesh::MAX_PLACES), which whoever fills slots sees to. A slot
    /// takes two more than it has vertices and edges.
    #[inline]
    pub fn n_entries(&self) -> usize {
        self.words.len()
    }

    /// Empties `slot`.
    pub fn clear(&mut self, slot: u32) {
        if self.first[slot as usize] != NONE {
            self.n_used -= self.record(slot).len();
            self.first[slot as usize] = NONE;
        }
    }

    /// Fills `slot`, which is empty.
    #[expect(clippy::cast_possible_truncation, reason = "entries are at most MAX_PLACES")]
    pub fn fill(&mut self, slot: u32, vertices: impl Iterator<Item = u32>, edges: impl Iterator<Item = u32>) {
        let start = self.words.len();
        self.words.extend([0; 2]);
        self.words.extend(vertices);
        let n_vertices = self.words.len() - start - 2;
        self.words.extend(edges);
        let n_edges = self.words.len() - start - 2 - n_vertices;
        if n_vertices + n_edges == 0 {
            self.words.truncate(start);
            return;
        }
        self.words[start] = n_vertices as u32;
        self.words[start + 1] = n_edges as u32;
        self.first[slot as usize] = start as u32;
        self.n_used += self.words.len() - start;
    }

    /// Closes the gaps once they make up a third of the memory, with the records in the order of their slots. O(slots) when it
    /// works, O(1) otherwise.
    #[expect(clippy::cast_possible_truncation, reason = "not more than before")]
    pub fn compact(&mut self) {
        if self.words.len() < self.n_used + self.n_used / 2 + 1024 {
            return;
        }
        let mut words = Vec::with_capacity(self.n_used + self.n_used / 2 + 1024);
        for slot in 0..self.first.len() {
            if self.first[slot] != NONE {
                let start = words.len() as u32;
                words.extend_from_slice(self.record(slot as u32));
                self.first[slot] = start;
            }
        }
        self.words = words;
    }

    fn record(&self, slot: u32) -> &[u32] {
        let n_words = 2 + self.vertices(slot).len() + self.edges(slot).len();
        &self.words[self.first[slot as usize] as usize..][..n_words]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn contents_agree_with_lists(
            fillings in prop::collection::vec(
                (0_u32..5, prop::collection::vec(any::<u32>(), 0..90), prop::collection::vec(any::<u32>(), 0..90)), 0..60)
        ) {
            let mut contents = Contents::new(5);
            let mut lists = vec![(vec![], vec![]); 5];
            for (at, (slot, vertices, edges)) in fillings.into_iter().enumerate() {
                contents.clear(slot);
                prop_assert!(contents.vertices(slot).is_empty() && contents.edges(slot).is_empty());
                contents.fill(slot, vertices.iter().copied(), edges.iter().copied());
                lists[slot as usize] = (vertices, edges);
                if at % 4 == 3 {
                    contents.compact();
                }
            }
            for (slot, (vertices, edges)) in (0..).zip(&lists) {
                prop_assert_eq!(contents.vertices(slot), vertices.as_slice());
                prop_assert_eq!(contents.edges(slot), edges.as_slice());
            }
        }
    }
}
