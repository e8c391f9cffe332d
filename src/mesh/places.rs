//! Orders of vertices and simplices by what they have in common, and numberings that name another.

use rayon::prelude::*;

/// The bits of a position, with `-0` turned into `0`: equal where two vertices are at one place.
pub(super) fn position_key(position: [f32; 3]) -> [u32; 3] {
    position.map(|coordinate| (coordinate + 0.0).to_bits())
}

/// The numbers below `n` in ascending order of their keys, then of themselves. O(n log n).
#[expect(clippy::cast_possible_truncation, reason = "the lowest bits are the number")]
pub(super) fn order_by(n: usize, key: impl Fn(u32) -> [u32; 3]) -> Vec<u32> {
    let with_number = |number: u32| {
        key(number).into_iter().chain([number]).fold(0_u128, |all, word| all << u32::BITS | u128::from(word))
    };
    let mut keys: Vec<u128> = (0..).take(n).map(with_number).collect();
    keys.par_sort_unstable();
    keys.into_iter().map(|key| key as u32).collect()
}

/// How many items have another number than their own.
pub(super) fn n_moved(numbers: &[u32]) -> usize {
    (0u32..).zip(numbers).filter(|&(own, &number)| own != number).count()
}
