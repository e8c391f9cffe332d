//! Medians, percentiles and means.

/// The value below which this part of the values lies; NaN for none. The nearest rank, no
/// interpolation.
///
/// ```
/// use nephrite_compare::statistics::percentile;
/// assert_eq!(percentile(&[3.0, 1.0, 2.0], 0.5), 2.0);
/// assert_eq!(percentile(&[3.0, 1.0, 2.0], 0.1), 1.0);
/// ```
pub fn percentile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the length")]
    let rank = (part.clamp(0.0, 1.0) * sorted.len() as f64).floor() as usize;
    sorted.get(rank.min(sorted.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

/// The middle value; NaN for none.
pub fn median(values: &[f64]) -> f64 {
    percentile(values, 0.5)
}

/// The geometric mean; NaN for none.
///
/// ```
/// assert_eq!(nephrite_compare::statistics::geometric_mean(&[1.0, 4.0]), 2.0);
/// ```
pub fn geometric_mean(values: &[f64]) -> f64 {
    (values.iter().map(|value| value.ln()).sum::<f64>() / values.len() as f64).exp()
}
