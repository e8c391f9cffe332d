//! Levels before which the error leaps (W. J. Schroeder, "A topology modifying progressive
//! decimation algorithm", *IEEE Visualization* 1997, section 4.8).

use super::{Cut, Lod};

/// Default ratio of errors from which a rise counts as a leap; the paper uses 10 to 100.
pub const INFLECTION_RATIO: f64 = 10.0;

impl Lod {
    /// The error inflection points (equation 6), in order: levels whose successor has more than
    /// `ratio` times their error. The first one is usually the last level that looks like the
    /// input, just before the first error above 0.
    ///
    /// ```no_run
    /// # let lod = nephrite::Lod::open("part.neph")?;
    /// let natural: Vec<u32> = lod.inflections(nephrite::INFLECTION_RATIO).collect();
    /// # Ok::<(), nephrite::OpenError>(())
    /// ```
    pub fn inflections(&self, ratio: f64) -> impl Iterator<Item = u32> + '_ {
        let leaps = move |pair: &[f64]| pair[1] > ratio * pair[0];
        (0..).zip(self.errors().windows(2)).filter(move |(_, pair)| leaps(pair)).map(|(level, _)| level)
    }

    /// The inflection point whose reduction is nearest to `reduction` (equation 7), from 0 for the
    /// input to 1 for nothing, among levels with half to twice the triangles.
    ///
    /// A smooth surface has no inflection point there, since its error rises a little with every
    /// operation. Then the answer is the level in that range before the steepest rise, by the ratio
    /// of errors; or the nearest level of all if the range holds none. Cost: one pass over the
    /// levels.
    pub fn at_reduction_near_inflection(&self, reduction: f64, ratio: f64) -> Cut<'_> {
        self.at_level(near_inflection(self.errors(), self.file().simplex_counts(), reduction, ratio))
    }
}

/// Levels within this factor of the requested count are near.
const NEAR: f64 = 2.0;

/// The level of [`Lod::at_reduction_near_inflection`], for errors that never fall and counts that
/// never rise.
fn near_inflection(errors: &[f64], counts: &[u32], reduction: f64, ratio: f64) -> u32 {
    let n_in = f64::from(counts.first().copied().unwrap_or(0).max(1));
    let wished = n_in * (1.0 - reduction);
    let count = |level: usize| f64::from(counts.get(level).copied().unwrap_or(0));
    let distance = |level: &usize| (count(*level) - wished).abs();
    let nearest =
        |levels: &mut dyn Iterator<Item = usize>| levels.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let is_near = |level: &usize| {
        let n = count(*level);
        n * NEAR >= wished && n <= wished.max(1.0) * NEAR
    };
    let leaps = |level: &usize| errors[level + 1] > ratio * errors[*level];
    // A rise from 0 counts as infinite; no rise counts as none.
    let rise = |level: usize| {
        if errors[level + 1] > errors[level] { errors[level + 1] / errors[level] } else { 1.0 }
    };
    let n_followed = errors.len().saturating_sub(1);
    let natural = nearest(&mut (0..n_followed).filter(is_near).filter(leaps));
    let steepest = || {
        let near = (0..n_followed).filter(is_near);
        near.max_by(|&a, &b| rise(a).total_cmp(&rise(b)).then(distance(&b).total_cmp(&distance(&a))))
    };
    let level = natural.or_else(steepest).or_else(|| nearest(&mut (0..errors.len())));
    level.and_then(|level| u32::try_from(level).ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A part made by hand: flat until 800 triangles are left, holes that close at 300, a shape
    /// that is lost at 40.
    const COUNTS: [u32; 10] = [1000, 900, 800, 600, 400, 300, 200, 100, 40, 0];
    const ERRORS: [f64; 10] = [0.0, 0.0, 0.0, 0.1, 0.12, 0.13, 2.0, 2.5, 3.0, 90.0];

    #[test]
    fn natural_levels_are_those_before_a_leap() {
        for (reduction, expected) in
            [(0.2, 800), (0.3, 800), (0.6, 300), (0.7, 300), (0.8, 300), (0.95, 40), (0.97, 40)]
        {
            let level = near_inflection(&ERRORS, &COUNTS, reduction, INFLECTION_RATIO);
            assert_eq!(COUNTS[level as usize], expected, "at {reduction}");
        }
    }

    #[test]
    fn the_steepest_rise_stands_in_where_nothing_leaps() {
        let counts: Vec<u32> = (0..=100).map(|level| 1000 - 10 * level).collect();
        let mut errors: Vec<f64> = (0..=100).map(|level| 0.01 * f64::from(level)).collect();
        errors[81..].iter_mut().for_each(|error| *error += 0.2);
        assert_eq!(near_inflection(&errors, &counts, 0.75, INFLECTION_RATIO), 80);
        // Beyond the range of half to twice the count it does not count.
        assert_ne!(near_inflection(&errors, &counts, 0.3, INFLECTION_RATIO), 80);
        assert_eq!(near_inflection(&errors, &counts, 1.0, INFLECTION_RATIO), 100);
    }

    #[test]
    fn a_single_level_is_the_answer_to_everything() {
        assert_eq!(near_inflection(&[0.0], &[12], 0.9, INFLECTION_RATIO), 0);
        assert_eq!(near_inflection(&[], &[], 0.9, INFLECTION_RATIO), 0);
    }
}
