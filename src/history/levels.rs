//! Levels: the steps that a file keeps.
//!
//! A decimator counts every removal, some 34,000 steps for the bunny. Nobody asks for a mesh
//! between two removals of a triangle each, and triangles that are born and die between two kept
//! steps need not be stored, so a file keeps few steps, spread evenly on the scale on which levels
//! of detail are chosen: the logarithm of the simplex count. With at most `n` levels that scale is
//! cut into `n - 1` intervals from the input to the coarsest step, and one step of each interval is
//! kept: the first one after which the error rises, or the first one if the error does not rise in
//! the interval. By default an interval is a factor of 64/63.

use super::{History, HistoryError, NEVER};
use crate::tree::Lifetime;

/// Each level of a file has about this part of the simplices of the level before.
pub(super) const LEVEL_RATIO: f64 = 63.0 / 64.0;

/// The step before an error of so many times its own is kept whatever its interval: an error
/// inflection point (W. J. Schroeder, "A topology modifying progressive decimation algorithm",
/// 1997, section 4.8), a natural place to stop.
pub(super) const LEAP_RATIO: f64 = 10.0;

/// Which steps a file keeps as levels.
///
/// Memory: 4 bytes per step. Invariants: `steps[0] == 0`, steps ascend strictly, simplex counts
/// never rise.
///
/// ```
/// use nephrite::{History, Levels, NEVER};
/// let history = History {
///     simplices: vec![[0, 1, 2], [0, 2, 3], [0, 1, 3]],
///     birth: vec![0, 0, 1],
///     death: vec![1, 1, NEVER],
///     vertex_birth: vec![],
///     vertex_death: vec![NEVER, NEVER, 1, NEVER],
///     errors: vec![0.0, 0.5],
///     deviations: vec![],
/// };
/// let levels = Levels::choose(&history, None)?;
/// assert_eq!(levels.steps(), [0, 1]);
/// assert_eq!(levels.simplex_counts(), [2, 1]);
/// # Ok::<(), nephrite::HistoryError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Levels {
    steps: Vec<u32>,
    simplex_counts: Vec<u32>,
    /// First level at or after each step.
    level_of_step: Vec<u32>,
}

impl Levels {
    /// Chooses the levels of a history.
    ///
    /// Step 0 is always level 0, and the last step is kept. Every interval of simplex counts that
    /// has a step has a level: the first step that is the last of those with its error, or else the
    /// first step. If the history states deviations as well, it is the first step in any case.
    /// Without a limit every step before a leap of more than 10 times the error is kept too.
    /// `limit` is the largest number of levels; 1 (or 0) keeps the input only, and a large one
    /// keeps every step that removes a simplex. Cost: one pass over simplices and steps.
    ///
    /// # Errors
    ///
    /// The first invariant of the history that does not hold, and [`HistoryError::Grows`] when the
    /// coarsest step has more simplices than the input.
    pub fn choose<const CORNERS: usize>(
        history: &History<CORNERS>,
        limit: Option<u32>,
    ) -> Result<Self, HistoryError> {
        history.check()?;
        Self::of_checked(history, limit)
    }

    /// As [`choose`](Self::choose), of a history that passes [`History::check`].
    pub(crate) fn of_checked<const CORNERS: usize>(
        history: &History<CORNERS>,
        limit: Option<u32>,
    ) -> Result<Self, HistoryError> {
        let alive = alive_counts(history);
        // Deviations are maxima over the mesh and the error is the boundary's: all stand still
        // while the mesh changes elsewhere.
        let is_always = !history.deviations.is_empty();
        let rises = |step: usize| is_always || history.errors[step + 1] > history.errors[step];
        // Errors that are not zero leap at most some six hundred times within their range.
        let leaps =
            |step: usize| limit.is_none() && history.errors[step + 1] > LEAP_RATIO * history.errors[step];
        let steps = choose_steps(rises, leaps, &alive, limit);
        let simplex_counts: Vec<u32> = steps.iter().map(|&step| alive[step as usize]).collect();
        for (level, pair) in simplex_counts.windows(2).enumerate() {
            if pair[1] > pair[0] {
                return Err(HistoryError::Grows { step: steps[level + 1], found: pair[1], before: pair[0] });
            }
        }
        // The counts are not needed any more; their memory becomes the table.
        let mut level_of_step = alive;
        let mut level = 0;
        for (step, entry) in (0u32..).zip(&mut level_of_step) {
            while steps.get(level as usize).is_some_and(|&kept| kept < step) {
                level += 1;
            }
            *entry = level;
        }
        Ok(Self { steps, simplex_counts, level_of_step })
    }

