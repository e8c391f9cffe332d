//! Which triangle of a star is in a slot.

/// Of slots and portions: not in the hole.
pub(super) const OUTSIDE: u8 = u8::MAX;

/// Places of the table, of which a star takes a few.
const N_PLACES: usize = 256;

/// The slots of a star's triangles, found by their lowest bits: those of most triangles of a star
/// differ, being near each other.
#[derive(Clone, Debug)]
pub(super) struct StarIndex {
    slots: Vec<u32>,
    /// Index of one slot of the star with these lowest bits, or [`OUTSIDE`].
    one: [u8; N_PLACES],
}

impl Default for StarIndex {
    fn default() -> Self {
        Self { slots: vec![], one: [OUTSIDE; N_PLACES] }
    }
}

impl StarIndex {
    /// Makes this the star with the given slots, fewer than [`OUTSIDE`].
    pub(super) fn set(&mut self, slots: &[u32]) {
        for &slot in &self.slots {
            self.one[place(slot)] = OUTSIDE;
        }
        self.slots.clear();
        self.slots.extend_from_slice(slots);
        for (label, &slot) in (0..).zip(slots) {
            self.one[place(slot)] = label;
        }
    }

    /// Index of the triangle in `slot`, or [`OUTSIDE`].
    #[inline]
    pub(super) fn label(&self, slot: u32) -> u8 {
        let one = self.one[place(slot)];
        if one == OUTSIDE || self.slots[usize::from(one)] == slot {
            return one;
        }
        (0..).zip(&self.slots).find_map(|(label, &other)| (other == slot).then_some(label)).unwrap_or(OUTSIDE)
    }
}

fn place(slot: u32) -> usize {
    slot as usize % N_PLACES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_places_in_the_star() {
        let mut star = StarIndex::default();
        for n in [20, 3, 8] {
            // Some with the same lowest bits.
            let slots: Vec<u32> = (0..n).map(|at| 64 * at).collect();
            star.set(&slots);
            for slot in 0..2000 {
                let expected = slots.iter().position(|&other| other == slot);
                assert_eq!(star.label(slot), expected.map_or(OUTSIDE, |at| u8::try_from(at).unwrap()));
            }
        }
    }
}
