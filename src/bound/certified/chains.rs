//! Through which triangles of the current mesh the image of each source edge runs.
//!
//! A *chain* is a source edge cut into *portions*, each with the slot of the triangle that it is mapped into. Most edges
//! need none: both ends belong to one triangle and so does all between. Only the others are written down here, as
//! records linked along the edge, and linked within the slot so that a hole finds what runs through it.

/// No record.
const NONE: u32 = u32::MAX;

/// A portion of a source edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Portion {
    /// The triangle it is mapped into.
    pub slot: u32,
    /// Where it ends, as a part of the edge from its lower to its higher vertex; where the next one starts.
    pub end: f32,
}

#[derive(Clone, Copy, Debug)]
struct Record {
    edge: u32,
    portion: Portion,
    next: u32,
    next_in_slot: u32,
    previous_in_slot: u32,
}

/// The chains of two portions and more.
#[derive(Clone, Debug)]
pub struct Chains {
    first: Vec<u32>,
    first_in_slot: Vec<u32>,
    records: Vec<Record>,
    free: u32,
}

impl Chains {
    /// No chain, for any of `n_edges` edges through `n_slots` slots.
    pub fn new(n_edges: usize, n_slots: usize) -> Self {
        Self { first: vec![NONE; n_edges], first_in_slot: vec![NONE; n_slots], records: vec![], free: NONE }
    }

    /// Whether `edge` has a chain.
    #[inline]
    pub fn has(&self, edge: u32) -> bool {
        self.first[edge as usize] != NONE
    }

    /// Portions of `edge` in order; none where the whole edge is one portion.
    pub fn of(&self, edge: u32) -> impl Iterator<Item = Portion> + '_ {
        self.follow(self.first[edge as usize], |record| record.next).map(|record| record.portion)
    }

    /// Edges with a portion in `slot`, one entry per portion.
    pub fn edges_through(&self, slot: u32) -> impl Iterator<Item = u32> + '_ {
        self.follow(self.first_in_slot[slot as usize], |record| record.next_in_slot).map(|record| record.edge)
    }

    fn follow(&self, from: u32, next: impl Fn(&Record) -> u32) -> impl Iterator<Item = &Record> {
        let record = |at: u32| self.records.get(at as usize);
        std::iter::successors(record(from), move |&at| record(next(at)))
    }

    /// Replaces the chain of `edge` by `portions`; fewer than two portions need no chain.
    pub fn set(&mut self, edge: u32, portions: &[Portion]) {
        self.clear(edge);
        if portions.len() < 2 {
            return;
        }
        let mut next = NONE;
        for &portion in portions.iter().rev() {
            next = self.link(Record { edge, portion, next, next_in_slot: NONE, previous_in_slot: NONE });
        }
        self.first[edge as usize] = next;
    }

    fn clear(&mut self, edge: u32) {
        let mut at = std::mem::replace(&mut self.first[edge as usize], NONE);
        while at != NONE {
            let Record { next, portion, next_in_slot, previous_in_slot, .. } = self.records[at as usize];
            match previous_in_slot {
                NONE => self.first_in_slot[portion.slot as usize] = next_in_slot,
                previous => self.records[previous as usize].next_in_slot = next_in_slot,
            }
            if next_in_slot != NONE {
                self.records[next_in_slot as usize].previous_in_slot = previous_in_slot;
            }
            self.records[at as usize].next = self.free;
            self.free = at;
            at = next;
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "portions are fewer than source edges times slots crossed, far below u32"
    )]
    fn link(&mut self, record: Record) -> u32 {
        let slot = record.portion.slot as usize;
        let record = Record { next_in_slot: self.first_in_slot[slot], ..record };
        let at = if self.free == NONE {
            self.records.push(record);
            self.records.len() as u32 - 1
        } else {
            let at = self.free;
            self.free = self.records[at as usize].next;
            self.records[at as usize] = record;
            at
        };
        if record.next_in_slot != NONE {
            self.records[record.next_in_slot as usize].previous_in_slot = at;
        }
        self.first_in_slot[slot] = at;
        at
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
            settings in prop::collection::vec((0_u32..8, prop::collection::vec(0_u32..6, 0..5)), 0..60)
        ) {
            let mut chains = Chains::new(8, 6);
            let mut map: BTreeMap<u32, Vec<Portion>> = BTreeMap::new();
            for (edge, slots) in settings {
                let portions: Vec<Portion> = slots.iter().map(|&slot| Portion { slot, end: slot as f32 }).collect();
                chains.set(edge, &portions);
                map.insert(edge, if portions.len() < 2 { vec![] } else { portions });
            }
            for (&edge, portions) in &map {
                prop_assert_eq!(&chains.of(edge).collect::<Vec<_>>(), portions);
            }
            for slot in 0..6 {
                let mut through: Vec<u32> = chains.edges_through(slot).collect();
                through.sort_unstable();
                let expected: Vec<u32> = map.iter()
                    .flat_map(|(&edge, portions)| portions.iter().filter(|p| p.slot == slot).map(move |_| edge))
                    .collect();
                prop_assert_eq!(through, expected);
            }
        }
    }
}