    /// Number of levels, at least 1.
    pub fn n_levels(&self) -> u32 {
        // No more levels than steps, which are u32.
        u32::try_from(self.steps.len()).unwrap_or(u32::MAX)
    }

    /// The step of each level.
    pub fn steps(&self) -> &[u32] {
        &self.steps
    }

    /// Simplices alive at each level.
    pub fn simplex_counts(&self) -> &[u32] {
        &self.simplex_counts
    }

    /// First level at or after `step`; the number of levels if no level follows, as for [`NEVER`].
    pub fn at_or_after(&self, step: u32) -> u32 {
        let n_levels = self.n_levels();
        if step == NEVER {
            n_levels
        } else {
            self.level_of_step.get(step as usize).copied().unwrap_or(n_levels)
        }
    }

    /// A lifetime in steps as one in levels, or `None` when no level sees it.
    pub fn lifetime(&self, birth: u32, death: u32) -> Option<Lifetime> {
        Lifetime::new(self.at_or_after(birth), self.at_or_after(death))
    }
}

/// Simplices alive at each step.
fn alive_counts<const CORNERS: usize>(history: &History<CORNERS>) -> Vec<u32> {
    let mut alive = vec![0u32; history.errors.len()];
    // Differences first; births before deaths of the same simplex keep every partial sum a count,
    // wrapping or not.
    for (&birth, &death) in history.birth.iter().zip(&history.death) {
        if let Some(count) = alive.get_mut(birth as usize) {
            *count = count.wrapping_add(1);
        }
        if let Some(count) = alive.get_mut(death as usize) {
            *count = count.wrapping_sub(1);
        }
    }
    let mut sum = 0u32;
    for count in &mut alive {
        sum = sum.wrapping_add(*count);
        *count = sum;
    }
    alive
}

/// `rises` tells whether a step is a choice beside the step after it, `leaps` whether it is the
/// only one.
fn choose_steps(
    rises: impl Fn(usize) -> bool,
    leaps: impl Fn(usize) -> bool,
    alive: &[u32],
    limit: Option<u32>,
) -> Vec<u32> {
    // The input is always a level.
    let mut steps = vec![0];
    let (Some(&finest), Some(&coarsest)) = (alive.first(), alive.last()) else { return steps };
    if limit.is_some_and(|limit| limit <= 1) || alive.len() == 1 {
        return steps;
    }
    // Intervals are even on a logarithmic scale of counts: there, levels of detail are chosen.
    let span = octaves(finest, coarsest);
    let n_intervals = match limit {
        Some(limit) => f64::from(limit - 1),
        None => (span / -LEVEL_RATIO.log2()).ceil(),
    };
    let interval =
        |count: u32| if span > 0.0 { (octaves(finest, count) / span * n_intervals).floor() } else { 0.0 };

    let mut last_interval = 0.0;
    // The first step of the interval at hand, as long as the interval has no level.
    let mut spare: Option<u32> = None;
    for step in (1u32..).take(alive.len() - 2) {
        let count = alive[step as usize];
        let this_interval = interval(count);
        // Simplex counts may rise from a step to the next, never from a level to the next.
        let is_smaller = |steps: &[u32]| steps.last().is_some_and(|&kept| count < alive[kept as usize]);
        // An interval in which no step was a choice keeps its first one, once it is left.
        if let Some(before) = spare.filter(|&before| this_interval > interval(alive[before as usize])) {
            steps.push(before);
            last_interval = interval(alive[before as usize]);
            spare = None;
        }
        let is_new = this_interval > last_interval;
        if rises(step as usize) && (is_new || (leaps(step as usize) && is_smaller(&steps))) {
            steps.push(step);
            last_interval = this_interval;
            spare = None;
        } else if is_new && spare.is_none() && is_smaller(&steps) {
            spare = Some(step);
        }
    }
    steps.extend(spare);
    // The last step takes the place of any that it is not coarser than.
    let last = u32::try_from(alive.len() - 1).unwrap_or(u32::MAX);
    while steps.len() > 1
        && steps.last().is_some_and(|&step| interval(alive[step as usize]) >= interval(coarsest))
    {
        steps.pop();
    }
    steps.push(last);
    steps
}

