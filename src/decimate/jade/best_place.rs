//! Where a vertex does best: the place at which the largest displacement of what is mapped onto its
//! star is least.
//!
//! With the images held at their shares of the vertex, moving it by `m` turns a displacement `d`
//! into `d - share m`. The largest of these is convex in `m` and its minimum a weighted minimax
//! problem, for which Lawson's iteration solves weighted least squares with weights that grow where
//! the residual is large (C. L. Lawson, "Contributions to the theory of linear least maximum
//! approximation", 1961). Shares then change, so both are repeated, and a place counts only when
//! the exact displacements there are smaller.

use crate::bound::certified::images::{Image, largest_sq};
use crate::geometry::bounds::Bounds;
use crate::geometry::vector::{Vector, add_scaled, length, sub, widen};

/// Rounds of new shares.
const N_ROUNDS: usize = 4;

/// Steps of Lawson's iteration in each of them.
const N_WEIGHINGS: usize = 12;

/// Parts of the way to a solution that are tried.
const STEPS: [f64; 3] = [1.0, 0.5, 0.25];

/// A place within `bounds` that is better than `start` and for which `is_allowed`, and its largest
/// squared displacement; `None` if none is found. The corners of `bounds` are exact in `f32`.
///
/// O(images), some 60 displacements each.
pub(crate) fn best_place(
    images: &[Image],
    start: [f32; 3],
    bounds: Bounds,
    is_allowed: impl Fn(Vector) -> bool,
) -> Option<([f32; 3], f64)> {
    let mut best = (start, largest_sq(images, widen(start)));
    let mut terms: Vec<Term> = Vec::with_capacity(images.len());
    for _ in 0..N_ROUNDS {
        let from = widen(best.0);
        terms.clear();
        terms.extend(images.iter().map(|image| Term::new(image, from)));
        let step = least_largest(&mut terms);
        let before = best.1;
        for part in STEPS {
            let place = narrow(add_scaled(from, part, step), bounds);
            let largest_sq = largest_sq(images, widen(place));
            if largest_sq < best.1 && is_allowed(widen(place)) {
                best = (place, largest_sq);
                break;
            }
        }
        if best.1 > 0.98 * before {
            break;
        }
    }
    (best.0 != start).then_some(best)
}

/// A displacement and how the vertex changes it.
struct Term {
    displacement: Vector,
    share: f64,
    weight: f64,
}

impl Term {
    fn new(image: &Image, apex: Vector) -> Self {
        let (displacement, share) = image.displacement(apex);
        Self { displacement, share, weight: 1.0 }
    }
}

/// About the step that makes the largest of `|displacement - share step|` least.
fn least_largest(terms: &mut [Term]) -> Vector {
    let mut step = [0.0; 3];
    for _ in 0..N_WEIGHINGS {
        let (mut sum, mut norm) = ([0.0; 3], 0.0);
        for &Term { displacement, share, weight } in terms.iter() {
            sum = add_scaled(sum, weight * share, displacement);
            norm += weight * share * share;
        }
        if norm <= 0.0 {
            return [0.0; 3];
        }
        step = sum.map(|x| x / norm);
        let mut total = 0.0;
        for Term { displacement, share, weight } in terms.iter_mut() {
            *weight *= length(sub(*displacement, step.map(|x| x * *share)));
            total += *weight;
        }
        if total <= 0.0 {
            return step;
        }
        terms.iter_mut().for_each(|term| term.weight /= total);
    }
    step
}

/// The nearest `f32` position within `bounds`.
#[expect(clippy::cast_possible_truncation, reason = "rounding is what it is for")]
fn narrow(p: Vector, Bounds { low, high }: Bounds) -> [f32; 3] {
    // The bounds are those of `f32` positions, and so exact.
    std::array::from_fn(|i| (p[i] as f32).max(low[i] as f32).min(high[i] as f32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bound::certified::images::Onto;

    const SPACE: Bounds = Bounds { low: [-9.0; 3], high: [9.0; 3] };

    /// A flat tent over a square: each of its four faces stands for a point at height 1 over the
    /// middle between the apex and the far edge.
    fn tent() -> Vec<Image> {
        let corners = [[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
        let mut images = vec![Image { source: [0.0; 3], onto: Onto::Vertex }];
        for i in 0..4 {
            let (a, b): (Vector, Vector) = (corners[i], corners[(i + 1) % 4]);
            let source = [(a[0] + b[0]) / 4.0, (a[1] + b[1]) / 4.0, 1.0];
            images.push(Image { source, onto: Onto::Triangle([a, b]) });
        }
        images
    }

    #[test]
    fn the_apex_of_a_tent_shares_the_error_with_its_faces() {
        let ([x, y, z], largest_sq) = best_place(&tent(), [0.0; 3], SPACE, |_| true).unwrap();
        // With the apex at height z, a face is (1 - z/2) / sqrt(1 + z^2) below its point, which is
        // z at z = 0.6023.
        assert!(x.abs() < 1e-3 && y.abs() < 1e-3 && (z - 0.602).abs() < 0.02, "{x} {y} {z}");
        assert!((largest_sq.sqrt() - 0.602).abs() < 0.02);
    }

    #[test]
    fn places_out_of_bounds_or_not_allowed_are_not_taken() {
        let flat = Bounds { low: [-9.0, -9.0, 0.0], high: [9.0, 9.0, 0.25] };
        let (place, _) = best_place(&tent(), [0.0; 3], flat, |_| true).unwrap();
        assert_eq!(place[2], 0.25);
        assert_eq!(best_place(&tent(), [0.0; 3], SPACE, |place| place[2] < 0.05), None);
    }
}
