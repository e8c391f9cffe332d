//! File coordinates made into single-precision positions about a local origin, by the rule stated
//! in [`crate::mesh`].
//!
//! The naive way, `x as f32`, moves a vertex at 10,000,000 m by up to half a metre. Subtracting the
//! centre of the bounding box first keeps the detail, but moving every mesh would make files with
//! plain `f32` coordinates inexact for nothing. So both are tried and the displacement of the worst
//! vertex decides.

use crate::files::error::{MeshError, Place};
use crate::files::unused::drop_bad_points;
use crate::{Attribute, FileReport};

/// Positions about an origin, and how far the worst of them is from where the file put it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coordinates {
    /// Added to every position to give file coordinates.
    pub origin: [f64; 3],
    /// One position per point, in order.
    pub positions: Vec<[f32; 3]>,
    /// Largest distance between a point and `origin + position`, in mesh units.
    pub rounding: f64,
}

/// Points in the precision of the file.
pub(crate) enum Points {
    F32(Vec<[f32; 3]>),
    F64(Vec<[f64; 3]>),
    /// `f64` from text, whose digits may be those of `f32`.
    Text(Vec<[f64; 3]>),
}

impl Points {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::F32(points) => points.len(),
            Self::F64(points) | Self::Text(points) => points.len(),
        }
    }

    /// As [`drop_bad_points`].
    ///
    /// # Errors
    ///
    /// As [`drop_bad_points`].
    pub(crate) fn drop_bad(
        &mut self,
        attributes: &mut [Attribute],
        corners: &mut [&mut [u32]],
        place_of: &dyn Fn(usize) -> Place,
        report: &mut FileReport,
    ) -> Result<(), MeshError> {
        match self {
            Self::F32(points) => drop_bad_points(points, attributes, corners, place_of, report),
            Self::F64(points) | Self::Text(points) => {
                drop_bad_points(points, attributes, corners, place_of, report)
            }
        }
    }

    /// Copies points behind all others.
    pub(crate) fn copy_to_end(&mut self, copied: &[u32]) {
        match self {
            Self::F32(points) => copied.iter().for_each(|&point| points.push(points[point as usize])),
            Self::F64(points) | Self::Text(points) => {
                copied.iter().for_each(|&point| points.push(points[point as usize]));
            }
        }
    }

    /// Chooses the origin and rounds to `f32` about it.
    ///
    /// # Errors
    ///
    /// As [`from_f64`].
    pub(crate) fn into_coordinates(self) -> Result<Coordinates, MeshError> {
        match self {
            Self::F32(points) => from_f32(points),
            Self::F64(points) => from_f64(&points),
            Self::Text(points) => from_text(&points),
        }
    }
}

/// A shift of the origin must make the rounding this many times smaller to be worth it.
const SHIFT_GAIN: f64 = 4.0;

/// Chooses the origin for `points` and rounds them to `f32` about it. Three passes at most.
///
/// # Errors
///
/// [`MeshError::NonFinite`] or [`MeshError::CoordinateTooLarge`] with the first vertex at fault.
pub(crate) fn from_f64(points: &[[f64; 3]]) -> Result<Coordinates, MeshError> {
    for (i, point) in points.iter().enumerate() {
        for &value in point {
            check_coordinate(value, Place::item("vertex", i))?;
        }
    }
    let about_zero = round_about(points, [0.0; 3]);
    if about_zero.rounding == 0.0 {
        return Ok(about_zero);
    }
    let about_centre = round_about(points, bounding_centre(points));
    let gains = about_zero.rounding > SHIFT_GAIN * about_centre.rounding;
    Ok(if gains { about_centre } else { about_zero })
}

/// As [`from_f64`], for numbers read from text: the origin stays zero where the digits are no more
/// than `f32` holds.
///
/// `0.1` is not exact in `f32`, but it is the shortest text that means the nearest `f32`, as it is
/// for all numbers of up to six digits and for everything that was printed from `f32`. Nothing that
/// such digits tell apart is lost about zero.
///
/// # Errors
///
/// As [`from_f64`].
pub(crate) fn from_text(points: &[[f64; 3]]) -> Result<Coordinates, MeshError> {
    let coordinates = from_f64(points)?;
    let is_shifted = coordinates.origin != [0.0; 3];
    if is_shifted && points.iter().flatten().all(|&value| is_shortest_text_of_f32(value)) {
        return Ok(round_about(points, [0.0; 3]));
    }
    Ok(coordinates)
}

/// Whether the number is what the shortest text of the nearest `f32` means.
fn is_shortest_text_of_f32(value: f64) -> bool {
    format!("{:e}", nearest_f32(value)).parse() == Ok(value)
}

