//! Any number of lifetimes without a mesh.

use nephrite::internals::Lifetime;

/// About this part of the triangles that ever live in a decimation is there from the start.
const PART_AT_BIRTH: f64 = 0.37;

/// Lifetimes like those of a decimation, from numbers instead of a mesh.
///
/// A triangle is in the input with probability 0.37; otherwise it is born at a uniformly random
/// level. It dies after a part of the remaining levels that is the cube of a uniform number: most
/// triangles are gone soon, a few stay to the end. The history of the bunny has the same share of
/// input triangles and the same median life within a factor of two. Nothing is stored: the lifetime
/// of an id follows from a hash of the id.
#[derive(Clone, Copy, Debug)]
pub struct SyntheticLifetimes {
    /// Levels that lifetimes count.
    pub n_levels: u32,
}

impl SyntheticLifetimes {
    /// The lifetime of an id; `None` only if there is no level.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the number of levels")]
    pub fn lifetime(self, id: u32) -> Option<Lifetime> {
        let [which, when, how_long] = [1, 2, 3].map(|stream| even(u64::from(id) << 2 | stream));
        let n_levels = f64::from(self.n_levels);
        let birth = if which < PART_AT_BIRTH { 0.0 } else { (when * n_levels).floor() };
        let death = birth + 1.0 + (how_long.powi(3) * (n_levels - birth)).floor();
        Lifetime::new(birth as u32, death.min(n_levels) as u32)
    }
}

/// A number in `[0, 1)` from a hash of another (SplitMix64: Steele, Lea and Flood, *Fast splittable
/// pseudorandom number generators*, OOPSLA 2014).
pub fn even(seed: u64) -> f64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lifetimes_have_the_shares_that_are_promised() {
        let lives = SyntheticLifetimes { n_levels: 1000 };
        let all: Vec<Lifetime> = (0..100_000).filter_map(|id| lives.lifetime(id)).collect();
        assert_eq!(all.len(), 100_000);
        let n_from_start = all.iter().filter(|life| life.birth() == 0).count();
        assert!((36_000..39_000).contains(&n_from_start), "{n_from_start}");
        let n_short = all.iter().filter(|life| life.death() - life.birth() <= 125).count();
        assert!(n_short > 50_000, "{n_short}");
    }
}
