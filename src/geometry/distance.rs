//! Closest points and squared distances between points, segments and triangles.
//!
//! The textbook way to a triangle's closest point decides one of seven Voronoi regions from signs
//! of 2 x 2 determinants (Ericson, *Real-Time Collision Detection*, 2005, section 5.1.5). On a
//! needle those signs are rounding noise and the answer can be any point of it. Here the three
//! edges are always candidates, each a clamped projection that cannot go wrong, and the foot of the
//! perpendicular is one more where it falls inside. Segments likewise: the four end points always
//! compete with the interior solution.
//!
//! Consequences that the proofs rest on, for finite input of magnitude at most `m` (any `f32`, sums
//! and differences of them), with `eps = f64::EPSILON`:
//! * every answer is the distance to a point *of* the triangle or segment, so it falls below the
//!   true distance by at most `16 eps m`;
//! * it exceeds the true distance by about as much, except that for a triangle with
//!   `sin(angle at a) = s` the foot may be off sideways by `eps m / s`, and never by more than the
//!   radius of the inscribed circle;
//! * degenerate triangles and segments (collinear, coincident corners) need no case of their own.

use super::vector::{Vector, add_scaled, cross, dot, length_sq, sub};

/// Corners of a triangle.
pub(crate) type Triangle = [Vector; 3];

/// End points of a segment.
pub(crate) type Segment = [Vector; 2];

/// If the angle at the first corner of a triangle has a squared sine below this, its edges are
/// compared too, even if the foot of the perpendicular seems to be inside.
const NEEDLE_SINE_SQ: f64 = 1e-6;

/// Squared distance between a point and a segment.
#[inline(always)]
pub(crate) fn point_segment_distance_sq(p: Vector, [a, b]: Segment) -> f64 {
    let (ab, ap) = (sub(b, a), sub(p, a));
    length_sq(add_scaled(ap, -foot_on_edge(ab, ap), ab))
}

/// Point of a segment that is closest to `p`.
#[inline(always)]
pub(crate) fn closest_on_segment(p: Vector, [a, b]: Segment) -> Vector {
    let ab = sub(b, a);
    add_scaled(a, foot_on_edge(ab, sub(p, a)), ab)
}

/// Squared distance between a point and a triangle.
#[inline(always)]
pub(crate) fn point_triangle_distance_sq(p: Vector, [a, b, c]: &Triangle) -> f64 {
    let (ab, ac, ap) = (sub(*b, *a), sub(*c, *a), sub(p, *a));
    let foot = foot_inside(ab, ac, ap);
    let inside_sq = match foot {
        Some((v, w, needle)) => {
            let inside_sq = length_sq(add_scaled(add_scaled(ap, -v, ab), -w, ac));
            if !needle {
                return inside_sq;
            }
            inside_sq
        }
        None => f64::INFINITY,
    };
    let (bc, bp) = (sub(*c, *b), sub(p, *b));
    let ab_sq = length_sq(add_scaled(ap, -foot_on_edge(ab, ap), ab));
    let bc_sq = length_sq(add_scaled(bp, -foot_on_edge(bc, bp), bc));
    let ac_sq = length_sq(add_scaled(ap, -foot_on_edge(ac, ap), ac));
    ab_sq.min(bc_sq).min(ac_sq).min(inside_sq)
}

/// Point of a triangle that is closest to `p`: what its distance is tested against.
#[cfg(test)]
fn closest_on_triangle(p: Vector, triangle: &Triangle) -> Vector {
    let [wa, wb, wc] = closest_weights(p, triangle);
    let [a, b, c] = *triangle;
    // The corner of largest weight is the base, so that a point on a corner or an edge is exact.
    if wa >= wb && wa >= wc {
        add_scaled(add_scaled(a, wb, sub(b, a)), wc, sub(c, a))
    } else if wb >= wc {
        add_scaled(add_scaled(b, wa, sub(a, b)), wc, sub(c, b))
    } else {
        add_scaled(add_scaled(c, wa, sub(a, c)), wb, sub(b, c))
    }
}

