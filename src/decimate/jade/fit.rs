//! The filling that lies nearest to the input: the optimal triangulation, each triangle scored by the input vertices that
//! it would cover.
//!
//! The paper triangulates first and flips edges afterwards. Where the bound is a true distance to the input, asking for
//! the best filling outright costs little more, since each of the few possible triangles is scored once, and it needs
//! a quarter fewer triangles at the same error.

use super::classify::Class;
use super::optimal::triangulate_optimally;
use super::triangulate::{Polygons, collect_part, ring_index};
use super::validity::{WORST_ASPECT, aspect, worst_star_aspect};
use crate::bound::covered::{Covered, MAX_CORNERS, Over};
use crate::geometry::distance::point_triangle_distance_sq;
use crate::mesh::{Filling, Hole, Surface};

/// Fills `hole` by triangles that face the side of its star, keep the topology and lie nearest to the points in
/// `covered`. Returns the largest distance among points and the triangles they lie over, squared, or `None` where there
/// is no such filling or the hole is too large.
pub fn fit(
    surface: &Surface,
    hole: &Hole,
    class: Class,
    covered: &Covered,
    polygons: &mut Polygons,
    filling: &mut Filling,
) -> Option<f64> {
    let is_tetrahedron = hole.closed && hole.n_ring() == 3 && surface.has_triangle(triple(hole));
    if !covered.has_sides() || is_tetrahedron {
        return None;
    }
    // That a new edge is in the mesh already is rare and takes long to find out: asked of the edges chosen only.
    let mut is_taken = [[false; MAX_CORNERS]; MAX_CORNERS];
    loop {
        let worst_sq = fit_around(hole, class, covered, &is_taken, polygons, filling)?;
        let n_faces = |[i, j]: [u8; 2]| surface.n_faces(hole.ring[usize::from(i)], hole.ring[usize::from(j)]);
        let Some([i, j]) = filling.inner_edges(hole).find(|&edge| n_faces(edge) > 0) else {
            return Some(worst_sq);
        };
        is_taken[usize::from(i)][usize::from(j)] = true;
        is_taken[usize::from(j)][usize::from(i)] = true;
    }
}

/// The same without the edges between ring vertices that are taken.
fn fit_around(
    hole: &Hole,
    class: Class,
    covered: &Covered,
    is_taken: &[[bool; MAX_CORNERS]; MAX_CORNERS],
    polygons: &mut Polygons,
    filling: &mut Filling,
) -> Option<f64> {
    filling.triangles.clear();
    let worst_aspect = WORST_ASPECT.min(worst_star_aspect(hole));
    let score = |triangle: [u8; 3], cutoff: f64| {
        let [a, b, c] = triangle.map(usize::from);
        if is_taken[a][b] || is_taken[b][c] || is_taken[a][c] {
            return f64::INFINITY;
        }
        largest_distance_sq(hole, covered, triangle, worst_aspect, cutoff)
    };
    let (from, to, is_split) = match class {
        Class::InteriorEdge([from, to]) => (from, to, true),
        _ => (0, hole.n_ring() - 1, false),
    };
    filling.part_starts = [ring_index(from), ring_index(to)];
    let mut fill_part = |from, to, filling: &mut Filling| {
        collect_part(hole, from, to, &mut polygons.part);
        let is_edge = polygons.part.len() < 3;
        if is_edge { Some(0.0) } else { triangulate_optimally(&polygons.part, score, &mut filling.triangles) }
    };
    let first = fill_part(from, to, filling)?;
    filling.n_first_part = filling.triangles.len();
    let second = if is_split { fill_part(to, from, filling)? } else { 0.0 };
    Some(first.max(second))
}

/// Largest squared distance to a triangle among the points over it, or the first above `cutoff`; infinite where the
/// triangle faces away or is too thin.
fn largest_distance_sq(
    hole: &Hole,
    covered: &Covered,
    triangle: [u8; 3],
    worst_aspect: f64,
    cutoff: f64,
) -> f64 {
    if covered.flat_area(triangle) <= 0.0 {
        return f64::INFINITY;
    }
    let corners = triangle.map(|i| hole.points[usize::from(i)]);
    let mut largest_sq = 0.0_f64;
    for p in covered.points_over(Over::new(triangle)) {
        largest_sq = largest_sq.max(point_triangle_distance_sq(p, &corners));
        if largest_sq > cutoff {
            return largest_sq;
        }
    }
    if aspect(&corners) < worst_aspect { f64::INFINITY } else { largest_sq }
}

fn triple(hole: &Hole) -> [u32; 3] {
    [hole.ring[0], hole.ring[1], hole.ring[2]]
}
