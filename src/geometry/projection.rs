//! The fourteen planes onto which the border of a hole is projected, in the order of the paper
//! (JADE, section 6).

use crate::geometry::vector::{Vector, cross, dot, length_sq, scale, sub};

/// A point of a projected border.
pub(crate) type Point2 = [f64; 2];

const H: f64 = std::f64::consts::FRAC_1_SQRT_2;
const T: f64 = 0.577_350_269_189_625_8;

/// Normals of the planes after the average plane: three axes, six bisectors of axis pairs, four
/// octant diagonals.
const FIXED_NORMALS: [Vector; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [H, H, 0.0],
    [H, -H, 0.0],
    [0.0, H, H],
    [0.0, H, -H],
    [H, 0.0, H],
    [-H, 0.0, H],
    [T, T, T],
    [-T, T, T],
    [T, -T, T],
    [T, T, -T],
];

/// Normals of the fourteen planes: the average plane first, unless the star has no area.
pub(crate) fn plane_normals(average: Vector) -> impl Iterator<Item = Vector> {
    let size_sq = length_sq(average);
    let unit = (size_sq > 0.0 && size_sq.is_finite()).then(|| scale(average, 1.0 / size_sq.sqrt()));
    unit.into_iter().chain(FIXED_NORMALS)
}

/// A plane through the origin with two axes, right-handed with its normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProjectionPlane {
    axes: [Vector; 2],
}

impl ProjectionPlane {
    /// The plane with the given unit normal.
    pub(crate) fn new(normal: Vector) -> Self {
        let [x, y, z] = normal.map(f64::abs);
        let other = if x <= y && x <= z {
            [1.0, 0.0, 0.0]
        } else if y <= z {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
        let across = sub(other, scale(normal, dot(normal, other)));
        let first = scale(across, 1.0 / length_sq(across).sqrt());
        Self { axes: [first, cross(normal, first)] }
    }

    /// Coordinates of `p` in the plane, relative to `origin`.
    #[inline]
    pub(crate) fn project(&self, p: Vector, origin: Vector) -> Point2 {
        let d = sub(p, origin);
        [dot(d, self.axes[0]), dot(d, self.axes[1])]
    }
}

/// Twice the signed area of the triangle `a b c`: positive if it turns left.
#[inline]
pub(crate) fn turn(a: Point2, b: Point2, c: Point2) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Twice the signed area of a polygon.
pub(crate) fn polygon_area(polygon: &[Point2]) -> f64 {
    let Some((&first, rest)) = polygon.split_first() else { return 0.0 };
    rest.windows(2).map(|pair| turn(first, pair[0], pair[1])).sum()
}

/// Whether no two edges of the polygon meet, apart from neighbours at their common corner. O(n^2).
pub(crate) fn is_simple(polygon: &[Point2]) -> bool {
    let n = polygon.len();
    let edge = |i: usize| (polygon[i], polygon[if i + 1 == n { 0 } else { i + 1 }]);
    (0..n).all(|i| (i + 2..n).filter(|&j| !(i == 0 && j + 1 == n)).all(|j| !segments_meet(edge(i), edge(j))))
}

/// Whether two closed segments have a point in common.
fn segments_meet((a, b): (Point2, Point2), (c, d): (Point2, Point2)) -> bool {
    let (abc, abd, cda, cdb) = (turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b));
    if ((abc > 0.0) != (abd > 0.0)) && ((cda > 0.0) != (cdb > 0.0)) && abc != 0.0 && abd != 0.0 {
        return true;
    }
    (abc == 0.0 && is_between(c, a, b))
        || (abd == 0.0 && is_between(d, a, b))
        || (cda == 0.0 && is_between(a, c, d))
        || (cdb == 0.0 && is_between(b, c, d))
}

/// Whether `p`, on the line `a b`, lies in its bounding box.
fn is_between(p: Point2, a: Point2, b: Point2) -> bool {
    (0..2).all(|axis| a[axis].min(b[axis]) <= p[axis] && p[axis] <= a[axis].max(b[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_fourteen_distinct_unit_normals() {
        let normals: Vec<Vector> = plane_normals([1.0, 2.0, 3.0]).collect();
        assert_eq!(normals.len(), 14);
        for (i, &a) in normals.iter().enumerate() {
            assert!((length_sq(a) - 1.0).abs() < 1e-12);
            assert!(normals[..i].iter().all(|&b| dot(a, b).abs() < 0.999), "{a:?} repeats");
        }
        assert_eq!(plane_normals([0.0; 3]).count(), 13);
    }

    #[test]
    fn projection_keeps_the_turn_seen_from_the_normal() {
        for normal in plane_normals([0.3, -0.5, 0.9]) {
            let plane = ProjectionPlane::new(normal);
            let [u, v] = plane.axes;
            assert!((dot(cross(u, v), normal) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn simple_polygons_are_told_from_crossed_and_touching_ones() {
        assert!(is_simple(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]]));
        assert!(!is_simple(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]));
        assert!(!is_simple(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]]));
    }
}
