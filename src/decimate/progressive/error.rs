//! Error measures (section 4.3): distance to the average plane, to a line, and the edge length of a
//! lone triangle.
//!
//! The error of a vertex is a local measure plus what deletions around it have left there (equation
//! 5). Both only order the queue. What a level states comes from a bound on the distance between
//! each star and the triangles that took its place, see [`super::deviations`].

use super::classify::{Geometry, VertexClass};
use super::ring::Ring;
use crate::geometry::distance::{nearest_parameter, point_segment_distance_sq, point_triangle_distance_sq};
use crate::geometry::vector::{Vector, add_scaled, length, sub};

/// Of stars of at most this many triangles, all fans are tried.
pub(crate) const MAX_COMPARED_VALENCE: usize = 24;
/// Stars of more triangles are not compared with their fans edge by edge.
const MAX_MAPPED_VALENCE: usize = 128;

/// Distance of the vertex to what its deletion would leave, by its class. O(1) after
/// [`Geometry::gather`].
pub(crate) fn local_error(class: VertexClass, ring: &Ring, geometry: &Geometry) -> f64 {
    let to_line = |i: usize, j: usize| {
        point_segment_distance_sq(geometry.apex, [geometry.points[i], geometry.points[j]]).sqrt()
    };
    match class {
        VertexClass::Empty | VertexClass::Locked => 0.0,
        _ if vanishes(ring) => geometry.area.sqrt(),
        VertexClass::Boundary => to_line(0, geometry.points.len() - 1),
        VertexClass::InteriorEdge([i, j]) => to_line(i, j),
        VertexClass::Simple
        | VertexClass::CrackTip
        | VertexClass::Degenerate
        | VertexClass::Corner
        | VertexClass::NonManifold => geometry.distance_to_plane(),
    }
}

/// Whether a collapse leaves nothing of the star: a lone triangle, or the two sides of one.
pub(crate) fn vanishes(ring: &Ring) -> bool {
    ring.len() == 1 || (ring.len() == 2 && ring.is_cycle())
}

/// Bound on the distance between the star and the fan that the collapse into neighbour `into`
/// leaves, both ways, or `None` if that is not below `limit`. O(valence^2); O(1) for more than
/// [`MAX_MAPPED_VALENCE`] triangles, where the bound is the length of the edge.
///
/// A map takes the star onto the fan and keeps the ring. The vertex goes to the nearest point of
/// the fan, on the boundary to that of the new boundary edge. The edge from the vertex to a
/// neighbour crosses the fan's edges between the two in turn, each at the nearest point. No point
/// moves farther than one of these; the argument is that of [`crate::bound::certified`]. A second
/// map takes the vertex straight along the edge that collapses.
pub(crate) fn actual_error(ring: &Ring, geometry: &Geometry, into: usize, limit: f64) -> Option<f64> {
    let along = length(sub(geometry.points[into], geometry.apex));
    let limit = limit.min(along.next_up());
    if ring.len() > MAX_MAPPED_VALENCE {
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

/// The triangle of the fan that the vertex goes into, by the first of the two neighbours after
/// `into` that it has, and the squared distance there.
fn image_of_vertex(ring: &Ring, geometry: &Geometry, into: usize) -> (usize, f64) {
    let target = geometry.points[into];
    let n_others = geometry.points.len() - 1;
    if !ring.is_cycle() {
        // The fan's triangle at the new boundary edge is the last one or the first, by the end of
        // the chain that is the target.
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

/// Pairs of neighbours that make up a fan from neighbour `into`: the triangles of the star that
/// survive the collapse.
pub(crate) fn fan_of(ring: &Ring, into: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
    (0..ring.len()).map(|i| [i, ring.next(i)]).filter(move |pair| !pair.contains(&into))
}
