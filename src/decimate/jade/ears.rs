//! Triangulating a polygon in the plane by cutting ears (JADE, section 6).

use crate::geometry::projection::{Point2, turn};

/// Which ear is cut next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EarOrder {
    /// The one with the smallest angle: the paper's minimum angle triangulation.
    MinimumAngle,
    /// The first one found, going round: plain ear cutting, the paper's fallback.
    First,
}

/// Cuts a simple, counter-clockwise polygon into `n - 2` triangles and appends them to `triangles`.
///
/// `corners[i]` is the name under which corner `i` appears in the output; it is used up. Returns
/// whether it succeeded: rounding can leave a polygon without an ear. O(n^3) at worst; n is a
/// valence.
pub(crate) fn cut_ears(
    corners: &mut Vec<u8>,
    point: impl Fn(u8) -> Point2,
    order: EarOrder,
    triangles: &mut Vec<[u8; 3]>,
) -> bool {
    while corners.len() > 3 {
        let Some(ear) = find_ear(corners, &point, order) else { return false };
        triangles.push(ear_at(corners, ear));
        corners.remove(ear);
    }
    let last = ear_at(corners, 1);
    triangles.push(last);
    turn(point(last[0]), point(last[1]), point(last[2])) > 0.0
}

fn ear_at(corners: &[u8], at: usize) -> [u8; 3] {
    let n = corners.len();
    [corners[(at + n - 1) % n], corners[at], corners[(at + 1) % n]]
}

fn find_ear(corners: &[u8], point: &impl Fn(u8) -> Point2, order: EarOrder) -> Option<usize> {
    let ears = (0..corners.len()).filter(|&at| is_ear(corners, at, point));
    match order {
        EarOrder::First => { ears }.next(),
        EarOrder::MinimumAngle => ears
            .map(|at| (cosine(ear_at(corners, at).map(point)), at))
            .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
            .map(|(_, at)| at),
    }
}

/// Whether the corner is convex and no other corner lies in or on the triangle it makes with its
/// neighbours.
fn is_ear(corners: &[u8], at: usize, point: &impl Fn(u8) -> Point2) -> bool {
    let ear = ear_at(corners, at);
    let [a, b, c] = ear.map(point);
    turn(a, b, c) > 0.0
        && corners.iter().filter(|corner| !ear.contains(corner)).all(|&corner| {
            let p = point(corner);
            turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0
        })
}

/// Cosine of the angle at `b`, which falls as the angle grows.
fn cosine([a, b, c]: [Point2; 3]) -> f64 {
    let (u, v) = ([a[0] - b[0], a[1] - b[1]], [c[0] - b[0], c[1] - b[1]]);
    (u[0] * v[0] + u[1] * v[1]) / ((u[0] * u[0] + u[1] * u[1]) * (v[0] * v[0] + v[1] * v[1])).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::projection::polygon_area;
    use proptest::prelude::*;

    #[test]
    fn the_minimum_angle_goes_first() {
        let kite = [[0.0, 0.0], [4.0, -1.0], [10.0, 0.0], [4.0, 1.0]];
        let mut triangles = vec![];
        assert!(cut_ears(
            &mut vec![0, 1, 2, 3],
            |i| kite[i as usize],
            EarOrder::MinimumAngle,
            &mut triangles
        ));
        assert_eq!(triangles, [[1, 2, 3], [0, 1, 3]]);
    }

    proptest! {
        /// A star-shaped polygon is simple: its ears must add up to its area.
        #[test]
        fn ears_cover_the_polygon(radii in prop::collection::vec(0.2_f64..2.0, 3..20), first in any::<bool>()) {
            let n = radii.len();
            let polygon: Vec<Point2> = radii.iter().enumerate().map(|(i, r)| {
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                [r * angle.cos(), r * angle.sin()]
            }).collect();
            prop_assume!(n > 4 || crate::geometry::projection::is_simple(&polygon));
            let order = if first { EarOrder::First } else { EarOrder::MinimumAngle };
            let mut triangles = vec![];
            let mut corners: Vec<u8> = (0..).take(n).collect();
            prop_assert!(cut_ears(&mut corners, |i| polygon[i as usize], order, &mut triangles));
            prop_assert_eq!(triangles.len(), n - 2);
            let areas = triangles.iter().map(|t| { let [a, b, c] = t.map(|i| polygon[i as usize]); turn(a, b, c) });
            let areas: Vec<f64> = areas.collect();
            prop_assert!(areas.iter().all(|&area| area > 0.0));
            prop_assert!((areas.iter().sum::<f64>() - polygon_area(&polygon)).abs() < 1e-9);
        }
    }
}
