//! The limits that rise from iteration to iteration (JADE, section 5):
//!
//! ```text
//! e*_l(j) = min(e*/k c1^j, e*)        e*_g(j) = min(c2 e*_l(j), e*)
//! ```
//!
//! Low limits come first: they keep the error of every intermediate mesh, and so of every level,
//! low. With no error asked for, e* is a percent of the bounding diagonal for the start and then no
//! limit at all.

use super::options::JadeOptions;
use crate::bound::Limits;

/// e* of the first limit when no error is asked for, as a part of the bounding diagonal: the
/// coarsest of the paper's runs.
const START: f64 = 0.01;

/// Ceilings per iteration; `docs/builder-roads.md` says what they are worth.
const CEILINGS: i32 = 8;

/// The limits of one iteration after another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thresholds {
    local: f64,
    target: f64,
    c1: f64,
    c2: f64,
}

impl Thresholds {
    /// Limits up to `max_error`, or without end, for a mesh with the given bounding diagonal.
    pub(crate) fn new(max_error: Option<f64>, diagonal: f64, options: &JadeOptions) -> Self {
        let start = max_error.unwrap_or(START * diagonal) / options.k_value();
        let target = max_error.unwrap_or(f64::INFINITY);
        // From nothing no factor would lead anywhere.
        Self {
            local: start.max(f64::MIN_POSITIVE).min(target),
            target,
            c1: options.c1_value(),
            c2: options.c2,
        }
    }

    /// The limits of this iteration.
    pub(crate) fn limits(&self) -> Limits {
        Limits { local: self.local, global: (self.c2 * self.local).min(self.target) }
    }

    /// Ceilings that rise in equal factors to the global limit of this iteration, from that of the
    /// one before.
    ///
    /// What is below the limit and above the ceiling waits, without being judged again: candidates
    /// then go nearly in the order of their errors, as if the limits rose that much more finely.
    pub(crate) fn ceilings(&self) -> impl Iterator<Item = f64> + use<> {
        let (limit, c1) = (self.limits().global, self.c1);
        (1..=CEILINGS).map(move |part| limit * c1.powf(f64::from(part - CEILINGS) / f64::from(CEILINGS)))
    }

    /// Whether this iteration's limits are those asked for.
    pub(crate) fn is_last(&self) -> bool {
        self.local >= self.target
    }

    /// Goes on to the first later iteration whose limits could admit a candidate that needs a local
    /// limit of `needed`; `None` when there is no such iteration.
    pub(crate) fn advance(&mut self, needed: f64) -> Option<Limits> {
        if self.is_last() || !needed.is_finite() || needed > self.target {
            return None;
        }
        loop {
            self.local = (self.local * self.c1).min(self.target);
            if self.local >= needed || self.local >= self.target {
                return Some(self.limits());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(max_error: Option<f64>, diagonal: f64) -> Vec<Limits> {
        let mut thresholds = Thresholds::new(max_error, diagonal, &JadeOptions::default());
        let mut limits = vec![thresholds.limits()];
        while limits.len() < 100 {
            let Some(next) = thresholds.advance(0.0) else { break };
            limits.push(next);
        }
        limits
    }

    #[test]
    fn limits_follow_the_formula_and_end_at_the_target() {
        let options = JadeOptions::default();
        let (k, c1, c2) = (options.k_value(), options.c1_value(), options.c2);
        let target = 2.0;
        let limits = all(Some(target), 100.0);
        for (j, limit) in (0..).zip(&limits) {
            let local = (target / k * c1.powi(j)).min(target);
            assert!((limit.local - local).abs() < 1e-12);
            assert!((limit.global - (local * c2).min(target)).abs() < 1e-12);
        }
        assert_eq!(limits.last(), Some(&Limits { local: target, global: target }));
        assert_eq!(limits.len(), 23);
    }

    #[test]
    fn ceilings_lead_from_one_limit_to_the_next() {
        let mut thresholds = Thresholds::new(None, 100.0, &JadeOptions::default());
        let before = thresholds.limits().global;
        thresholds.advance(0.0).unwrap();
        let ceilings: Vec<f64> = thresholds.ceilings().collect();
        assert!(before < ceilings[0] && ceilings.is_sorted());
        assert_eq!(ceilings.last(), Some(&thresholds.limits().global));
    }

    #[test]
    fn limits_without_a_target_start_low_and_have_no_end() {
        let limits = all(None, 100.0);
        assert_eq!(limits[0].local, 1.0 / 256.0);
        assert_eq!(limits.len(), 100);
    }

    #[test]
    fn the_finest_steps_from_the_least_start_come_to_an_end() {
        let options = JadeOptions {
            k: Some(JadeOptions::MAX_K),
            c1: Some(JadeOptions::MIN_C1),
            ..JadeOptions::default()
        };
        for (max_error, diagonal) in [(None, 0.0), (Some(f64::MAX), 1.0), (Some(1e-300), 1.0)] {
            let mut thresholds = Thresholds::new(max_error, diagonal, &options);
            let needed = max_error.unwrap_or(f64::MAX);
            assert!(thresholds.advance(needed).is_some_and(|limits| limits.local >= needed));
        }
    }

    #[test]
    fn iterations_that_could_admit_nothing_are_skipped() {
        let mut thresholds = Thresholds::new(None, 100.0, &JadeOptions::default());
        let limits = thresholds.advance(0.1).unwrap();
        assert!(limits.local >= 0.1 && limits.local < 0.1 * JadeOptions::default().c1_value());
        assert_eq!(thresholds.advance(f64::INFINITY), None);
    }
}
