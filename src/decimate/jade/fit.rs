//! The filling that lies nearest to the input: the optimal triangulation, each triangle scored by the input vertices that
//! it would cover.
//!
//! The paper triangulates first and flips edges afterwards. Where the bound is a true distance to the input, asking for
//! the best filling outright costs little more, since each of the few possible triangles is scored once, and it needs
//! a quarter fewer triangles at the same error.

use super::classify::Class;
use super::filling::Filling;
use super::hole::Hole;
use super::optimal::{MAX_CORNERS, triangulate_optimally};
use super::projection::{Plane, Point2, turn};
use super::triangulate::{Polygons, collect_part, ring_index};
use super::validity::{WORST_ASPECT, aspect, worst_star_aspect};
use crate::geometry::distance::point_triangle_distance_sq;
use crate::geometry::vector::{Vector, length_sq, scale};
use crate::mesh::Surface;

/// Input vertices over a hole, in space and in the hole's average plane.
#[derive(Clone, Debug, Default)]
pub struct Covered {
    points: Vec<Vector>,
    flat: Vec<Point2>,
    ring: Vec<Point2>,
}

impl Covered {
    /// Takes the points that the filling of `hole` is to stand for; false where the star has no area.
    pub fn project(&mut self, hole: &Hole, points: impl Iterator<Item = Vector>) -> bool {
        let normal = hole.average_normal();
        let size_sq = length_sq(normal);
        if size_sq <= 0.0 || !size_sq.is_finite() {
            return false;
        }
        let plane = Plane::new(scale(normal, 1.0 / size_sq.sqrt()));
        self.points.clear();
        self.points.extend(points);
        self.flat.clear();
        self.flat.extend(self.points.iter().map(|&p| plane.project(p, hole.apex)));
        self.ring.clear();
        self.ring.extend(hole.points.iter().map(|&p| plane.project(p, hole.apex)));
        true
    }

    /// Largest squared distance to the triangle among the points over it; infinite where the triangle faces away.
    fn score(&self, hole: &Hole, triangle: [u8; 3], worst_aspect: f64) -> f64 {
        let [a, b, c] = triangle.map(|i| self.ring[usize::from(i)]);
        let corners = triangle.map(|i| hole.points[usize::from(i)]);
        if turn(a, b, c) <= 0.0 || aspect(&corners) < worst_aspect {
            return f64::INFINITY;
        }
        let over = |p: Point2| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        let covered = self.flat.iter().zip(&self.points).filter(|&(&flat, _)| over(flat));
        covered.map(|(_, &p)| point_triangle_distance_sq(p, &corners)).fold(0.0, f64::max)
    }
}

/// Fills `hole` by triangles that face the side of its star, keep the topology and lie nearest to the points in
/// `covered`. False where there are none, or the hole is too large.
pub fn fit(
    surface: &Surface,
    hole: &Hole,
    class: Class,
    covered: &Covered,
    polygons: &mut Polygons,
    filling: &mut Filling,
) -> bool {
    filling.triangles.clear();
    let (from, to, is_split) = match class {
        Class::InteriorEdge([from, to]) => (from, to, true),
        _ => (0, hole.n_ring() - 1, false),
    };
    if hole.n_ring() > MAX_CORNERS
        || (hole.closed && hole.n_ring() == 3 && surface.has_triangle(triple(hole)))
    {
        return false;
    }
    let is_free = free_edges(surface, hole);
    let worst_aspect = WORST_ASPECT.min(worst_star_aspect(hole));
    let score = |triangle: [u8; 3]| {
        let [a, b, c] = triangle.map(usize::from);
        if is_free[a][b] && is_free[b][c] && is_free[a][c] {
            covered.score(hole, triangle, worst_aspect)
        } else {
            f64::INFINITY
        }
    };
    filling.part_starts = [ring_index(from), ring_index(to)];
    let mut fill_part = |from, to, filling: &mut Filling| {
        collect_part(hole, from, to, &mut polygons.part);
        polygons.part.len() < 3
            || triangulate_optimally(&polygons.part, score, &mut filling.triangles).is_some()
    };
    let is_filled = fill_part(from, to, filling);
    filling.n_first_part = filling.triangles.len();
    is_filled && (!is_split || fill_part(to, from, filling)) && !filling.triangles.is_empty()
}

fn triple(hole: &Hole) -> [u32; 3] {
    [hole.ring[0], hole.ring[1], hole.ring[2]]
}

/// Which pairs of ring vertices are a ring edge, or no edge yet.
fn free_edges(surface: &Surface, hole: &Hole) -> [[bool; MAX_CORNERS]; MAX_CORNERS] {
    let mut is_free = [[true; MAX_CORNERS]; MAX_CORNERS];
    for (j, &b) in hole.ring.iter().enumerate() {
        for (i, &a) in hole.ring[..j].iter().enumerate().filter(|&(i, _)| !hole.is_ring_edge(i, j)) {
            is_free[i][j] = surface.n_faces(a, b) == 0;
            is_free[j][i] = is_free[i][j];
        }
    }
    is_free
}
