//! Through which triangles of the current mesh the image of each source edge runs.
//!
//! A *chain* is a source edge cut into *portions*, each with the slot of the triangle that it is mapped into. Most edges
//! need none: both ends belong to one triangle and so does all between. The others are written down here, the portions of
//! an edge side by side. Lists linked through the portions would never need room elsewhere, but following them
//! was a third of the build, waiting for memory; here a chain that changes is written anew behind the others, and
//! [`Chains::compact`] closes the gaps.

/// No chain.
const NONE: u32 = u32::MAX;

/// A portion of a source edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Portion {
    /// The triangle it is mapped into.
    pub slot: u32,
    /// Where it ends, as a part of the edge from its lower to its higher vertex; where the next one starts.
    pub end: f32,
}

/// The chains of two portions and more.
///
/// Memory: 4 bytes per edge, 8 per portion and 8 per chain, and half as much again in gaps at most.
#[derive(Clone, Debug)]
pub struct Chains {
    /// Where the chain of each edge starts in `portions`.
    first: Vec<u32>,
    /// Chain after chain. Before each stands one entry whose slot is the number of its portions.
    portions: Vec<Portion>,
    n_used: usize,
}

impl Chains {
    /// No chain, for any of `n_edges` edges.
    pub fn new(n_edges: usize) -> Self {
        Self { first: vec![NONE; n_edges], portions: vec![], n_used: 0 }
    }

    /// Whether `edge` has a chain.
    #[inline]
    pub fn has(&self, edge: u32) -> bool {
        self.first[edge as usize] != NONE
    }

    /// Portions of `edge` in order; none where the whole edge is one portion.
    #[inline]
    pub fn of(&self, edge: u32) -> &[Portion] {
        match self.portions.get(self.first[edge as usize] as usize..) {
            Some([length, portions @ ..]) => &portions[..length.slot as usize],
            _ => &[],
        }
    }

    /// Changes whenever the chain of `edge` does, until the next [`Self::compact`].
    #[inline]
    pub fn version(&self, edge: u32) -> u32 {
        self.first[edge as usize]
    }

    /// Entries of the pool, gaps included: at most [`MAX_PLACES`](crate::mesh::MAX_PLACES), which whoever sets chains sees to. A chain
    /// takes one more than it has portions.
    #[inline]
    pub fn n_entries(&self) -> usize {
        self.portions.len()
    }

    /// Replaces the chain of `edge` by `portions`; fewer than two portions need no chain. O(portions).
    #[expect(clippy::cast_possible_truncation, reason = "entries are at most MAX_PLACES")]
    pub fn set(&mut self, edge: u32, portions: &[Portion]) {
        if self.has(edge) {
            self.n_used -= self.of(edge).len() + 1;
        }
        if portions.len() < 2 {
            self.first[edge as usize] = NONE;
            return;
        }
        self.first[edge as usize] = self.portions.len() as u32;
        self.portions.push(Portion { slot: portions.len() as u32, end: 0.0 });
        self.portions.extend_from_slice(portions);
        self.n_used += portions.len() + 1;
    }

    /// Closes the gaps once they make up a third of the memory, with the chains in the order of their edges. O(edges) when it
    /// works, O(1) otherwise.
    #[expect(clippy::cast_possible_truncation, reason = "not more than before")]
    pub fn compact(&mut self) {
        if self.portions.len() < self.n_used + self.n_used / 2 + 1024 {
            return;
        }
        let mut portions = Vec::with_capacity(self.n_used + self.n_used / 2 + 1024);
        for first in self.first.iter_mut().filter(|first| **first != NONE) {
            let start = *first as usize;
            *first = portions.len() as u32;
            portions.extend_from_slice(&self.portions[start..=start + self.portions[start].slot as usize]);
        }
        self.portions = portions;
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
                let before = chains.version(edge);
                chains.set(edge, &portions);
                prop_assert!(portions.len() < 2 || chains.version(edge) != before);
                map.insert(edge, if portions.len() < 2 { vec![] } else { portions });
                if at % 4 == 3 {
                    chains.compact();
                    let n_used: usize = map.values().filter(|chain| !chain.is_empty()).map(|chain| chain.len() + 1).sum();
                    prop_assert!(chains.portions.len() < n_used + n_used / 2 + 1024);
                }
            }
            for (&edge, portions) in &map {
                prop_assert_eq!(chains.of(edge), portions.as_slice());
                prop_assert_eq!(chains.has(edge), !portions.is_empty());
            }
        }
    }
}
