//! Error measures (section 4.3): distance to the average plane, to a line, and the edge length of a lone triangle.
//!
//! The error of a vertex is a local measure plus what deletions around it have left there (equation 5). Both only order the queue.
//! What a level states comes from a bound on the distance between each star and the triangles that took its place, see
//! [`super::deviations`].

use super::classify::{Class, Geometry};
use super::ring::Ring;
use crate::geometry::distance::{nearest_parameter, point_segment_distance_sq, point_triangle_distance_sq};
use crate::geometry::vector::{Vector, add_scaled, cross, dot, length, length_sq, sub};

/// Of stars of at most this many triangles, all fans are tried.
pub const FEW: usize = 24;
/// Stars of more triangles are not compared with their fans edge by edge.
const MANY: usize = 128;

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

/// Bound on the distance between the star and the fan that the collapse into neighbour `into` leaves, both ways, or nothing where that
/// is not below `limit`. O(valence^2); O(1) for more than [`MANY`] triangles, where the bound is the length of the edge.
///
/// A map takes the star onto the fan and keeps the ring. The vertex goes to the nearest point of the fan, on the boundary to that of
/// the new boundary edge. The edge from the vertex to a neighbour crosses the fan's edges between the two in turn, each at the nearest
/// point. No point moves farther than one of these; the argument is that of [`crate::bound::certified`]. A second map takes the vertex
/// straight along the edge that collapses.
pub fn actual_error(ring: &Ring, geometry: &Geometry, into: usize, limit: f64) -> Option<f64> {
    let along = length(sub(geometry.points[into], geometry.apex));
    let limit = limit.min(along.next_up());
    if ring.len() > MANY {
        return (along < limit).then_some(along);
    }
    let (nearest, mut largest_sq) = image_of_vertex(ring, geometry, into);
    let n_others = geometry.points.len() - 1;
    let limit_sq = limit * limit;
    for j in 1..=n_others {
        // One of the two ranges is empty.
        let (after, before) = (nearest + 1..j, (j + 1..=nearest).rev());
        let spoke = [geometry.apex, neighbor(geometry, into, j)];
        let mut start = 0.0;
        for k in after.chain(before) {
            if largest_sq >= limit_sq {
                break;
            }
            let edge = [geometry.points[into], neighbor(geometry, into, k)];
            let at = nearest_parameter(spoke, edge);
            start = if at.is_nan() { start } else { at.clamp(start, 1.0) };
            let crossing = add_scaled(spoke[0], start, sub(spoke[1], spoke[0]));
            largest_sq = largest_sq.max(point_segment_distance_sq(crossing, edge));
        }
    }
    let error = largest_sq.sqrt();
    Some(if error < limit { error } else { along }).filter(|&error| error < limit)
}

/// The `k`-th neighbour after neighbour `into`.
fn neighbor(geometry: &Geometry, into: usize, k: usize) -> Vector {
    geometry.points[(into + k) % geometry.points.len()]
}

/// The triangle of the fan that the vertex goes into, by the first of the two neighbours after `into` that it has, and the squared
/// distance there.
fn image_of_vertex(ring: &Ring, geometry: &Geometry, into: usize) -> (usize, f64) {
    let target = geometry.points[into];
    let n_others = geometry.points.len() - 1;
    if !ring.is_cycle() {
        // The fan's triangle at the new boundary edge is the last one or the first, by the end of the chain that is the target.
        let (nearest, end) = if into == 0 { (n_others - 1, n_others) } else { (1, 1) };
        let boundary = [target, neighbor(geometry, into, end)];
        return (nearest, point_segment_distance_sq(geometry.apex, boundary));
    }
    let distance_sq = |k: usize| {
        let [a, b] = [k, k + 1].map(|k| neighbor(geometry, into, k));
        point_triangle_distance_sq(geometry.apex, &[target, a, b])
    };
    let distances_sq = (1..n_others).map(|k| (k, distance_sq(k)));
    distances_sq.fold((1, f64::INFINITY), |least, next| if next.1 < least.1 { next } else { least })
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
