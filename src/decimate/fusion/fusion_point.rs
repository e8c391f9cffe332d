//! The point to which a tetrahedron is fused: the minimum of its quadric (equation 6 of the paper).

use super::metric::Quadric;
use crate::geometry::vector::{Vector, dot};

/// Systems whose condition number may exceed this are not solved, because the solution would be
/// rounding.
const MAX_CONDITION: f64 = 1e10;

/// The minimum of the quadric; `None` if the condition number of its system may exceed `1e10`, not
/// only if its determinant is zero.
///
/// For eigenvalues `l1 >= l2 >= l3` of `A`, the trace is at least `l1`, the sum of the principal
/// minors at least `l1 l2`, and the determinant is their product. So `trace * minors / determinant`
/// is at least the condition number `l1 / l3`, and at most nine times that.
pub(super) fn least_point(quadric: &Quadric) -> Option<Vector> {
    let [xx, xy, xz, yy, yz, zz] = quadric.a;
    // The adjugate, row by row.
    let [ax, ay, az] = [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy];
    let [by, bz, cz] = [xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy];
    let determinant = xx * ax + xy * ay + xz * az;
    let trace = xx + yy + zz;
    let minors = ax + by + cz;
    let is_solvable = determinant > 0.0 && trace * minors <= MAX_CONDITION * determinant;
    is_solvable.then(|| {
        let rows = [[ax, ay, az], [ay, by, bz], [az, bz, cz]];
        rows.map(|row| -dot(row, quadric.b) / determinant)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadric(a: [f64; 6], point: Vector) -> Quadric {
        let [xx, xy, xz, yy, yz, zz] = a;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        Quadric { a, b: rows.map(|row| -dot(row, point)), c: 0.0 }
    }

    #[test]
    fn the_least_point_is_found() {
        let point = [0.25, -3.0, 7.0];
        let found = least_point(&quadric([4.0, 1.0, -0.5, 3.0, 0.25, 2.0], point)).unwrap();
        assert!((0..3).all(|i| (found[i] - point[i]).abs() < 1e-12));
    }

    #[test]
    fn badly_conditioned_systems_are_refused() {
        let stretched = |least| least_point(&quadric([1.0, 0.0, 0.0, 1.0, 0.0, least], [1.0; 3]));
        assert!(stretched(1e-9).is_some());
        // The determinant is not zero.
        assert!(stretched(1e-12).is_none());
        assert!(stretched(0.0).is_none());
        assert!(stretched(-1.0).is_none());
        assert!(least_point(&Quadric::default()).is_none());
    }
}