/// Positions that the file gives in `f32`: nothing to choose, nothing lost.
///
/// # Errors
///
/// [`MeshError::NonFinite`] with the first vertex at fault.
pub(crate) fn from_f32(positions: Vec<[f32; 3]>) -> Result<Coordinates, MeshError> {
    for (i, position) in positions.iter().enumerate() {
        if let Some(&value) = position.iter().find(|value| !value.is_finite()) {
            return Err(MeshError::NonFinite { place: Place::item("vertex", i), value: value.into() });
        }
    }
    Ok(Coordinates { origin: [0.0; 3], positions, rounding: 0.0 })
}

/// Finite `f32` positions under a translation in `f64`: exact as they are, with the translation as
/// origin, unless the sums are exact in `f32` and the origin zero serves.
///
/// # Errors
///
/// [`MeshError::NonFinite`] or [`MeshError::CoordinateTooLarge`] with the first vertex at fault.
pub(crate) fn from_translated(
    positions: Vec<[f32; 3]>,
    translation: [f64; 3],
) -> Result<Coordinates, MeshError> {
    let positions = from_f32(positions)?.positions;
    let mut sums = Vec::with_capacity(positions.len());
    for (i, position) in positions.iter().enumerate() {
        let mut sum = [0.0_f32; 3];
        for axis in 0..3 {
            let (high, low) = two_sum(translation[axis], position[axis].into());
            check_coordinate(high, Place::item("vertex", i))?;
            sum[axis] = nearest_f32(high);
            if low != 0.0 || f64::from(sum[axis]) != high {
                return Ok(Coordinates { origin: translation, positions, rounding: 0.0 });
            }
        }
        sums.push(sum);
    }
    Ok(Coordinates { origin: [0.0; 3], positions: sums, rounding: 0.0 })
}

/// Accepts a coordinate that `f32` can hold.
///
/// # Errors
///
/// [`MeshError::NonFinite`] or [`MeshError::CoordinateTooLarge`] at `place`.
pub(crate) fn check_coordinate(value: f64, place: Place) -> Result<(), MeshError> {
    if !value.is_finite() {
        Err(MeshError::NonFinite { place, value })
    } else if value.abs() > f64::from(f32::MAX) {
        Err(MeshError::CoordinateTooLarge { place, value })
    } else {
        Ok(())
    }
}

/// The `f32` nearest to `value`.
#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is this function's meaning")]
pub(crate) fn nearest_f32(value: f64) -> f32 {
    value as f32
}

/// The points rounded about one origin, with the exact displacement of the worst.
fn round_about(points: &[[f64; 3]], origin: [f64; 3]) -> Coordinates {
    let mut worst_sq = 0.0_f64;
    let mut positions = Vec::with_capacity(points.len());
    for point in points {
        let mut position = [0.0_f32; 3];
        let mut moved_sq = 0.0;
        for axis in 0..3 {
            // difference + rest is point - origin without rounding, and so is what the position
            // misses of it.
            let (difference, rest) = two_sum(point[axis], -origin[axis]);
            position[axis] = nearest_f32(difference);
            let moved = (difference - f64::from(position[axis])) + rest;
            moved_sq += moved * moved;
        }
        worst_sq = worst_sq.max(moved_sq);
        positions.push(position);
    }
    // The factor covers the rounding of the squares and of the root, so that the result is an upper
    // bound; a displacement whose square underflows is below every length that f32 can tell apart
    // at the same place, but not zero.
    let rounding = worst_sq.sqrt() * (1.0 + 4.0 * f64::EPSILON);
    let underflowed = rounding == 0.0
        && points.iter().zip(&positions).any(|(point, position)| {
            (0..3).any(|axis| point[axis] - origin[axis] != f64::from(position[axis]))
        });
    Coordinates {
        origin,
        positions,
        rounding: if underflowed { f64::from(f32::MIN_POSITIVE) } else { rounding },
    }
}

