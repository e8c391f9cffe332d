//! Convex pieces of a triangle, and how they are cut.

use crate::geometry::distance::{Segment, Triangle};
use crate::geometry::vector::{Vector, add_scaled, distance_sq, sub};

/// Corners that a polygon has at most.
const MAX_CORNERS: usize = 8;

/// Most steps towards the point at which an edge crosses a line.
const MAX_STEPS: usize = 10;

/// Part of the range below which the root of a value counts as zero.
const CLOSE: f64 = 1e-5;

/// A convex polygon in the plane of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polygon {
    corners: [Vector; MAX_CORNERS],
    len: usize,
}

impl From<Triangle> for Polygon {
    fn from([a, b, c]: Triangle) -> Self {
        let mut corners = [a; MAX_CORNERS];
        (corners[1], corners[2]) = (b, c);
        Self { corners, len: 3 }
    }
}

impl Polygon {
    /// The corners, in order around the polygon.
    #[inline(always)]
    pub(super) fn corners(&self) -> &[Vector] {
        &self.corners[..self.len]
    }

    /// Cuts the polygon by the straight line through two points at which a continuous function
    /// changes its sign along the boundary. Returns the part with the first corner above zero, and
    /// the other. A function that grows like a signed square suits best. Values within `close`
    /// count as zero. `None` if the function does not change its sign, or if a part would have too
    /// many corners.
    pub(super) fn cut_at_sign_change(&self, close: f64, f: impl Fn(Vector) -> f64) -> Option<[Self; 2]> {
        let mut values = [0.0; MAX_CORNERS];
        for (value, &corner) in values.iter_mut().zip(self.corners()) {
            *value = f(corner);
        }
        let next = |i: usize| if i + 1 < self.len { i + 1 } else { 0 };
        let mut changes = (0..self.len).filter(|&i| (values[i] > 0.0) != (values[next(i)] > 0.0));
        let (first, second) = (changes.next()?, changes.next()?);
        // Each part has the corners on its side of the sign changes, and two more.
        let n_between = second - first;
        if n_between.max(self.len - n_between) + 2 > MAX_CORNERS {
            return None;
        }
        let [p, q] = [first, second].map(|i| {
            crossing([self.corners[i], self.corners[next(i)]], [values[i], values[next(i)]], close, &f)
        });
        let mut parts = [Self { len: 0, ..*self }; 2];
        parts[0].push(p);
        (first + 1..=second).for_each(|i| parts[0].push(self.corners[i]));
        parts[0].push(q);
        parts[1].push(q);
        (second + 1..self.len).chain(0..=first).for_each(|i| parts[1].push(self.corners[i]));
        parts[1].push(p);
        if values[next(first)] <= 0.0 {
            parts.swap(0, 1);
        }
        Some(parts)
    }

    /// Cuts the polygon in the middle, across its largest extent. `None` if it is a point.
    pub(super) fn bisect(&self) -> Option<[Self; 2]> {
        let corners = self.corners();
        let mut ends = [corners[0]; 2];
        for (i, &a) in corners.iter().enumerate() {
            for &b in &corners[..i] {
                if distance_sq(a, b) > distance_sq(ends[0], ends[1]) {
                    ends = [a, b];
                }
            }
        }
        let f = |p: Vector| {
            let along = distance_sq(p, ends[0]) - distance_sq(p, ends[1]);
            along * along.abs()
        };
        self.cut_at_sign_change(0.0, f).or_else(|| self.cut_off_ear())
    }

    /// Cuts off half of the corners, for a polygon of which a part would have too many.
    fn cut_off_ear(&self) -> Option<[Self; 2]> {
        let middle = self.len / 2;
        (self.len > 3).then(|| {
            let mut parts = [Self { len: 0, ..*self }; 2];
            (0..=middle).for_each(|i| parts[0].push(self.corners[i]));
            (middle..self.len).chain([0]).for_each(|i| parts[1].push(self.corners[i]));
            parts
        })
    }

    fn push(&mut self, corner: Vector) {
        self.corners[self.len] = corner;
        self.len += 1;
    }
}

/// A point of a segment near which a function changes its sign, by regula falsi with the value at
/// the retained end halved (the Illinois method). Any point is valid; its rounding moves both sides
/// of the cut alike.
fn crossing([a, b]: Segment, values: [f64; 2], close: f64, f: impl Fn(Vector) -> f64) -> Vector {
    // Differences of squared distances change sign like their signed square roots, and these are
    // closer to linear.
    let root = |value: f64| value.signum() * value.abs().sqrt();
    let at = |t: f64| add_scaled(a, t, sub(b, a));
    let (mut low, mut high) = ((0.0, root(values[0])), (1.0, root(values[1])));
    let mut t = 0.5;
    for _ in 0..MAX_STEPS {
        t = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let square = f(at(t));
        let value = root(square);
        if square.abs() <= close || value.abs() <= CLOSE * (low.1 - high.1).abs() {
            break;
        }
        if (value > 0.0) == (low.1 > 0.0) {
            low = (t, value);
            high.1 *= 0.5;
        } else {
            high = (t, value);
            low.1 *= 0.5;
        }
    }
    at(if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::{cross, length};

    const TRIANGLE: Triangle = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 3.0, 1.0]];

    fn area(polygon: &Polygon) -> f64 {
        let corners = polygon.corners();
        let fan = corners.windows(2).map(|edge| cross(sub(edge[0], corners[0]), sub(edge[1], corners[0])));
        fan.map(|normal| 0.5 * length(normal)).sum()
    }

    #[test]
    fn parts_lie_on_their_sides_and_make_up_the_whole() {
        for cut_at in [0.5, 1.0, 2.5, 3.9] {
            let [above, below] = Polygon::from(TRIANGLE)
                .cut_at_sign_change(0.0, |p| (p[0] - cut_at) * (p[0] - cut_at).abs())
                .unwrap();
            assert!(above.corners().iter().all(|p| p[0] >= cut_at - 1e-4));
            assert!(below.corners().iter().all(|p| p[0] <= cut_at + 1e-4));
            assert!((area(&above) + area(&below) - 6.0).abs() < 1e-12);
        }
        assert!(Polygon::from(TRIANGLE).cut_at_sign_change(0.0, |p| p[0] + 1.0).is_none());
    }

    #[test]
    fn bisecting_goes_on_for_ever() {
        let mut polygons = vec![Polygon::from(TRIANGLE)];
        for _ in 0..12 {
            polygons = polygons.iter().flat_map(|polygon| polygon.bisect().unwrap()).collect();
        }
        assert!((polygons.iter().map(area).sum::<f64>() - 6.0).abs() < 1e-9);
        let extent = |polygon: &Polygon| {
            let [a, .., b] = polygon.corners() else { return 0.0 };
            length(sub(*a, *b))
        };
        assert!(polygons.iter().all(|polygon| extent(polygon) < 0.5));
    }

    #[test]
    fn a_point_is_not_bisected() {
        assert!(Polygon::from([[1.0; 3]; 3]).bisect().is_none());
    }
}
