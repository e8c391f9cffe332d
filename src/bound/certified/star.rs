//! Which triangle of a star is in a slot.

/// Slots that are compared at once.
const LANES: usize = 8;

/// No slot of any triangle.
const NOWHERE: u32 = u32::MAX;

/// Of slots and portions: not in the hole.
pub(super) const OUTSIDE: u8 = u8::MAX;

/// The slots of a star's triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Star {
    slots: Vec<[u32; LANES]>,
}

impl Star {
    /// Makes this the star with the given slots, fewer than [`OUTSIDE`].
    pub(super) fn set(&mut self, slots: &[u32]) {
        let fill_up = |some: &[u32]| std::array::from_fn(|lane| some.get(lane).copied().unwrap_or(NOWHERE));
        self.slots.clear();
        self.slots.extend(slots.chunks(LANES).map(fill_up));
    }

    /// Index of the triangle in `slot`, or [`OUTSIDE`].
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "a star has fewer than 255 triangles")]
    pub(super) fn label(&self, slot: u32) -> u8 {
        for (at, slots) in self.slots.iter().enumerate() {
            let mut equal = 0_u8;
            for (lane, &other) in slots.iter().enumerate() {
                equal |= u8::from(other == slot) << lane;
            }
            if equal != 0 {
                return (LANES * at) as u8 + equal.trailing_zeros() as u8;
            }
        }
        OUTSIDE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_places_in_the_star() {
        let mut star = Star::default();
        for n in [20, 3, 8] {
            let slots: Vec<u32> = (0..n).map(|at| 7 * at).collect();
            star.set(&slots);
            for slot in 0..200 {
                let expected = slots.iter().position(|&other| other == slot);
                assert_eq!(star.label(slot), expected.map_or(OUTSIDE, |at| u8::try_from(at).unwrap()));
            }
        }
    }
}
