//! What of the input is mapped into each triangle of the current mesh.
//!
//! A removal reads the contents of the star's slots and writes those of the filling's; in between
//! nothing changes but that a chain may be shortened where it no longer needs a triangle. So the
//! contents of a slot are written once, side by side, and an edge may be listed in a slot that its
//! chain has left since: readers look at the chain.

use super::records::{HEADER, Records};
use crate::mesh::Renumbering;

/// Words that the contents of a scanned mesh take at most, gaps included, for each triangle of the
/// input: 3 to 3.5.
const USUAL_WORDS: usize = 3;

/// Source vertices in each slot, and source edges whose chain has a portion there: records of
/// slots, which are the number of vertices, the vertices and the edges.
#[derive(Clone, Debug)]
pub(crate) struct Contents(Records);

impl Contents {
    /// Nothing, in any of `n_slots` slots.
    pub(crate) fn new(n_slots: usize) -> Self {
        Self(Records::new(n_slots, USUAL_WORDS * n_slots))
    }

    /// Source vertices whose image is in the triangle in `slot`.
    #[inline]
    pub(crate) fn vertices(&self, slot: u32) -> &[u32] {
        self.of(slot).0
    }

    /// Source edges that had a portion in the triangle in `slot` when it was born, each once.
    #[inline]
    pub(crate) fn edges(&self, slot: u32) -> &[u32] {
        self.of(slot).1
    }

    /// Words that all contents take.
    #[inline]
    pub(crate) fn n_words(&self) -> usize {
        self.0.n_words()
    }

    /// Words that the contents of so many slots take, with so many vertices and edges in all.
    #[inline]
    pub(crate) fn n_words_of(n_slots: usize, n_mapped: usize) -> usize {
        (HEADER + 1) * n_slots + n_mapped
    }

    /// Empties `slot`.
    pub(crate) fn clear(&mut self, slot: u32) {
        self.0.clear(slot);
    }

    /// Fills `slot` with as many vertices and edges as the iterators tell.
    #[expect(clippy::cast_possible_truncation, reason = "words are at most MAX_PLACES")]
    pub(crate) fn fill(
        &mut self,
        slot: u32,
        vertices: impl ExactSizeIterator<Item = u32>,
        edges: impl ExactSizeIterator<Item = u32>,
    ) {
        let (n_vertices, n_edges) = (vertices.len(), edges.len());
        if n_vertices + n_edges > 0 {
            let words = std::iter::once(n_vertices as u32).chain(vertices).chain(edges);
            self.0.set(slot, 1 + n_vertices + n_edges, words);
        }
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        self.0.renumber(slots);
    }

    /// Whether there is enough memory that former contents left behind to give it back.
    pub(crate) fn has_gaps(&self) -> bool {
        self.0.has_gaps()
    }

    /// Gives back memory that former contents left behind. O(words).
    pub(crate) fn close_up(&mut self) {
        self.0.close_up();
    }

    #[inline]
    fn of(&self, slot: u32) -> (&[u32], &[u32]) {
        match self.0.of(slot) {
            [n_vertices, rest @ ..] => rest.split_at(*n_vertices as usize),
            [] => (&[], &[]),
        }
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
                    contents.close_up();
                }
            }
            for (slot, (vertices, edges)) in (0..).zip(&lists) {
                prop_assert_eq!(contents.vertices(slot), vertices.as_slice());
                prop_assert_eq!(contents.edges(slot), edges.as_slice());
            }
        }
    }
}
