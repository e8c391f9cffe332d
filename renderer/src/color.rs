//! The colour of an instance.

use std::array;

/// What the colour of an instance shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Color {
    /// Stone, a little different from instance to instance.
    #[default]
    Stone,
    /// The level, from the finest in yellow to the coarsest in blue.
    Level,
}

/// Linear colours of nephrite: pale, green, dark.
const STONES: [[f32; 3]; 3] = [[0.42, 0.52, 0.33], [0.16, 0.36, 0.22], [0.10, 0.20, 0.17]];
/// Linear colours from the finest level to the coarsest.
const LEVELS: [[f32; 3]; 5] =
    [[0.90, 0.70, 0.08], [0.85, 0.28, 0.05], [0.55, 0.05, 0.16], [0.22, 0.08, 0.42], [0.04, 0.26, 0.50]];

/// The linear colour of an instance at a level, given with the number of levels; `chance` is from
/// -1 to 1.
pub(crate) fn color(by: Color, [level, n_levels]: [u32; 2], chance: f32) -> [f32; 4] {
    let [r, g, b] = match by {
        Color::Stone => between(&STONES, (chance + 1.0) / 2.0),
        // Levels whose colours can be distinguished are fewer than 2^24.
        Color::Level => between(&LEVELS, level as f32 / (n_levels - 1).max(1) as f32),
    };
    [r, g, b, 1.0]
}

/// The colour at `part`, from 0 to 1, of a ramp.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the ramp")]
fn between<const N: usize>(ramp: &[[f32; 3]; N], part: f32) -> [f32; 3] {
    let position = part.clamp(0.0, 1.0) * (N - 1) as f32;
    let step = (position as usize).min(N - 2);
    let beyond = position - step as f32;
    array::from_fn(|i| (1.0 - beyond) * ramp[step][i] + beyond * ramp[step + 1][i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_begin_and_end_with_their_ends() {
        assert_eq!(color(Color::Level, [0, 9], 0.3)[..3], LEVELS[0]);
        assert_eq!(color(Color::Level, [4, 9], 0.3)[..3], LEVELS[2]);
        assert_eq!(color(Color::Level, [8, 9], 0.3)[..3], LEVELS[4]);
        assert_eq!(color(Color::Level, [0, 1], 0.3)[..3], LEVELS[0]);
        assert_eq!(color(Color::Stone, [3, 9], 1.0)[..3], STONES[2]);
    }
}
