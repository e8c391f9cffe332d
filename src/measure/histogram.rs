//! How the distances of a surface's points are distributed.

use serde::Serialize;

/// Parts of a surface's area by their distance from another surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    /// Distance at which the last bin ends, in mesh units. The first bin begins at 0, and all are
    /// equally wide.
    pub range: f64,
    /// Part of the area in each bin; the sum is 1 unless there were no distances.
    pub bins: Vec<f64>,
}

impl Histogram {
    /// Counts distances, in mesh units, each of which stands for the same area; what lies beyond
    /// `range` is counted in the last bin. There is at least one bin.
    ///
    /// ```
    /// use nephrite::measure::Histogram;
    ///
    /// let histogram = Histogram::new(&[0.0, 0.1, 0.9, 1.0], 1.0, 2);
    /// assert_eq!(histogram.bins, [0.5, 0.5]);
    /// ```
    pub fn new(distances: &[f64], range: f64, n_bins: usize) -> Self {
        let n_bins = n_bins.max(1);
        let mut counts = vec![0u64; n_bins];
        for distance in distances {
            counts[place(distance / range * n_bins as f64).min(n_bins - 1)] += 1;
        }
        let n = distances.len().max(1) as f64;
        Self { range, bins: counts.into_iter().map(|count| count as f64 / n).collect() }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "out of range saturates, NaN is 0"
)]
fn place(position: f64) -> usize {
    position as usize
}