/// Barycentric weights, none negative and with sum 1, of the point of a triangle that is closest to
/// `p`.
#[inline]
pub(crate) fn closest_weights(p: Vector, [a, b, c]: &Triangle) -> [f64; 3] {
    let (ab, ac, ap) = (sub(*b, *a), sub(*c, *a), sub(p, *a));
    let mut best_sq = f64::INFINITY;
    let mut weights = [1.0, 0.0, 0.0];
    if let Some((v, w, needle)) = foot_inside(ab, ac, ap) {
        weights = [(1.0 - v - w).max(0.0), v, w];
        if !needle {
            return weights;
        }
        best_sq = length_sq(add_scaled(add_scaled(ap, -v, ab), -w, ac));
    }
    let (bc, bp) = (sub(*c, *b), sub(p, *b));
    let (t_ab, t_bc, t_ac) = (foot_on_edge(ab, ap), foot_on_edge(bc, bp), foot_on_edge(ac, ap));
    let ab_sq = length_sq(add_scaled(ap, -t_ab, ab));
    let bc_sq = length_sq(add_scaled(bp, -t_bc, bc));
    let ac_sq = length_sq(add_scaled(ap, -t_ac, ac));
    if ab_sq < best_sq {
        (best_sq, weights) = (ab_sq, [1.0 - t_ab, t_ab, 0.0]);
    }
    if bc_sq < best_sq {
        (best_sq, weights) = (bc_sq, [0.0, 1.0 - t_bc, t_bc]);
    }
    if ac_sq < best_sq {
        weights = [1.0 - t_ac, 0.0, t_ac];
    }
    weights
}

/// Squared distance between two segments.
#[inline(always)]
pub(crate) fn segment_segment_distance_sq(first: Segment, second: Segment) -> f64 {
    let ends_sq = point_segment_distance_sq(first[0], second)
        .min(point_segment_distance_sq(first[1], second))
        .min(point_segment_distance_sq(second[0], first))
        .min(point_segment_distance_sq(second[1], first));
    match feet_inside(first, second) {
        Some((s, t)) => ends_sq.min(length_sq(gap(first, second, s, t))),
        None => ends_sq,
    }
}

/// The point of the first segment and the point of the second that are closest to each other: what
/// their distance is tested against.
#[cfg(test)]
fn closest_between_segments(first: Segment, second: Segment) -> (Vector, Vector) {
    let ([a, b], [c, d]) = (first, second);
    let (ab, cd) = (sub(b, a), sub(d, c));
    let candidates = [
        Some((0.0, foot_on_edge(cd, sub(a, c)))),
        Some((1.0, foot_on_edge(cd, sub(b, c)))),
        Some((foot_on_edge(ab, sub(c, a)), 0.0)),
        Some((foot_on_edge(ab, sub(d, a)), 1.0)),
        feet_inside(first, second),
    ];
    let mut best_sq = f64::INFINITY;
    let mut best = (0.0, 0.0);
    for (s, t) in candidates.into_iter().flatten() {
        let gap_sq = length_sq(gap(first, second, s, t));
        if gap_sq < best_sq {
            (best_sq, best) = (gap_sq, (s, t));
        }
    }
    (add_scaled(a, best.0, ab), add_scaled(c, best.1, cd))
}

/// Parameter in `[0, 1]` of the point closest to `a + ap` on the segment from `a` to `a + ab`; 0 if
/// `ab` is zero.
#[expect(clippy::manual_clamp, reason = "clamp would let the NaN of 0 / 0 through, max turns it into 0")]
#[inline(always)]
fn foot_on_edge(ab: Vector, ap: Vector) -> f64 {
    (dot(ab, ap) / length_sq(ab)).max(0.0).min(1.0)
}

/// Weights `v`, `w` of the perpendicular's foot `a + v ab + w ac` if it lies inside the triangle,
/// and whether the triangle is too thin to trust them.
#[inline(always)]
fn foot_inside(ab: Vector, ac: Vector, ap: Vector) -> Option<(f64, f64, bool)> {
    // Cross products lose a factor `1 / sin` of accuracy, the usual Gram determinants its square.
    let normal = cross(ab, ac);
    let normal_sq = length_sq(normal);
    let v = dot(cross(ap, ac), normal);
    let w = dot(cross(ab, ap), normal);
    // A triangle without area has normal_sq == 0 and is not inside by the first comparison.
    if normal_sq > 0.0 && v >= 0.0 && w >= 0.0 && v + w <= normal_sq {
        let needle = normal_sq < NEEDLE_SINE_SQ * (length_sq(ab) * length_sq(ac));
        Some((v / normal_sq, w / normal_sq, needle))
    } else {
        None
    }
}

