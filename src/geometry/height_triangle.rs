//! Triangles for points that mostly lie over them: their distance is a height.

use super::distance::{Triangle, point_triangle_distance_sq};
use super::vector::{Vector, cross, distance_sq, dot, length_sq, sub};

/// A corner's angle whose sine is at least the root of this leaves a normal that is exact to a
/// dozen digits.
const SOUND_SINE_SQ: f64 = 1e-6;

/// A triangle with its normal. Cheaper to make than a
/// [`PreparedTriangle`](super::prepared::PreparedTriangle), which pays for itself with many points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeightTriangle {
    corners: Triangle,
    edges: [Vector; 2],
    /// As long as twice the area.
    normal: Vector,
    normal_sq: f64,
    per_normal_sq: f64,
    /// In the plane, perpendicular to the edges at the first corner.
    across: [Vector; 2],
}

impl HeightTriangle {
    /// Prepares a triangle.
    #[inline(always)]
    pub(crate) fn new(corners: Triangle) -> Self {
        let [ab, ac] = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
        let normal = cross(ab, ac);
        let normal_sq = length_sq(normal);
        let across = [cross(ac, normal), cross(normal, ab)];
        Self { corners, edges: [ab, ac], normal, normal_sq, per_normal_sq: 1.0 / normal_sq, across }
    }

    /// Whether the triangle's aspect, `4 sqrt(3) area / sum of squared edges`, is below `least`.
    pub(crate) fn is_thinner(&self, least: f64) -> bool {
        let [ab, ac] = self.edges;
        let edges_sq = length_sq(ab) + distance_sq(self.corners[1], self.corners[2]) + length_sq(ac);
        12.0 * self.normal_sq < (least * edges_sq).powi(2) || edges_sq <= 0.0
    }

    /// Whether heights over it are as exact as other distances: to a dozen digits of the largest
    /// coordinate.
    pub(crate) fn is_sound(&self) -> bool {
        let [ab, ac] = self.edges;
        self.normal_sq > SOUND_SINE_SQ * length_sq(ab) * length_sq(ac)
    }

    /// Squared height of a point over the triangle, which is its squared distance; `None` if the
    /// foot of the perpendicular is outside.
    #[inline(always)]
    pub(crate) fn height_sq(&self, p: Vector) -> Option<f64> {
        let ap = sub(p, self.corners[0]);
        let [v, w] = self.across.map(|axis| dot(ap, axis));
        (v >= 0.0 && w >= 0.0 && v + w <= self.normal_sq).then(|| {
            let height = dot(ap, self.normal);
            height * height * self.per_normal_sq
        })
    }

    /// Squared distance of a point. Of a triangle that is not [sound](Self::is_sound) it is good
    /// enough to choose by, not to prove with.
    #[inline(always)]
    pub(crate) fn distance_sq(&self, p: Vector) -> f64 {
        self.height_sq(p).unwrap_or_else(|| point_triangle_distance_sq(p, &self.corners))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vector> {
        prop::array::uniform3(-1.0_f64..1.0)
    }

    proptest! {
        #[test]
        fn heights_are_distances(corners in prop::array::uniform3(vector()), p in vector(), flatness in -5_i32..1) {
            let [a, b, c] = corners;
            // Down to triangles that are hardly sound.
            let c = [0, 1, 2].map(|axis| b[axis] + 10_f64.powi(flatness) * (c[axis] - b[axis]));
            let triangle = HeightTriangle::new([a, b, c]);
            prop_assume!(triangle.is_sound());
            let distance = point_triangle_distance_sq(p, &[a, b, c]).sqrt();
            prop_assert!((triangle.distance_sq(p).sqrt() - distance).abs() < 1e-9);
        }
    }

    #[test]
    fn only_over_the_triangle_is_there_a_height() {
        let triangle = HeightTriangle::new([[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
        assert_eq!(triangle.height_sq([0.5, 0.5, -3.0]), Some(9.0));
        assert_eq!(triangle.height_sq([1.5, 1.0, 3.0]), None);
        assert_eq!(triangle.height_sq([-0.1, 1.0, 3.0]), None);
        assert_eq!(triangle.distance_sq([-1.0, 1.0, 0.0]), 1.0);
        assert!(triangle.is_sound());
    }

    #[test]
    fn needles_are_not_sound() {
        assert!(!HeightTriangle::new([[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1e-4, 0.0]]).is_sound());
        assert!(!HeightTriangle::new([[0.0; 3]; 3]).is_sound());
    }
}
