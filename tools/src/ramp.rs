//! Colours for distances: dark blue for 0, yellow for the largest.

/// Viridis at 9 even steps (Smith and van der Walt, 2015, CC0): equal steps look equally large,
/// also in grey and to most colour-blind people.
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 144, 140],
    [39, 173, 129],
    [93, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// Red, green and blue of a number from 0 to 1. Numbers outside are clamped; NaN is 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the table and to bytes"
)]
pub(crate) fn color(part: f64) -> [u8; 3] {
    let last = VIRIDIS.len() - 1;
    let position = if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) * last as f64 };
    let step = (position as usize).min(last - 1);
    let beyond = position - step as f64;
    std::array::from_fn(|channel| {
        let [from, to] = [step, step + 1].map(|step| f64::from(VIRIDIS[step][channel]));
        (from + beyond * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_steps_are_the_tables() {
        assert_eq!([0.0, 0.5, 1.0].map(color), [VIRIDIS[0], VIRIDIS[4], VIRIDIS[8]]);
        assert_eq!([-1.0, f64::NAN, 7.0].map(color), [VIRIDIS[0], VIRIDIS[0], VIRIDIS[8]]);
        assert_eq!(color(1.0 / 16.0), [70, 23, 104]);
    }

    #[test]
    fn brightness_never_falls() {
        let brightness = |color: [u8; 3]| {
            let [red, green, blue] = color.map(f64::from);
            0.2126 * red + 0.7152 * green + 0.0722 * blue
        };
        for step in 0..1000 {
            let [lower, upper] = [step, step + 1].map(|step| brightness(color(f64::from(step) / 1000.0)));
            assert!(lower <= upper + 1.0, "{step}: {lower} {upper}");
        }
    }
}
