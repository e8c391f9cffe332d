//! The five tests in space that a filling must pass (JADE, section 6).

use crate::geometry::distance::{Triangle, segment_segment_distance_sq};
use crate::geometry::vector::{Vector, cross, distance_sq, dot, length_sq, sub};
use crate::mesh::{Filling, Hole, Surface};

/// Triangles of a shape worse than this are refused, unless the star they replace had one as bad.
pub(crate) const WORST_ASPECT: f64 = 0.02;
/// Segments nearer than this, relative to the longer one, intersect.
const TOUCHING: f64 = 1e-9;

/// Shape of a triangle: 1 when equilateral, 0 when it has no area,
/// `4 sqrt(3) area / sum of squared edges`.
pub(crate) fn aspect(&[a, b, c]: &Triangle) -> f64 {
    let area = length_sq(cross(sub(b, a), sub(c, a))).sqrt();
    let edges_sq = distance_sq(a, b) + distance_sq(b, c) + distance_sq(c, a);
    if edges_sq > 0.0 { 2.0 * 3_f64.sqrt() * area / edges_sq } else { 0.0 }
}

/// Smallest aspect among the triangles of the star.
pub(crate) fn worst_star_aspect(hole: &Hole) -> f64 {
    (0..hole.slots.len()).map(|i| aspect(&hole.triangle(i))).fold(1.0, f64::min)
}

/// Whether the filling may replace the star.
pub(crate) fn is_valid(surface: &Surface, hole: &Hole, filling: &Filling) -> bool {
    is_inside(hole, filling)
        && is_well_shaped(hole, filling)
        && keeps_topology(surface, hole, filling)
        && !edges_meet(hole, filling)
}

/// Every triangle faces the same side as the star's average plane, so that their projections tile
/// the hole.
fn is_inside(hole: &Hole, filling: &Filling) -> bool {
    let up = hole.average_normal();
    (0..filling.triangles.len()).all(|i| faces(&filling.triangle(hole, i), up))
}

/// Whether a triangle's normal has a positive part along `up`.
pub(crate) fn faces(&[a, b, c]: &Triangle, up: Vector) -> bool {
    dot(cross(sub(b, a), sub(c, a)), up) > 0.0
}

fn is_well_shaped(hole: &Hole, filling: &Filling) -> bool {
    let limit = WORST_ASPECT.min(worst_star_aspect(hole));
    (0..filling.triangles.len()).all(|i| aspect(&filling.triangle(hole, i)) >= limit)
}

/// No new edge is one that the mesh has already, which would join the surface to itself, or joins
/// two locked vertices.
pub(crate) fn keeps_topology(surface: &Surface, hole: &Hole, filling: &Filling) -> bool {
    match (hole.closed, hole.n_ring()) {
        (true, 3) => !surface.has_triangle([hole.ring[0], hole.ring[1], hole.ring[2]]),
        _ => filling
            .inner_edges(hole)
            .all(|[i, j]| surface.may_join(hole.ring[usize::from(i)], hole.ring[usize::from(j)])),
    }
}

/// Whether a new edge meets the border or another new edge other than at a common vertex.
fn edges_meet(hole: &Hole, filling: &Filling) -> bool {
    let n = hole.n_ring();
    let n_border = if hole.closed { n } else { n - 1 };
    filling.inner_edges(hole).enumerate().any(|(at, [i, j])| {
        let edge = [usize::from(i), usize::from(j)];
        (0..n_border).any(|k| meet(hole, edge, [k, hole.next(k)]))
            || filling.inner_edges(hole).skip(at + 1).any(|[k, l]| meet(hole, edge, [k.into(), l.into()]))
    })
}

fn meet(hole: &Hole, [i, j]: [usize; 2], [k, l]: [usize; 2]) -> bool {
    if i == k || i == l || j == k || j == l {
        return false;
    }
    let (first, second) = ([hole.points[i], hole.points[j]], [hole.points[k], hole.points[l]]);
    let scale_sq = distance_sq(first[0], first[1]).max(distance_sq(second[0], second[1]));
    segment_segment_distance_sq(first, second) <= TOUCHING * TOUCHING * scale_sq
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn aspect_is_one_for_an_equilateral_triangle_and_zero_for_a_line() {
        let h = 3_f64.sqrt() / 2.0;
        assert!((aspect(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, h, 0.0]]) - 1.0).abs() < 1e-12);
        assert_eq!(aspect(&[[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), 0.0);
        assert_eq!(aspect(&[[1.0; 3]; 3]), 0.0);
    }
}
