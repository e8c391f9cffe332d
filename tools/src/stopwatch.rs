//! Measures short times: repeated, in turn, and reduced to medians.

use std::time::{Duration, Instant};

/// Samples taken of each piece of work; odd, so that the median is one of them.
const N_SAMPLES: usize = 31;
/// Samples of work that each needs a preparation.
const N_PREPARED_SAMPLES: usize = 9;
/// Shortest sample: shorter work is repeated within one, so that reading the clock does not count.
const SHORTEST_SAMPLE: Duration = Duration::from_micros(50);

/// Median seconds of two pieces of work. Their samples alternate, so that both meet the same load.
pub(crate) fn in_turn(mut first: impl FnMut(), mut second: impl FnMut()) -> [f64; 2] {
    let [n_first, n_second] = [n_repeats(&mut first), n_repeats(&mut second)];
    let [mut of_first, mut of_second] = [[0.0; N_SAMPLES]; 2];
    for (first_seconds, second_seconds) in of_first.iter_mut().zip(&mut of_second) {
        *first_seconds = seconds_per_call(&mut first, n_first);
        *second_seconds = seconds_per_call(&mut second, n_second);
    }
    [of_first, of_second].map(median)
}

/// Median seconds of a piece of work.
pub(crate) fn alone(mut work: impl FnMut()) -> f64 {
    let n_calls = n_repeats(&mut work);
    median::<N_SAMPLES>(std::array::from_fn(|_| seconds_per_call(&mut work, n_calls)))
}

/// Median seconds of a piece of work that is done once after each preparation, whose time does not
/// count.
pub(crate) fn after(mut prepare: impl FnMut(), mut work: impl FnMut()) -> f64 {
    let mut seconds = [0.0; N_PREPARED_SAMPLES];
    for seconds in &mut seconds {
        prepare();
        *seconds = seconds_per_call(&mut work, 1);
    }
    median(seconds)
}

/// Calls that fill the shortest sample.
fn n_repeats(work: &mut impl FnMut()) -> u32 {
    let mut n_calls = 1;
    loop {
        let start = Instant::now();
        for _ in 0..n_calls {
            work();
        }
        if start.elapsed() >= SHORTEST_SAMPLE || n_calls >= 1 << 20 {
            return n_calls;
        }
        n_calls *= 2;
    }
}

fn seconds_per_call(work: &mut impl FnMut(), n_calls: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..n_calls {
        work();
    }
    start.elapsed().as_secs_f64() / f64::from(n_calls)
}

fn median<const N: usize>(mut seconds: [f64; N]) -> f64 {
    seconds.sort_unstable_by(f64::total_cmp);
    seconds[N / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_work_takes_longer() {
        let sum = |n: u64| std::hint::black_box((0..n).fold(0, |sum, i| sum ^ std::hint::black_box(i)));
        let [short, long] = in_turn(|| _ = sum(10), || _ = sum(100_000));
        assert!(short > 0.0 && short < long, "{short} {long}");
    }

    #[test]
    fn a_median_ignores_outliers() {
        let mut seconds = [1.0; N_SAMPLES];
        seconds[3] = 1000.0;
        assert_eq!(median(seconds), 1.0);
    }
}
