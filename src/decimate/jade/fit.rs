//! The filling that lies nearest to the input: the optimal triangulation, each triangle scored by
//! the input vertices that it would cover and each edge inside by the input edges that would cross
//! it.
//!
//! The paper triangulates first and flips edges afterwards. Where the bound is a true distance to
//! the input, asking for the best filling outright costs little more, since each of the few
//! possible triangles is scored once, and it needs a quarter fewer triangles at the same error.

use super::classify::Class;
use super::crossings::Crossings;
use super::optimal::{EdgeScores, triangulate_optimally};
use super::sampled_vertices::{MAX_CORNERS, SampledVertices};
use super::triangulate::{collect_part, ring_index};
use super::validity::{WORST_ASPECT, worst_star_aspect};
use crate::bound::REACH;
use crate::bound::certified::Certified;
use crate::geometry::height_triangle::HeightTriangle;
use crate::geometry::vector::length_sq;
use crate::mesh::{Filling, Hole, Surface};

/// A hole to be filled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fitting<'a> {
    /// The mesh around it.
    pub surface: &'a Surface,
    /// What is mapped into it.
    pub certified: &'a Certified,
    /// The hole.
    pub hole: &'a Hole,
    /// Whether it is to be split.
    pub class: Class,
    /// The largest squared distance that is of use.
    pub limit_sq: f64,
}

/// Buffers for one hole at a time.
#[derive(Clone, Debug, Default)]
pub(crate) struct FitBuffers {
    /// Source vertices mapped into the hole.
    covered: Vec<u32>,
    crossings: Crossings,
    sampled: SampledVertices,
    parts: [HolePart; 2],
}

/// A part of a hole: a polygon to be filled.
#[derive(Clone, Debug, Default)]
struct HolePart {
    corners: Vec<u8>,
    edges: EdgeScores,
}

/// Fills the hole by triangles that face the side of its star, keep the topology and lie nearest to
/// the covered points that are sampled, and to the edges that cross from one triangle to another.
/// Returns the largest of these distances, squared; above the limit a lower bound of it, without a
/// filling. `None` if there is no such filling, or if the hole is too large or has no average
/// plane.
pub(crate) fn fit(fitting: Fitting<'_>, buffers: &mut FitBuffers, filling: &mut Filling) -> Option<f64> {
    let Fitting { surface, certified, hole, class, limit_sq } = fitting;
    let up = hole.average_normal();
    let size_sq = length_sq(up);
    let is_tetrahedron = hole.closed && hole.n_ring() == 3 && surface.has_triangle(triple(hole));
    if hole.n_ring() > MAX_CORNERS || size_sq <= 0.0 || !size_sq.is_finite() || is_tetrahedron {
        return None;
    }
    let FitBuffers { covered, crossings, sampled, parts } = buffers;
    let split = match class {
        Class::InteriorEdge(ends) => Some(ends.map(ring_index)),
        _ => None,
    };
    collect_parts(hole, split, parts, filling);
    certified.gather(hole, covered);
    // Edges come first: their distances cost little, and most holes that have no filling within the
    // limit fail by what no choice of inner edges can avoid.
    crossings.gather(surface, hole, up, certified, covered);
    let crossing_sq = |edge| crossings.largest_sq(hole, edge);
    let is_inside = |&[i, j]: &[u8; 2]| !hole.is_ring_edge(i.into(), j.into());
    let split_sq = split.filter(is_inside).map_or(0.0, crossing_sq);
    // Followed up somewhat beyond the limit, so that a later iteration knows what the hole needs.
    let enough_sq = REACH * REACH * limit_sq;
    let worst_sq =
        parts.each_mut().map(|HolePart { corners, edges }| edges.set(corners, enough_sq, crossing_sq));
    let least_sq = worst_sq.into_iter().fold(split_sq, f64::max);
    if least_sq > limit_sq {
        return Some(least_sq);
    }
    sampled.gather(surface, hole, up, covered);
    // A star with a thin triangle may be replaced by one as thin.
    let worst_aspect = WORST_ASPECT.min(worst_star_aspect(hole));
    // It is rare that a new edge may not be made, and takes long to find out. So only the edges of
    // the best filling are looked up; one that may not is forbidden and the next best filling
    // found. At most as many times as there are inner edges.
    let mut taken: Vec<[u8; 2]> = vec![];
    loop {
        let score = |triangle: [u8; 3], cutoff: f64| {
            if taken.iter().any(|edge| edge.iter().all(|corner| triangle.contains(corner))) {
                return f64::INFINITY;
            }
            largest_distance_sq(hole, sampled, triangle, worst_aspect, cutoff.min(enough_sq))
        };
        let filled_sq = fill_parts(parts, enough_sq, score, filling)?;
        let worst_sq = filled_sq.max(split_sq);
        if worst_sq > limit_sq {
            return Some(worst_sq);
        }
        let may_join =
            |[i, j]: [u8; 2]| surface.may_join(hole.ring[usize::from(i)], hole.ring[usize::from(j)]);
        let Some(edge) = filling.inner_edges(hole).find(|&edge| !may_join(edge)) else {
            return Some(worst_sq);
        };
        taken.push(edge);
    }
}

/// The polygons to be filled: one, or two on either side of the edge that splits the hole.
fn collect_parts(hole: &Hole, split: Option<[u8; 2]>, parts: &mut [HolePart; 2], filling: &mut Filling) {
    let whole = [0, ring_index(hole.n_ring() - 1)];
    let [from, to] = split.unwrap_or(whole);
    filling.part_starts = [from, to];
    let [first, second] = parts.each_mut().map(|part| &mut part.corners);
    collect_part(hole, from.into(), to.into(), first);
    second.clear();
    if split.is_some() {
        collect_part(hole, to.into(), from.into(), second);
    }
}

/// Fills each part as well as can be; the worst score, or a lower bound of it above `enough`.
fn fill_parts(
    parts: &[HolePart; 2],
    enough: f64,
    mut score: impl FnMut([u8; 3], f64) -> f64,
    filling: &mut Filling,
) -> Option<f64> {
    let Filling { triangles, n_first_part, .. } = filling;
    triangles.clear();
    let mut fill = |HolePart { corners, edges }: &HolePart| {
        if corners.len() < 3 {
            return Some(0.0);
        }
        triangulate_optimally(corners, enough, edges, &mut score, triangles)
    };
    let [first, second] = parts;
    let worst = [fill(first)?, fill(second)?];
    *n_first_part = first.corners.len().saturating_sub(2);
    Some(worst[0].max(worst[1]))
}

/// Largest squared distance to a triangle among the points over it, or the first above `cutoff`;
/// infinite where the triangle faces away or is too thin.
fn largest_distance_sq(
    hole: &Hole,
    sampled: &mut SampledVertices,
    triangle: [u8; 3],
    worst_aspect: f64,
    cutoff: f64,
) -> f64 {
    if sampled.flat_area(triangle) <= 0.0 {
        return f64::INFINITY;
    }
    let corners = HeightTriangle::new(triangle.map(|i| hole.points[usize::from(i)]));
    if corners.is_thinner(worst_aspect) {
        return f64::INFINITY;
    }
    match sampled.over(triangle) {
        0 => 0.0,
        over => sampled.largest(over, cutoff, |p| corners.distance_sq(p)),
    }
}

fn triple(hole: &Hole) -> [u32; 3] {
    [hole.ring[0], hole.ring[1], hole.ring[2]]
}
