//! Records of words, side by side in one pool, each found by its owner.
//!
//! A list per owner would cost an allocation each, and lists linked through their members scatter
//! over memory: following them was a third of the build. Here a record that changes is written anew
//! behind the others, and [`Records::close_up`] closes the gaps where they are, without a second
//! pool. What changed together then lies together.

use crate::flat::NO_INDEX;
use crate::mesh::Renumbering;

/// Words before each record: its owner and its length.
pub(super) const HEADER: usize = 2;

/// At most one record of words for each of so many owners.
///
/// Memory: 4 bytes per owner and word, 8 per record, and a third as much again in gaps at most.
#[derive(Clone, Debug)]
pub(super) struct Records {
    /// Where the record of each owner starts in `words`.
    first: Vec<u32>,
    /// Record after record, those without an owner included.
    words: Vec<u32>,
    /// Words of the records with an owner, and of their headers.
    n_used: usize,
    /// Most words since memory was last given back.
    n_touched: usize,
}

impl Records {
    /// No record, for any of `n_owners` owners, and room for `n_words`: memory that is not touched
    /// before it is needed, and that a pool which grew as it goes would leave behind in pieces.
    pub(super) fn new(n_owners: usize, n_words: usize) -> Self {
        Self { first: vec![NO_INDEX; n_owners], words: Vec::with_capacity(n_words), n_used: 0, n_touched: 0 }
    }

    /// Whether `owner` has a record.
    #[inline]
    pub(super) fn has(&self, owner: u32) -> bool {
        self.first[owner as usize] != NO_INDEX
    }

    /// The record of `owner`; empty if there is none.
    #[inline]
    pub(super) fn of(&self, owner: u32) -> &[u32] {
        match self.words.get(self.first[owner as usize] as usize..) {
            Some([_, n_words, rest @ ..]) => &rest[..*n_words as usize],
            _ => &[],
        }
    }

    /// Words of the pool, gaps and headers included: at most
    /// `MAX_PLACES`, which writers check.
    #[inline]
    pub(super) fn n_words(&self) -> usize {
        self.words.len()
    }

    /// Drops the record of `owner`, if it has one. O(1).
    pub(super) fn clear(&mut self, owner: u32) {
        let first = std::mem::replace(&mut self.first[owner as usize], NO_INDEX);
        if let Some([owner, n_words, ..]) = self.words.get_mut(first as usize..) {
            *owner = NO_INDEX;
            self.n_used -= HEADER + *n_words as usize;
        }
    }

    /// Makes `words`, which are `n_words` and at least one, the record of `owner`. O(words).
    #[expect(clippy::cast_possible_truncation, reason = "words are at most MAX_PLACES")]
    pub(super) fn set(&mut self, owner: u32, n_words: usize, words: impl Iterator<Item = u32>) {
        self.clear(owner);
        self.make_room(HEADER + n_words);
        self.first[owner as usize] = self.words.len() as u32;
        self.words.extend([owner, n_words as u32]);
        self.words.extend(words);
        self.n_used += HEADER + n_words;
    }

    /// Whether the gaps make up a fifth of the pool. O(1).
    pub(super) fn has_gaps(&self) -> bool {
        self.words.len() >= self.n_used + self.n_used / 4 + 1024
    }

    /// Closes the gaps; the records keep their order. O(words).
    #[expect(clippy::cast_possible_truncation, reason = "not more than before")]
    pub(super) fn close_up(&mut self) {
        self.n_touched = self.n_touched.max(self.words.len());
        let (mut from, mut to) = (0, 0);
        while from < self.words.len() {
            // Most records lie side by side with others that stay: those are moved together.
            let start = from;
            while let Some(&[owner, n_words, ..]) = self.words.get(from..)
                && owner != NO_INDEX
            {
                self.first[owner as usize] = (to + from - start) as u32;
                from += HEADER + n_words as usize;
            }
            self.words.copy_within(start..from, to);
            to += from - start;
            while let Some(&[NO_INDEX, n_words, ..]) = self.words.get(from..) {
                from += HEADER + n_words as usize;
            }
        }
        self.words.truncate(to);
        if self.n_touched > 2 * to {
            self.words.shrink_to(to + to / 4 + 1024);
            self.n_touched = to;
        }
    }

    /// Gives every owner its new number.
    pub(super) fn renumber(&mut self, owners: &Renumbering) {
        owners.close_up(&mut self.first);
        let mut at = 0;
        while let Some([owner, n_words, ..]) = self.words.get_mut(at..) {
            if *owner != NO_INDEX {
                *owner = owners.place(*owner);
            }
            at += HEADER + *n_words as usize;
        }
    }

    /// Shows `take` every record.
    pub(super) fn for_each_mut(&mut self, mut take: impl FnMut(&mut [u32])) {
        let mut rest = self.words.as_mut_slice();
        while let [owner, n_words, behind @ ..] = rest {
            let (record, behind) = behind.split_at_mut(*n_words as usize);
            if *owner != NO_INDEX {
                take(record);
            }
            rest = behind;
        }
    }

    /// Room for a sixteenth more where there is too little: less than a `Vec` takes by itself.
    fn make_room(&mut self, n_words: usize) {
        if self.words.capacity() - self.words.len() < n_words {
            self.words.reserve_exact(n_words + self.words.len() / 16);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn records_agree_with_a_map(
            settings in prop::collection::vec((0_u32..8, prop::collection::vec(any::<u32>(), 0..300)), 0..60)
        ) {
            let mut records = Records::new(8, 0);
            let mut map: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
            for (at, (owner, words)) in settings.into_iter().enumerate() {
                if words.is_empty() {
                    records.clear(owner);
                } else {
                    records.set(owner, words.len(), words.iter().copied());
                }
                map.insert(owner, words);
                if at % 4 == 3 {
                    let n_used: usize = map.values().filter(|words| !words.is_empty()).map(|words| words.len() + HEADER).sum();
                    prop_assert_eq!(records.has_gaps(), records.n_words() >= n_used + n_used / 4 + 1024);
                    records.close_up();
                    prop_assert_eq!(records.n_words(), n_used);
                }
            }
            for (&owner, words) in &map {
                prop_assert_eq!(records.of(owner), words.as_slice());
                prop_assert_eq!(records.has(owner), !words.is_empty());
            }
        }
    }
}
