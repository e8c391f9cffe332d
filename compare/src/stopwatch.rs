//! Times of several pieces of work in turn, so that all meet the same conditions, reduced to
//! medians.

use crate::statistics::median;
use std::time::{Duration, Instant};

/// Median seconds that each piece of work takes.
///
/// The pieces run in turn, `n_samples` times each; a piece briefer than `shortest_sample` is
/// repeated within a sample, so that reading the clock does not count.
///
/// ```
/// use nephrite_compare::stopwatch::in_turn;
/// use std::{hint::black_box, time::Duration};
/// let sum = |n: u64| _ = black_box((0..n).fold(0, |sum, i| sum ^ black_box(i)));
/// let shortest = Duration::from_micros(50);
/// let seconds = in_turn(5, shortest, &mut [&mut || sum(10), &mut || sum(100_000)]);
/// assert!(seconds[0] < seconds[1]);
/// ```
pub fn in_turn(n_samples: usize, shortest_sample: Duration, works: &mut [&mut dyn FnMut()]) -> Vec<f64> {
    let n_calls: Vec<u32> = works.iter_mut().map(|work| n_repeats(work, shortest_sample)).collect();
    let mut samples = vec![vec![]; works.len()];
    for _ in 0..n_samples {
        for ((work, &n_calls), samples) in works.iter_mut().zip(&n_calls).zip(&mut samples) {
            samples.push(seconds_per_call(work, n_calls));
        }
    }
    samples.iter().map(|samples| median(samples)).collect()
}

/// Calls that fill the shortest sample; 1, without a trial, if any sample is long enough.
fn n_repeats(work: &mut dyn FnMut(), shortest_sample: Duration) -> u32 {
    let mut n_calls = 1;
    if shortest_sample.is_zero() {
        return n_calls;
    }
    loop {
        let seconds = f64::from(n_calls) * seconds_per_call(work, n_calls);
        if seconds >= shortest_sample.as_secs_f64() || n_calls >= 1 << 20 {
            return n_calls;
        }
        n_calls *= 2;
    }
}

fn seconds_per_call(work: &mut dyn FnMut(), n_calls: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..n_calls {
        work();
    }
    start.elapsed().as_secs_f64() / f64::from(n_calls)
}
