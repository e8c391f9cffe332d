//! The unit of length in which volumes are fused.
//!
//! Costs are sixth powers of lengths and are kept in `f32`: a mesh of nanometres given in metres
//! would have all costs 0. All lengths are therefore multiplied by a power of two that brings the
//! bounding box diagonal to some [thousand](DIAGONAL_EXPONENT). That changes exponents only: the
//! same mesh at twice the size has the same history.

/// The diagonal is at least two to this power, and less than twice that. Costs of the finest parts
/// of a mesh with diagonal `d` are some `1e-60 d^6`, the largest ones `1e4 d^6`; `f32` has room
/// from `1e-38` to `1e38`.
const DIAGONAL_EXPONENT: i32 = 10;

/// Meshes with a smaller diagonal keep their unit: fusion points could not be written in it.
const LEAST_DIAGONAL: f64 = 1e-36;

/// The number that `f64` adds to exponents.
const EXPONENT_BIAS: i32 = 1023;

/// A power of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    factor: f64,
}

impl Unit {
    /// The unit for a mesh whose bounding box has this diagonal.
    pub(super) fn new(diagonal: f64) -> Self {
        if !(diagonal.is_finite() && diagonal > LEAST_DIAGONAL) {
            return Self { factor: 1.0 };
        }
        let biased_exponent = i32::try_from(diagonal.to_bits() >> 52).unwrap_or(EXPONENT_BIAS);
        Self { factor: 2.0_f64.powi(DIAGONAL_EXPONENT - (biased_exponent - EXPONENT_BIAS)) }
    }

    /// A length in this unit.
    pub(super) fn to_unit(self, length: f64) -> f64 {
        length * self.factor
    }

    /// A length in mesh units.
    pub(super) fn to_mesh(self, length: f64) -> f64 {
        length / self.factor
    }

    /// A point in this unit.
    pub(super) fn point_to_unit(self, point: [f32; 3]) -> [f32; 3] {
        round(point.map(|x| f64::from(x) * self.factor))
    }

    /// A point in mesh units.
    pub(super) fn point_to_mesh(self, point: [f32; 3]) -> [f32; 3] {
        round(point.map(|x| f64::from(x) / self.factor))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "positions are kept in f32")]
fn round(point: [f64; 3]) -> [f32; 3] {
    point.map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonals_come_to_some_thousand_and_points_come_back() {
        for diagonal in [1e-35, 3e-12, 0.999, 1.0, 1024.0, 2047.9, 1e12, 1e38] {
            let unit = Unit::new(diagonal);
            assert!((1024.0..2048.0).contains(&unit.to_unit(diagonal)));
            assert_eq!(unit.to_mesh(unit.to_unit(diagonal)), diagonal);
            #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]
            let point = [diagonal as f32, 0.3 * diagonal as f32, 0.0];
            assert_eq!(unit.point_to_mesh(unit.point_to_unit(point)), point);
        }
        for diagonal in [0.0, 1e-44, f64::INFINITY, f64::NAN] {
            assert_eq!(Unit::new(diagonal).to_unit(3.0), 3.0);
        }
    }
}
