//! Slots closing up behind those that have become empty.
//!
//! A decimation leaves ever fewer triangles in the slots of the input. Every array that runs
//! parallel to the slots would stay as long as it was, and the triangles that are left would lie
//! ever farther apart in memory.

use crate::flat::NO_INDEX;

/// New numbers for the slots in use, in the order they had.
///
/// Memory: 4 bytes per slot.
#[derive(Clone, Debug)]
pub(crate) struct Renumbering {
    /// New number of each slot; [`NO_INDEX`] for the empty ones.
    places: Vec<u32>,
    n_used: usize,
}

impl Renumbering {
    /// Numbers the slots for which `are_used` is true, at most `u32::MAX` of them.
    /// O(slots).
    pub(crate) fn new(are_used: impl Iterator<Item = bool>) -> Self {
        let mut next = 0;
        let mut place = |is_used| {
            let place = next;
            next += u32::from(is_used);
            if is_used { place } else { NO_INDEX }
        };
        let places = are_used.map(&mut place).collect();
        Self { places, n_used: next as usize }
    }

    /// New number of a slot in use.
    #[inline]
    pub(crate) fn place(&self, slot: u32) -> u32 {
        debug_assert_ne!(self.places[slot as usize], NO_INDEX, "nothing names an empty slot");
        self.places[slot as usize]
    }

    /// Keeps what belongs to slots in use, and gives back the memory of the rest.
    pub(crate) fn close_up<T: Copy>(&self, of_slots: &mut Vec<T>) {
        for (slot, &place) in self.places.iter().enumerate().filter(|&(_, &place)| place != NO_INDEX) {
            of_slots[place as usize] = of_slots[slot];
        }
        of_slots.truncate(self.n_used);
        of_slots.shrink_to_fit();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_keeps_its_order() {
        let are_used = [false, true, true, false, false, true];
        let slots = Renumbering::new(are_used.into_iter());
        let mut names = vec!['a', 'b', 'c', 'd', 'e', 'f'];
        slots.close_up(&mut names);
        assert_eq!(names, ['b', 'c', 'f']);
        assert_eq!([1, 2, 5].map(|slot| slots.place(slot)), [0, 1, 2]);
    }
}
