//! Levels before which the error leaps (W. J. Schroeder, "A topology modifying progressive decimation algorithm", *IEEE
//! Visualization* 1997, section 4.8).

use super::{Cut, Lod};

/// Ratio of errors from which a leap counts where nothing else is said; the paper uses 10 to 100.
pub const INFLECTION_RATIO: f64 = 10.0;

impl Lod {
    /// The error inflection points (equation 6): levels whose successor has more than `ratio` times their error, in order. The
    /// first one is usually the last level that looks like the input: the one before the first error that is not zero.
    ///
    /// ```no_run
    /// # let lod = nephrite::Lod::open("part.neph")?;
    /// let natural: Vec<u32> = lod.inflections(nephrite::query::INFLECTION_RATIO).collect();
    /// # Ok::<(), nephrite::store::OpenError>(())
    /// ```
    pub fn inflections(&self, ratio: f64) -> impl Iterator<Item = u32> + '_ {
        let leaps = move |pair: &[f64]| pair[1] > ratio * pair[0];
        (0..).zip(self.errors().windows(2)).filter(move |(_, pair)| leaps(pair)).map(|(level, _)| level)
    }

    /// The inflection point whose reduction is nearest to the one asked for (equation 7), from 0 for the input to 1 for nothing;
    /// the nearest level of all where there is no inflection point. Cost: one pass over the levels.
    pub fn at_reduction_near_inflection(&self, reduction: f64, ratio: f64) -> Cut<'_> {
        let counts = self.file().simplex_counts();
        let n_in = f64::from(counts.first().copied().unwrap_or(0).max(1));
        let distance = |level: u32| {
            let n = counts.get(level as usize).copied().unwrap_or(0);
            (1.0 - f64::from(n) / n_in - reduction).abs()
        };
        let nearest = |levels: &mut dyn Iterator<Item = u32>| {
            levels.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        };
        let level = nearest(&mut self.inflections(ratio)).or_else(|| nearest(&mut (0..self.n_levels())));
        self.at_level(level.unwrap_or(0))
    }
}
