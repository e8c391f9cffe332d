//! Coordinates in a tetrahedron, and values inside it.

use super::vector::{Vector, cross, dot, sub};

/// Barycentric coordinates of a point in a tetrahedron; `None` for one without volume.
pub(crate) fn barycentric(point: Vector, [a, b, c, d]: [Vector; 4]) -> Option<[f64; 4]> {
    let (b, c, d, p) = (sub(b, a), sub(c, a), sub(d, a), sub(point, a));
    let volume = dot(b, cross(c, d));
    if volume == 0.0 {
        return None;
    }
    let [u, v, w] = [dot(p, cross(c, d)), dot(p, cross(d, b)), dot(p, cross(b, c))].map(|part| part / volume);
    Some([1.0 - u - v - w, u, v, w])
}

/// The value inside a tetrahedron. Where values at corners are not finite, the nearest corner
/// decides: a value that is not finite stays, and one that is counts with the other finite ones.
pub(crate) fn interpolate(values: [f64; 4], weights: [f64; 4]) -> f64 {
    if values.iter().all(|value| value.is_finite()) {
        // About one corner: a field that is constant there stays so to the last bit.
        let sum: f64 = (1..4).map(|i| weights[i] * (values[i] - values[0])).sum();
        let value = sum + values[0];
        // Differences of the largest numbers overflow.
        let mean = || values.iter().zip(weights).map(|(value, weight)| weight * value).sum::<f64>();
        return if value.is_finite() { value } else { mean().clamp(-f64::MAX, f64::MAX) };
    }
    let nearest = largest(weights);
    if !values[nearest].is_finite() {
        return values[nearest];
    }
    let finite = || values.iter().zip(weights).filter(|(value, _)| value.is_finite());
    let sum: f64 = finite().map(|(_, weight)| weight.max(0.0)).sum();
    finite().map(|(value, weight)| weight.max(0.0) / sum * value).sum()
}

/// The corner with the largest weight, the first of several.
pub(crate) fn largest(weights: [f64; 4]) -> usize {
    (1..4).fold(0, |largest, i| if weights[i] > weights[largest] { i } else { largest })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_weigh_the_corners() {
        let corners = [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 4.0, 0.0], [1.0, 0.0, 8.0]];
        assert_eq!(barycentric([2.0, 1.0, 1.0], corners), Some([0.125, 0.5, 0.25, 0.125]));
        assert_eq!(barycentric(corners[2], corners), Some([0.0, 0.0, 1.0, 0.0]));
        assert_eq!(barycentric([0.0; 3], [corners[0], corners[1], corners[2], [7.0, 9.0, 0.0]]), None);
    }

    #[test]
    fn a_linear_field_is_interpolated_exactly() {
        let corners = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 8.0]];
        let field = |[x, y, z]: Vector| 1.0 + x - 2.0 * y + 4.0 * z;
        let point = [0.5, 0.25, 0.125];
        let weights = barycentric(point, corners).unwrap();
        assert_eq!(interpolate(corners.map(field), weights), field(point));
        assert_eq!(barycentric(point, [[0.0; 3], [1.0; 3], [2.0; 3], [3.0, 0.0, 0.0]]), None);
    }

    #[test]
    fn values_that_are_not_finite_stay_where_they_are_the_nearest() {
        const NAN: f64 = f64::NAN;
        assert_eq!(interpolate([NAN, 2.0, 4.0, NAN], [0.1, 0.6, 0.2, 0.1]), 2.5);
        assert!(interpolate([NAN, 2.0, 4.0, 1.0], [0.4, 0.3, 0.2, 0.1]).is_nan());
        assert_eq!(interpolate([f64::INFINITY, 2.0, 4.0, 1.0], [0.4, 0.3, 0.2, 0.1]), f64::INFINITY);
        let huge = [f64::MAX, -f64::MAX, f64::MAX, -f64::MAX];
        assert_eq!(interpolate(huge, [0.5, 0.5, 0.0, 0.0]), 0.0);
    }
}
