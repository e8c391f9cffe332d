//! A proven upper bound on the distance of loose pieces from a surface.

use super::prove::{self, Goal, Parts};
use super::search::TriangleTree;
use super::{bvh, pair};
use crate::geometry::distance::Triangle;

/// The bound exceeds the distance by at most this part of it, as long as [`MAX_PIECES`] suffice.
const TOLERANCE: f64 = 0.01;

/// Pieces after which the search ends with the bound that it has by then.
const MAX_PIECES: usize = 4_000_000;

/// A bound that no point of `pieces` exceeds in its distance from `surface`. 0 without pieces,
/// infinite without a surface.
///
/// A piece is a triangle; with equal corners it is a segment or a point. The bound is at most 1 %
/// above the largest distance, but for rounding and for inputs that need more than 4,000,000 parts
/// of pieces. It does not depend on the number of threads. Coordinates must be finite and at most
/// `f32::MAX`. O(surface + pieces) in practice.
pub(crate) fn bound_of_pieces(pieces: &[Triangle], surface: &[Triangle]) -> f64 {
    if pieces.is_empty() {
        return 0.0;
    }
    if surface.is_empty() {
        return f64::INFINITY;
    }
    let (nodes, order) = bvh::build(surface);
    let tree = TriangleTree::new(nodes, order.iter().map(|&t| surface[t as usize]).collect());
    let coordinates = pieces.iter().chain(surface).flatten().flatten();
    let slack = pair::SLACK * coordinates.fold(0.0, |largest: f64, coordinate| largest.max(coordinate.abs()));
    let goal = Goal::Tolerance { tolerance: TOLERANCE, floor: 4.0 * slack };
    let bracket = prove::refine(Parts::whole(pieces, &tree), &tree, goal, MAX_PIECES);
    bracket.upper_sq.sqrt() + slack
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::distance::point_triangle_distance_sq;
    use crate::geometry::vector::{Vector, add_scaled, scale, sub};
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vector> {
        prop::array::uniform3(-1.0..1.0)
    }

    /// Triangles, segments and points.
    fn pieces() -> impl Strategy<Value = Vec<Triangle>> {
        let piece = (prop::array::uniform3(vector()), 0..3).prop_map(|([a, b, c], kind)| match kind {
            0 => [a, b, c],
            1 => [a, a, b],
            _ => [a; 3],
        });
        prop::collection::vec(piece, 1..12)
    }

    fn sampled(pieces: &[Triangle], surface: &[Triangle]) -> f64 {
        let mut largest = 0.0_f64;
        for &[a, b, c] in pieces {
            for (i, j) in (0..=16).flat_map(|i| (0..=16 - i).map(move |j| (i, j))) {
                let [s, t] = [i, j].map(|k| f64::from(k) / 16.0);
                let p = add_scaled(add_scaled(a, s, sub(b, a)), t, sub(c, a));
                let distances_sq = surface.iter().map(|triangle| point_triangle_distance_sq(p, triangle));
                largest = largest.max(distances_sq.fold(f64::INFINITY, f64::min).sqrt());
            }
        }
        largest
    }

    proptest! {
        #[test]
        fn bounds_hold_and_are_close(pieces in pieces(), surface in pieces()) {
            let surface: Vec<Triangle> = surface.iter().map(|t| t.map(|p| scale(p, 0.3))).collect();
            let (bound, sample) = (bound_of_pieces(&pieces, &surface), sampled(&pieces, &surface));
            prop_assert!(sample <= bound && bound <= 1.011 * sample + 0.1, "{sample} {bound}");
        }
    }

    #[test]
    fn nothing_is_at_no_distance_and_nothing_is_near_to_nothing() {
        let point = [[1.0; 3]; 3];
        assert_eq!(bound_of_pieces(&[], &[point]), 0.0);
        assert_eq!(bound_of_pieces(&[point], &[]), f64::INFINITY);
        assert!(bound_of_pieces(&[point], &[point]) < 1e-11);
    }
}
