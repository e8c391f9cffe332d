//! The filling that lies nearest to the input: the optimal triangulation, each triangle scored by the input vertices that
//! it would cover.
//!
//! The paper triangulates first and flips edges afterwards. Where the bound is a true distance to the input, asking for
//! the best filling outright costs little more, since each of the few possible triangles is scored once, and it needs
//! a quarter fewer triangles at the same error.

use super::asked::Asked;
use super::classify::Class;
use super::optimal::triangulate_optimally;
use super::triangulate::{Polygons, collect_part, ring_index};
use super::validity::{WORST_ASPECT, worst_star_aspect};
use crate::bound::REACH;
use crate::geometry::distance::{Triangle, point_triangle_distance_sq};
use crate::geometry::vector::{Vector, cross, distance_sq, dot, length_sq, sub};
use crate::mesh::{Filling, Hole, Surface};

/// A hole to be filled.
#[derive(Clone, Copy, Debug)]
pub struct Fitting<'a> {
    /// The mesh around it.
    pub surface: &'a Surface,
    /// The hole.
    pub hole: &'a Hole,
    /// Whether it is to be split.
    pub class: Class,
    /// The largest squared distance that is of use.
    pub limit_sq: f64,
}

/// Fills the hole by triangles that face the side of its star, keep the topology and lie nearest to the points
/// covered, as far as they are asked. Returns the largest distance among those and the triangles they lie over, squared, or a lower
/// bound of it above [`REACH`] times the limit; `None` where there is no such filling or the hole is too large.
pub fn fit(
    fitting: Fitting<'_>,
    asked: &mut Asked,
    polygons: &mut Polygons,
    filling: &mut Filling,
) -> Option<f64> {
    let Fitting { surface, hole, limit_sq, .. } = fitting;
    let is_tetrahedron = hole.closed && hole.n_ring() == 3 && surface.has_triangle(triple(hole));
    if is_tetrahedron {
        return None;
    }
    // That a new edge is in the mesh already is rare and takes long to find out: asked of the edges chosen only.
    let mut taken = vec![];
    loop {
        let worst_sq = fit_around(fitting, &taken, asked, polygons, filling)?;
        if worst_sq > limit_sq {
            return Some(worst_sq);
        }
        let n_faces = |[i, j]: [u8; 2]| surface.n_faces(hole.ring[usize::from(i)], hole.ring[usize::from(j)]);
        let Some(edge) = filling.inner_edges(hole).find(|&edge| n_faces(edge) > 0) else {
            return Some(worst_sq);
        };
        taken.push(edge);
    }
}

/// The same without the edges between ring vertices that are taken.
fn fit_around(
    fitting: Fitting<'_>,
    taken: &[[u8; 2]],
    asked: &mut Asked,
    polygons: &mut Polygons,
    filling: &mut Filling,
) -> Option<f64> {
    let Fitting { hole, class, limit_sq, .. } = fitting;
    let enough_sq = REACH * REACH * limit_sq;
    filling.triangles.clear();
    let worst_aspect = WORST_ASPECT.min(worst_star_aspect(hole));
    let mut score = |triangle: [u8; 3], cutoff: f64| {
        if taken.iter().any(|edge| edge.iter().all(|corner| triangle.contains(corner))) {
            return f64::INFINITY;
        }
        largest_distance_sq(hole, asked, triangle, worst_aspect, cutoff.min(enough_sq))
    };
    let (from, to, is_split) = match class {
        Class::InteriorEdge([from, to]) => (from, to, true),
        _ => (0, hole.n_ring() - 1, false),
    };
    filling.part_starts = [ring_index(from), ring_index(to)];
    let mut fill_part = |from, to, filling: &mut Filling| {
        collect_part(hole, from, to, &mut polygons.part);
        let is_edge = polygons.part.len() < 3;
        if is_edge {
            Some(0.0)
        } else {
            triangulate_optimally(&polygons.part, enough_sq, &mut score, &mut filling.triangles)
        }
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
    asked: &mut Asked,
    triangle: [u8; 3],
    worst_aspect: f64,
    cutoff: f64,
) -> f64 {
    if asked.flat_area(triangle) <= 0.0 {
        return f64::INFINITY;
    }
    let floor = Floor::new(triangle.map(|i| hole.points[usize::from(i)]));
    if floor.is_thinner(worst_aspect) {
        return f64::INFINITY;
    }
    match asked.over(triangle) {
        0 => 0.0,
        over => asked.largest(over, cutoff, floor.distance_sq()),
    }
}

/// A triangle under points most of which have the foot of their perpendicular inside: their distance is a height.
struct Floor {
    corners: Triangle,
    edges: [Vector; 2],
    normal: Vector,
    normal_sq: f64,
}

impl Floor {
    fn new(corners: Triangle) -> Self {
        let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
        let normal = cross(edges[0], edges[1]);
        Self { corners, edges, normal, normal_sq: length_sq(normal) }
    }

    /// Whether the triangle's [`aspect`](super::validity::aspect) is below `least`.
    fn is_thinner(&self, least: f64) -> bool {
        let [ab, ac] = self.edges;
        let edges_sq = length_sq(ab) + distance_sq(self.corners[1], self.corners[2]) + length_sq(ac);
        12.0 * self.normal_sq < (least * edges_sq).powi(2) || edges_sq <= 0.0
    }

    /// Squared distance of a point: good enough to choose by, not to prove with.
    #[inline(always)]
    fn distance_sq(&self) -> impl Fn(Vector) -> f64 {
        let Self { corners, edges: [ab, ac], normal, normal_sq } = *self;
        let per_normal_sq = 1.0 / normal_sq;
        // Perpendicular to the normal and to one edge at the first corner.
        let across = [cross(ac, normal), cross(normal, ab)];
        move |p| {
            let ap = sub(p, corners[0]);
            let [v, w] = across.map(|axis| dot(ap, axis));
            if v >= 0.0 && w >= 0.0 && v + w <= normal_sq {
                let height = dot(ap, normal);
                height * height * per_normal_sq
            } else {
                point_triangle_distance_sq(p, &corners)
            }
        }
    }
}

fn triple(hole: &Hole) -> [u32; 3] {
    [hole.ring[0], hole.ring[1], hole.ring[2]]
}