/// How many times `count` must be doubled to give `finest`.
fn octaves(finest: u32, count: u32) -> f64 {
    (f64::from(finest.max(1)) / f64::from(count.max(1))).log2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn choose_steps(errors: &[f64], alive: &[u32], limit: Option<u32>) -> Vec<u32> {
        let leaps = |step: usize| limit.is_none() && errors[step + 1] > LEAP_RATIO * errors[step];
        super::choose_steps(|step| errors[step + 1] > errors[step], leaps, alive, limit)
    }

    /// Two triangles fewer per step, as when an interior vertex is removed.
    fn halving(n_steps: u32) -> (Vec<f64>, Vec<u32>) {
        let errors = (0..=n_steps).map(|step| f64::from(step) * 0.5).collect();
        (errors, (0..=n_steps).map(|step| 4 + 2 * (n_steps - step)).collect())
    }

    #[test]
    fn default_levels_shrink_by_the_ratio_and_end_with_every_step() {
        let (errors, alive) = halving(10_000);
        let steps = choose_steps(&errors, &alive, None);
        assert_eq!((steps[0], steps[steps.len() - 1]), (0, 10_000));
        for pair in steps.windows(2) {
            let (fine, coarse) = (f64::from(alive[pair[0] as usize]), f64::from(alive[pair[1] as usize]));
            let ratio = coarse / fine;
            let is_single_step = pair[1] - pair[0] == 1;
            assert!(is_single_step || (ratio > 0.965 && ratio < 0.9945), "{fine} to {coarse}");
        }
        // 64 * ln(20004 / 128) for the series, some 62 single steps below 128 triangles.
        assert!((350..450).contains(&steps.len()), "{}", steps.len());
    }

    #[test]
    fn limits_are_kept_and_spread_alike() {
        let (errors, alive) = halving(10_000);
        for limit in [0, 1, 2, 3, 7, 12, 44, 145, 1000, 20_000, u32::MAX] {
            let steps = choose_steps(&errors, &alive, Some(limit));
            assert!(steps.len() as u64 <= u64::from(limit.max(1)), "{limit}: {}", steps.len());
            assert!(limit < 2 || steps[steps.len() - 1] == 10_000);
            assert!(steps.windows(2).all(|pair| pair[0] < pair[1]));
        }
        assert_eq!(choose_steps(&errors, &alive, Some(u32::MAX)).len(), 10_001);
        assert_eq!(choose_steps(&errors, &alive, Some(12)).len(), 12);
    }

    #[test]
    fn runs_of_equal_error_leave_their_last_step() {
        let errors = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0];
        let alive = [14000, 13999, 13998, 13000, 12999, 12998, 9000];
        assert_eq!(choose_steps(&errors, &alive, None), [0, 2, 4, 6]);
    }

    #[test]
    fn every_interval_has_a_level_whatever_the_error_does() {
        let alive: Vec<u32> = (0..=5000).map(|step| 10_000 - 2 * step).collect();
        for errors in [vec![1.0; 5001], (0..=5000).map(|step| f64::from(step / 700)).collect()] {
            let steps = choose_steps(&errors, &alive, None);
            for pair in steps.windows(2) {
                let [fine, coarse] = [0, 1].map(|i| f64::from(alive[pair[i] as usize]));
                assert!(coarse >= 0.968 * fine || pair[1] - pair[0] <= 2, "{fine} to {coarse}");
            }
            // A step before a rise is a better level than one before it of the same error.
            let rising = (1..5000_u32).filter(|&step| errors[step as usize + 1] > errors[step as usize]);
            assert!(rising.filter(|step| alive[*step as usize] > 100).all(|step| steps.contains(&step)));
        }
    }

    #[test]
    fn a_last_step_without_fewer_simplices_replaces_its_equals() {
        assert_eq!(choose_steps(&[0.0, 1.0, 2.0, 3.0], &[8, 6, 4, 4], None), [0, 1, 3]);
        assert_eq!(choose_steps(&[0.0, 1.0], &[8, 8], None), [0, 1]);
        assert_eq!(choose_steps(&[0.0], &[0], None), [0]);
        assert_eq!(choose_steps(&[0.0, 1.0], &[0, 0], Some(5)), [0, 1]);
    }

    proptest! {
        #[test]
        fn no_budget_loses_more_than_one_interval(
            drops in prop::collection::vec((0u32..6, any::<bool>()), 1..300), limit in prop::option::of(2u32..60)
        ) {
            let finest = 10 + drops.iter().map(|drop| drop.0).sum::<u32>();
            let (mut errors, mut alive) = (vec![0.0], vec![finest]);
            for (drop, is_rise) in drops {
                errors.push(errors[errors.len() - 1] + if is_rise { 1.0 } else { 0.0 });
                alive.push(alive[alive.len() - 1] - drop);
            }
            let steps = choose_steps(&errors, &alive, limit);
            let last = alive.len() - 1;
            prop_assert_eq!((steps[0], steps[steps.len() - 1] as usize), (0, last));
            prop_assert!(limit.is_none_or(|limit| steps.len() <= limit as usize));
            let span = octaves(finest, alive[last]);
            let n_intervals = limit.map_or((span / (64f64 / 63.0).log2()).ceil(), |limit| f64::from(limit - 1));
            let part_of = |count: u32| if span > 0.0 { octaves(finest, count) / span } else { 0.0 };
            let interval = |step: u32| (part_of(alive[step as usize]) * n_intervals).floor();
            for step in (1..).take(last - 1) {
                // Every interval has a level, and the first step of an interval after which the
                // error rises is it.
                let is_choice = interval(step) > 0.0 && interval(step) < (part_of(alive[last]) * n_intervals).floor();
                let level = steps.iter().copied().find(|&kept| interval(kept) == interval(step));
                prop_assert!(!is_choice || level.is_some());
                let rises = errors[step as usize + 1] > errors[step as usize];
                prop_assert!(!(is_choice && rises) || level.is_some_and(|level| level <= step));
            }
        }
    }

    #[test]
    fn lifetimes_count_levels_and_short_ones_vanish() {
        let history = History {
            simplices: vec![[0, 1, 2]; 4],
            birth: vec![0, 1, 2, 0],
            death: vec![NEVER, 2, 3, 3],
            vertex_birth: vec![],
            vertex_death: vec![NEVER; 3],
            errors: vec![0.0, 1.0, 1.0, 2.0],
            deviations: vec![],
        };
        let levels = Levels::choose(&history, Some(3)).unwrap();
        assert_eq!(levels.steps(), [0, 3]);
        assert_eq!(levels.lifetime(0, NEVER), Lifetime::new(0, 2));
        assert_eq!(levels.lifetime(1, 2), None);
        assert_eq!(levels.lifetime(2, 3), None);
        assert_eq!(levels.lifetime(0, 3), Lifetime::new(0, 1));
    }
}