/// Parameters of the two lines' closest points if both lie inside their segments.
#[inline(always)]
fn feet_inside([a, b]: Segment, [c, d]: Segment) -> Option<(f64, f64)> {
    let (ab, cd, ac) = (sub(b, a), sub(d, c), sub(c, a));
    let normal = cross(ab, cd);
    let normal_sq = length_sq(normal);
    let s = dot(cross(ac, cd), normal);
    let t = dot(cross(ac, ab), normal);
    let is_inside = normal_sq > 0.0 && s >= 0.0 && s <= normal_sq && t >= 0.0 && t <= normal_sq;
    is_inside.then(|| (s / normal_sq, t / normal_sq))
}

/// Vector from the second segment's point at `t` to the first segment's point at `s`.
#[inline(always)]
fn gap([a, b]: Segment, [c, d]: Segment, s: f64, t: f64) -> Vector {
    add_scaled(add_scaled(sub(a, c), s, sub(b, a)), -t, sub(d, c))
}

/// Parameter on the line of `first`, unclamped at best effort, at which it is nearest to `second`.
pub(crate) fn nearest_parameter([a, b]: Segment, [c, d]: Segment) -> f64 {
    let (u, v, w) = (sub(b, a), sub(d, c), sub(a, c));
    let (uu, uv, vv) = (length_sq(u), dot(u, v), length_sq(v));
    let (uw, vw) = (dot(u, w), dot(v, w));
    let determinant = uu * vv - uv * uv;
    let s =
        if determinant > 1e-12 * uu * vv { ((uv * vw - vv * uw) / determinant).clamp(0.0, 1.0) } else { 0.5 };
    let t = (uv * s + vw) / vv;
    if t < 0.0 {
        -uw / uu
    } else if t > 1.0 {
        (uv - uw) / uu
    } else {
        s
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::prepared::PreparedTriangle;
    use crate::geometry::vector::{add, distance_sq, midpoint, scale};

    const UNIT: Triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// Least distance to a triangle, by golden-section search in both barycentric directions: a
    /// convex minimisation that shares nothing with the regions above.
    fn naive_triangle_distance(p: Vector, [a, b, c]: Triangle) -> f64 {
        let along = |t: f64| naive_segment_distance(p, [lerp(a, b, t), lerp(a, c, t)]);
        golden_section(along)
    }

    fn naive_segment_distance(p: Vector, [a, b]: Segment) -> f64 {
        golden_section(|t| distance_sq(p, lerp(a, b, t)).sqrt())
    }

    fn lerp(a: Vector, b: Vector, t: f64) -> Vector {
        add_scaled(scale(a, 1.0 - t), t, b)
    }

    fn golden_section(f: impl Fn(f64) -> f64) -> f64 {
        let ratio = (5f64.sqrt() - 1.0) / 2.0;
        let (mut low, mut high) = (0.0, 1.0);
        let mut x = [high - ratio * (high - low), low + ratio * (high - low)];
        let mut y = [f(x[0]), f(x[1])];
        for _ in 0..64 {
            if y[0] <= y[1] {
                high = x[1];
                x = [high - ratio * (high - low), x[0]];
                y = [f(x[0]), y[0]];
            } else {
                low = x[0];
                x = [x[1], low + ratio * (high - low)];
                y = [y[1], f(x[1])];
            }
        }
        y[0].min(y[1]).min(f(0.0)).min(f(1.0))
    }

    fn check_triangle(p: Vector, triangle: Triangle, expected: f64) {
        let found = point_triangle_distance_sq(p, &triangle).sqrt();
        assert!((found - expected).abs() < 1e-12, "found {found}, expected {expected}");
        let prepared = PreparedTriangle::new(&triangle).distance_sq(p).sqrt();
        assert!((prepared - expected).abs() < 1e-12, "prepared {prepared}, expected {expected}");
        let point = closest_on_triangle(p, &triangle);
        assert!((distance_sq(p, point).sqrt() - expected).abs() < 1e-12, "closest point {point:?}");
    }

    #[test]
    fn every_region_of_a_triangle() {
        check_triangle([0.25, 0.25, 3.0], UNIT, 3.0);
        check_triangle([0.25, 0.25, 0.0], UNIT, 0.0);
        check_triangle([-3.0, -4.0, 0.0], UNIT, 5.0);
        check_triangle([4.0, 0.0, 4.0], UNIT, 5.0);
        check_triangle([0.0, 4.0, -4.0], UNIT, 5.0);
        check_triangle([0.5, -3.0, 4.0], UNIT, 5.0);
        check_triangle([-3.0, 0.5, 4.0], UNIT, 5.0);
        check_triangle([1.0, 1.0, 0.0], UNIT, 0.5f64.sqrt());
    }

    #[test]
    fn degenerate_triangles_are_their_segments_and_points() {
        let point = [[1.0, 2.0, 3.0]; 3];
        check_triangle([1.0, 2.0, 5.0], point, 2.0);
        let [a, b] = [[0.0, 0.0, 0.0], [3.0, 3.0, 0.0]];
        let inner = [1.0, 1.0, 0.0];
        for segment in [[a, b, inner], [inner, a, b], [b, inner, a], [a, a, b], [a, b, b], [b, a, b]] {
            check_triangle([2.0, 2.0, 7.0], segment, 7.0);
            check_triangle([4.0, 3.0, 0.0], segment, 1.0);
            check_triangle([0.0, 2.0, 0.0], segment, 2f64.sqrt());
        }
    }

    #[test]
    fn a_needle_does_not_lose_its_ends() {
        for height in [1e-4, 1e-7, 1e-9, 1e-12, 1e-15, 1e-18] {
            let needle = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.3], [0.5, 0.05 + height, 0.15]];
            for t in 0..=100 {
                let on_edge = scale(needle[1], f64::from(t) / 100.0);
                let found = point_triangle_distance_sq(on_edge, &needle).sqrt();
                assert!(found < 1e-14, "height {height:e}, t {t}: {found:e}");
            }
        }
    }

    #[test]
    fn extreme_magnitudes_neither_overflow_nor_vanish() {
        for magnitude in [f64::from(f32::MAX), 1e30, 1e-30, f64::from(f32::MIN_POSITIVE)] {
            let triangle = UNIT.map(|corner| scale(corner, magnitude));
            let p = scale([0.25, 0.25, 1.0], magnitude);
            let found = point_triangle_distance_sq(p, &triangle).sqrt();
            assert!((found / magnitude - 1.0).abs() < 1e-14, "{magnitude:e}: {found:e}");
        }
    }

    #[test]
    fn parallel_crossing_and_degenerate_segments() {
        let check = |first: Segment, second: Segment, expected: f64| {
            let found = segment_segment_distance_sq(first, second).sqrt();
            assert!((found - expected).abs() < 1e-12, "found {found}, expected {expected}");
            let (on_first, on_second) = closest_between_segments(first, second);
            assert!((distance_sq(on_first, on_second).sqrt() - expected).abs() < 1e-12);
        };
        let x_axis = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        check(x_axis, [[0.5, -1.0, 2.0], [0.5, 1.0, 2.0]], 2.0);
        check(x_axis, [[0.5, -1.0, 0.0], [0.5, 1.0, 0.0]], 0.0);
        check(x_axis, [[-5.0, 0.0, 3.0], [9.0, 0.0, 3.0]], 3.0);
        check(x_axis, [[4.0, 0.0, 4.0], [9.0, 0.0, 4.0]], 5.0);
        check(x_axis, [[2.0, 0.0, 0.0], [3.0, 0.0, 0.0]], 1.0);
        check(x_axis, [[0.5, 3.0, 0.0]; 2], 3.0);
        check([[0.5, 3.0, 0.0]; 2], x_axis, 3.0);
        check([[1.0; 3]; 2], [[1.0, 1.0, 4.0]; 2], 3.0);
    }

    fn vector() -> impl Strategy<Value = Vector> {
        prop::array::uniform3(-1.0..1.0)
    }

    /// Triangles of every shape, half of them flat or nearly so.
    fn triangle() -> impl Strategy<Value = Triangle> {
        let heights = prop_oneof![Just(1.0), Just(0.0), Just(1e-3), Just(1e-6), Just(1e-9), Just(1e-14)];
        (vector(), vector(), vector(), -0.5..1.5, heights, 0..3usize).prop_map(
            |(a, b, c, t, height, turn)| {
                let base = lerp(a, b, t);
                let mut corners = [a, b, add_scaled(base, height, sub(c, base))];
                corners.rotate_left(turn);
                corners
            },
        )
    }

    proptest! {
        #[test]
        fn triangle_distance_agrees_with_minimisation(p in vector(), triangle in triangle()) {
            let found = point_triangle_distance_sq(p, &triangle).sqrt();
            let expected = naive_triangle_distance(p, triangle);
            prop_assert!((found - expected).abs() < 2e-8, "found {}, expected {}", found, expected);
        }

        #[test]
        fn preparing_changes_nothing(p in vector(), triangle in triangle()) {
            let plain = point_triangle_distance_sq(p, &triangle).sqrt();
            let prepared = PreparedTriangle::new(&triangle);
            let mut many = [f64::NAN; 3];
            prepared.distances_sq([&[p[0]; 3], &[p[1]; 3], &[p[2]; 3]], &mut many);
            prop_assert!(many.iter().all(|found| (found.sqrt() - plain).abs() < 1e-12), "many {:?}", many);
            let prepared = prepared.distance_sq(p).sqrt();
            // A foot beside a needle may be off by rounding over its sine, 1e-3 at least where the
            // edges are not asked.
            prop_assert!((plain - prepared).abs() < 1e-12, "plain {}, prepared {}", plain, prepared);
        }

        #[test]
        fn closest_point_is_on_the_triangle_and_at_its_distance(p in vector(), triangle in triangle()) {
            let found = point_triangle_distance_sq(p, &triangle).sqrt();
            let weights = closest_weights(p, &triangle);
            prop_assert!(weights.iter().all(|weight| (0.0..=1.0).contains(weight)));
            prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            let point = closest_on_triangle(p, &triangle);
            prop_assert!((distance_sq(p, point).sqrt() - found).abs() < 1e-14);
        }

        #[test]
        fn no_sample_of_the_triangle_is_closer(p in vector(), triangle in triangle()) {
            let found = point_triangle_distance_sq(p, &triangle).sqrt();
            let n = 24;
            for i in 0..=n {
                for j in 0..=(n - i) {
                    let (v, w) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                    let [a, b, c] = triangle;
                    let sample = add(scale(a, 1.0 - v - w), add(scale(b, v), scale(c, w)));
                    prop_assert!(distance_sq(p, sample).sqrt() > found - 1e-8);
                }
            }
        }

        #[test]
        fn distance_is_convex_along_a_segment(p in vector(), q in vector(), triangle in triangle()) {
            let at = |point| point_triangle_distance_sq(point, &triangle).sqrt();
            prop_assert!(at(midpoint(p, q)) <= at(p).max(at(q)) + 1e-14);
        }

        #[test]
        fn segment_distance_agrees_with_minimisation(
            a in vector(), b in vector(), c in vector(), d in vector(), parallel in prop::bool::ANY,
        ) {
            let d = if parallel { add_scaled(c, 0.7, sub(b, a)) } else { d };
            let found = segment_segment_distance_sq([a, b], [c, d]).sqrt();
            let expected = golden_section(|s| naive_segment_distance(lerp(a, b, s), [c, d]));
            prop_assert!((found - expected).abs() < 2e-8, "found {}, expected {}", found, expected);
            let (on_first, on_second) = closest_between_segments([a, b], [c, d]);
            prop_assert!((distance_sq(on_first, on_second).sqrt() - found).abs() < 1e-14);
        }
    }
}
