//! Error measures (section 4.3): distance to the average plane, to a line, and the edge length of a lone triangle.
//!
//! The error of a vertex is a local measure plus what deletions around it have left there (equation 5). The local measure
//! only orders the queue. What is left behind is the *actual* distance between the star and the triangles that took its
//! place, so the largest sum bounds the error of the mesh in the paper's sense: an estimate, no proof.

use super::classify::{Class, Geometry};
use super::ring::Ring;
use crate::geometry::distance::{point_segment_distance_sq, point_triangle_distance_sq};
use crate::geometry::vector::{Vector, cross, dot, length, length_sq, midpoint, sub};

/// Stars of at most this many triangles are compared with their fans edge by edge.
pub const FEW: usize = 24;

/// Distance of the vertex to what its deletion would leave, by its class. O(1) after [`Geometry::gather`].
pub fn local_error(class: Class, ring: &Ring, geometry: &Geometry) -> f64 {
    let to_line = |i: usize, j: usize| {
        point_segment_distance_sq(geometry.apex, [geometry.points[i], geometry.points[j]]).sqrt()
    };
    match class {
        Class::Empty | Class::Locked => 0.0,
        _ if vanishes(ring) => geometry.area.sqrt(),
        Class::Boundary => to_line(0, geometry.points.len() - 1),
        Class::InteriorEdge([i, j]) => to_line(i, j),
        Class::Simple | Class::CrackTip | Class::Degenerate | Class::Corner | Class::NonManifold => {
            geometry.distance_to_plane()
        }
    }
}

/// Whether a collapse leaves nothing of the star: a lone triangle, or the two sides of one.
pub fn vanishes(ring: &Ring) -> bool {
    ring.len() == 1 || (ring.len() == 2 && ring.is_cycle())
}

/// Distance between the star and the triangles that the collapse into neighbour `into` leaves, or nothing where that is
/// not below `limit`: of the deleted vertex from the new triangles, as in the paper; of the middle of each new edge from the old
/// ones, which tells of saddles that the vertex lies in the middle of; and on the boundary, of the vertex from the new boundary.
/// O(valence^2) for the few triangles that most stars have, near O(valence) in practice; O(valence) for others, where new
/// edges are left out.
pub fn actual_error(ring: &Ring, geometry: &Geometry, into: usize, limit: f64) -> Option<f64> {
    if vanishes(ring) {
        let size = geometry.area.sqrt();
        return (size < limit).then_some(size);
    }
    let limit_sq = limit * limit;
    let points = &geometry.points;
    let target = points[into];
    let fan = fan_of(ring, into).map(|[i, j]| [target, points[i], points[j]]);
    let to_fan = |least: f64, triangle| least.min(point_triangle_distance_sq(geometry.apex, &triangle));
    let mut largest_sq = fan.fold(f64::INFINITY, to_fan);
    if !ring.is_cycle() {
        let new_boundary = [points[0], points[points.len() - 1]];
        largest_sq = largest_sq.max(point_segment_distance_sq(geometry.apex, new_boundary));
    }
    if ring.len() <= FEW {
        for (j, &point) in points.iter().enumerate() {
            if largest_sq >= limit_sq {
                return None;
            }
            if j != into && !ring.are_adjacent(into, j) {
                let first = sector_between(ring, into, j);
                largest_sq =
                    distance_to_star_sq(ring, geometry, (midpoint(target, point), first), largest_sq);
            }
        }
    }
    (largest_sq < limit_sq).then_some(largest_sq.sqrt())
}

/// Triangle of the star in the middle of the shorter way from neighbour `i` to `j`: the middle of the edge between them is usually
/// near it.
fn sector_between(ring: &Ring, i: usize, j: usize) -> usize {
    let (low, high) = (i.min(j), i.max(j));
    let n = ring.len();
    if !ring.is_cycle() || 2 * (high - low) <= n {
        low + (high - low) / 2
    } else {
        (high + (n - (high - low)) / 2) % n
    }
}

/// Squared distance between a point and the star, at least `floor_sq`: the search ends with the first triangle that near, and begins
/// at the one given with the point.
fn distance_to_star_sq(
    ring: &Ring,
    geometry: &Geometry,
    (point, first): (Vector, usize),
    floor_sq: f64,
) -> f64 {
    let mut least_sq = f64::INFINITY;
    for i in (first..ring.len()).chain(0..first) {
        let triangle = [geometry.apex, geometry.points[i], geometry.points[ring.next(i)]];
        least_sq = least_sq.min(point_triangle_distance_sq(point, &triangle));
        if least_sq <= floor_sq {
            return floor_sq;
        }
    }
    least_sq
}

/// Pairs of neighbours that make up a fan from neighbour `into`: the triangles of the star that survive the collapse.
pub fn fan_of(ring: &Ring, into: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
    (0..ring.len()).map(|i| [i, ring.next(i)]).filter(move |pair| !pair.contains(&into))
}

/// The average plane of a star (W. J. Schroeder, J. A. Zarge and W. E. Lorensen, "Decimation of triangle meshes", SIGGRAPH
/// 1992, section 3.2): normals and centres weighted with the areas.
#[derive(Clone, Copy, Debug, Default)]
pub struct AveragePlane {
    /// Sum of the normals, each as long as twice its triangle's area.
    pub normal: Vector,
    /// Sum of the corners beside the vertex, relative to it, weighted with twice the areas.
    pub weighted: Vector,
    /// Twice the sum of the areas.
    pub weight: f64,
}

impl AveragePlane {
    /// Adds the triangle between two spokes that start at the vertex; gives its normal, twice its area long, and that length.
    #[inline]
    pub fn add(&mut self, first: Vector, second: Vector) -> (Vector, f64) {
        let normal = cross(first, second);
        let size = length(normal);
        for axis in 0..3 {
            self.normal[axis] += normal[axis];
            self.weighted[axis] += size * (first[axis] + second[axis]);
        }
        self.weight += size;
        (normal, size)
    }

    /// Distance between the vertex and the plane; zero for a star without area.
    #[inline]
    pub fn distance(&self) -> f64 {
        let size_sq = length_sq(self.normal);
        if size_sq > 0.0 && self.weight > 0.0 {
            // The centre of a triangle is a third of its spokes away from the vertex.
            (dot(self.weighted, self.normal) / (3.0 * self.weight)).abs() / size_sq.sqrt()
        } else {
            0.0
        }
    }
}

/// A vector from the vertex to a point.
#[inline]
pub fn spoke(apex: Vector, point: Vector) -> Vector {
    sub(point, apex)
}
