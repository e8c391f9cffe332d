//! Through which triangles of the current mesh the image of each source edge runs.
//!
//! A *chain* is a source edge cut into *portions*, each with the slot of the triangle that it is
//! mapped into. Between two portions is a *crossing*, where the image passes over a mesh edge. Most
//! edges need no chain: both ends belong to one triangle, and so does all between them. The others
//! are written down here.
//!
//! ```text
//!          source edge                              b-----------d
//!                                                  / \         / \
//!   low        p    q         high                /   \  s1   /   \
//!    o---------x----x----------o                 / s0  \     /  s2 \
//!    portion 0   1    portion 2                 / o-----p'--q'---o  \
//!    slot s0    s1    slot s2                  /         \ /         \
//!    end p      q     end 1                   a-----------c-----------e
//!
//! p, q     crossings: points of the source edge, stored as parts of it in `Portion::end`
//! p', q'   their images: the point of the mesh edge b c nearest to p, and of c d nearest to q
//! ```

use super::records::{HEADER, Records};
use crate::mesh::Renumbering;

/// A portion of a source edge.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Portion {
    /// The triangle it is mapped into.
    pub slot: u32,
    /// Where it ends, as a part of the edge from its lower to its higher vertex; where the next one
    /// starts.
    pub end: f32,
}

/// Words that the chains of a scanned mesh take at most, gaps included, for each edge of the input:
/// 3.5 to 4.
const USUAL_WORDS: usize = 4;

/// Words that a portion takes.
const WORDS: usize = 2;

/// The chains of two portions and more: records of edges.
#[derive(Clone, Debug)]
pub(crate) struct Chains(Records);

impl Chains {
    /// No chain, for any of `n_edges` edges.
    pub(crate) fn new(n_edges: usize) -> Self {
        Self(Records::new(n_edges, USUAL_WORDS * n_edges))
    }

    /// Whether `edge` has a chain.
    #[inline]
    pub(crate) fn has(&self, edge: u32) -> bool {
        self.0.has(edge)
    }

    /// Portions of `edge` in order; empty if the whole edge is one portion.
    #[inline]
    pub(crate) fn of(&self, edge: u32) -> &[Portion] {
        bytemuck::cast_slice(self.0.of(edge))
    }

    /// Words that all chains take.
    #[inline]
    pub(crate) fn n_words(&self) -> usize {
        self.0.n_words()
    }

    /// Words that so many chains of so many portions take at most.
    #[inline]
    pub(crate) fn n_words_of(n_chains: usize, n_portions: usize) -> usize {
        HEADER * n_chains + WORDS * n_portions
    }

    /// Replaces the chain of `edge` by `portions`; fewer than two portions need no chain.
    /// O(portions).
    pub(crate) fn set(&mut self, edge: u32, portions: &[Portion]) {
        if portions.len() < 2 {
            self.0.clear(edge);
        } else {
            self.0.set(edge, WORDS * portions.len(), bytemuck::cast_slice(portions).iter().copied());
        }
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        self.0.for_each_mut(|words| {
            for portion in bytemuck::cast_slice_mut::<u32, Portion>(words) {
                portion.slot = slots.place(portion.slot);
            }
        });
    }

    /// Whether there is enough memory that former chains left behind to give it back.
    pub(crate) fn has_gaps(&self) -> bool {
        self.0.has_gaps()
    }

    /// Gives back memory that former chains left behind. O(words).
    pub(crate) fn close_up(&mut self) {
        self.0.close_up();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn chains_agree_with_a_map(
            settings in prop::collection::vec((0_u32..8, prop::collection::vec(0_u32..6, 0..200)), 0..60)
        ) {
            let mut chains = Chains::new(8);
            let mut map: BTreeMap<u32, Vec<Portion>> = BTreeMap::new();
            for (at, (edge, slots)) in settings.into_iter().enumerate() {
                let portions: Vec<Portion> = slots.iter().map(|&slot| Portion { slot, end: slot as f32 }).collect();
                chains.set(edge, &portions);
                map.insert(edge, if portions.len() < 2 { vec![] } else { portions });
                if at % 4 == 3 {
                    chains.close_up();
                    let taken = map.values().filter(|chain| !chain.is_empty());
                    let n_used: usize = taken.map(|chain| Chains::n_words_of(1, chain.len())).sum();
                    prop_assert_eq!(chains.n_words(), n_used);
                }
            }
            for (&edge, portions) in &map {
                prop_assert_eq!(chains.of(edge), portions.as_slice());
                prop_assert_eq!(chains.has(edge), !portions.is_empty());
            }
        }
    }
}