/// Centre of the bounding box, to within a sixteenth of its sides: a number of few digits, the
/// difference from which is exact in `f64` more often.
fn bounding_centre(points: &[[f64; 3]]) -> [f64; 3] {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for point in points {
        for axis in 0..3 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    std::array::from_fn(|axis| {
        let centre = 0.5 * (low[axis] + high[axis]);
        let step = power_of_two_below(high[axis] - low[axis]) / 16.0;
        if step > 0.0 { (centre / step).round() * step } else { centre }
    })
}

/// The largest power of two that is not above a positive number, zero for zero and subnormal
/// numbers.
fn power_of_two_below(value: f64) -> f64 {
    const EXPONENT_BITS: u64 = 0x7ff0_0000_0000_0000;
    f64::from_bits(value.to_bits() & EXPONENT_BITS)
}

/// `a + b` as a rounded sum and the exact rest (Knuth, The Art of Computer Programming 2, section
/// 4.2.2, theorem B).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn single_precision_values_stay_where_they_are() {
        let points = [[0.1_f32, 1e-30, -7.25], [1e30, 16_777_216.0, 0.0]].map(|p| p.map(f64::from));
        let read = from_f64(&points).unwrap();
        assert_eq!((read.origin, read.rounding), ([0.0; 3], 0.0));
        assert_eq!(read.positions[0], [0.1_f32, 1e-30, -7.25]);
    }

    #[test]
    fn decimal_text_about_the_origin_is_not_shifted() {
        let read = from_f64(&[[0.1, 0.2, 0.3], [1.1, -0.7, 0.9], [0.0, 0.0, 0.0]]).unwrap();
        assert_eq!(read.origin, [0.0; 3]);
        assert_eq!(read.positions[0], [0.1, 0.2, 0.3]);
        assert!(read.rounding > 0.0 && read.rounding < 1e-7);
    }

    #[test]
    fn millimetres_survive_ten_thousand_kilometres_away() {
        let points: Vec<[f64; 3]> = (0..1000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|t| [10_000_000.0 + t, -5_000_000.123 + t * t, 2_000.0 - 0.5 * t])
            .collect();
        let read = from_f64(&points).unwrap();
        assert_ne!(read.origin, [0.0; 3]);
        assert!(read.rounding < 1e-6, "rounding {}", read.rounding);
        for (point, position) in points.iter().zip(&read.positions) {
            let stored = std::array::from_fn(|axis| read.origin[axis] + f64::from(position[axis]));
            // The sum itself rounds by up to one unit in the last place of 1e7.
            assert!(distance(*point, stored) <= read.rounding + 4e-9);
        }
    }

    #[test]
    fn a_shift_needs_a_gain_of_four() {
        // All rounding is in x: about zero it is half a unit in the last place at x, about the
        // centre at the half width.
        let near = from_f64(&[[4.0 + 1e-9, 0.0, 0.0], [1.0, 0.0, 0.0]]).unwrap();
        assert_eq!(near.origin, [0.0; 3]);
        let far = from_f64(&[[400.1, 0.0, 0.0], [401.3, 0.0, 0.0]]).unwrap();
        assert_ne!(far.origin, [0.0; 3]);
    }

    #[test]
    fn digits_that_f32_holds_are_not_shifted() {
        let point = [[61.706036, 0.1, -3.4e-12]];
        assert_ne!(from_f64(&point).unwrap().origin, [0.0; 3]);
        let read = from_text(&point).unwrap();
        assert_eq!((read.origin, read.positions[0]), ([0.0; 3], [61.706036_f32, 0.1, -3.4e-12]));
        assert!(read.rounding > 0.0);
        assert_ne!(from_text(&[[431_234.567, 0.1, 0.0]]).unwrap().origin, [0.0; 3]);
    }

    #[test]
    fn doubles_too_small_for_f32_are_stated_as_rounded() {
        let read = from_f64(&[[1e-300, 0.0, 0.0], [0.0; 3]]).unwrap();
        assert!(read.rounding > 0.0);
        assert_eq!(read.positions[0], [0.0; 3]);
    }

    #[test]
    fn bad_coordinates_name_their_vertex() {
        let error = from_f64(&[[0.0; 3], [0.0, f64::NAN, 0.0]]).unwrap_err();
        assert!(matches!(error, MeshError::NonFinite { place: Place::Item("vertex", 1), .. }));
        let error = from_f64(&[[0.0, 0.0, 1e39]]).unwrap_err();
        assert!(matches!(error, MeshError::CoordinateTooLarge { place: Place::Item("vertex", 0), .. }));
    }

    #[test]
    fn a_translation_that_f32_cannot_absorb_becomes_the_origin() {
        let positions = vec![[0.5_f32, 0.25, 0.0], [1e-3, 0.0, 0.0]];
        let far = from_translated(positions.clone(), [1e7, 0.0, 0.0]).unwrap();
        assert_eq!((far.origin, &far.positions, far.rounding), ([1e7, 0.0, 0.0], &positions, 0.0));
        let near = from_translated(vec![[0.5_f32, 0.25, 0.0]], [2.0, 0.0, 0.0]).unwrap();
        assert_eq!((near.origin, near.positions), ([0.0; 3], vec![[2.5, 0.25, 0.0]]));
    }
}
