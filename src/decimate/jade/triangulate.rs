//! Filling a hole (JADE, section 6): the first of fourteen projections in which the border does not
//! cross itself, the minimum angle triangulation there, plain ear cutting where that one is not
//! valid in space, and then edge flips.
//!
//! The hole of a vertex on a feature line is split along the new edge between the line's two ring
//! vertices, and each part is filled on its own.

use super::classify::Class;
use super::ears::{EarOrder, cut_ears};
use super::validity::is_valid;
use crate::geometry::projection::{Point2, ProjectionPlane, is_simple, plane_normals, polygon_area};
use crate::mesh::{Filling, Hole, Surface};

/// Buffers of the triangulation, reused from hole to hole.
#[derive(Clone, Debug, Default)]
pub(crate) struct Polygons {
    pub(super) part: Vec<u8>,
    corners: Vec<u8>,
    flat: Vec<Point2>,
}

/// Fills `hole`, of three ring vertices at least, validly, or returns false.
pub(crate) fn triangulate(
    surface: &Surface,
    hole: &Hole,
    class: Class,
    polygons: &mut Polygons,
    filling: &mut Filling,
) -> bool {
    [EarOrder::MinimumAngle, EarOrder::First]
        .into_iter()
        .any(|order| fill(hole, class, order, polygons, filling) && is_valid(surface, hole, filling))
}

fn fill(hole: &Hole, class: Class, order: EarOrder, polygons: &mut Polygons, filling: &mut Filling) -> bool {
    filling.triangles.clear();
    let (from, to) = match class {
        Class::InteriorEdge([from, to]) => (from, to),
        _ => (0, hole.n_ring() - 1),
    };
    filling.part_starts = [ring_index(from), ring_index(to)];
    let is_filled = fill_part(hole, from, to, order, polygons, filling);
    filling.n_first_part = filling.triangles.len();
    let is_whole = !matches!(class, Class::InteriorEdge(_));
    is_filled && (is_whole || fill_part(hole, to, from, order, polygons, filling))
}

/// Fills the polygon of ring vertices from `from` round to `to`, both included.
fn fill_part(
    hole: &Hole,
    from: usize,
    to: usize,
    order: EarOrder,
    polygons: &mut Polygons,
    filling: &mut Filling,
) -> bool {
    collect_part(hole, from, to, &mut polygons.part);
    if polygons.part.len() < 3 {
        return true;
    }
    let n_before = filling.triangles.len();
    for normal in plane_normals(hole.average_normal()) {
        if !project_part(hole, &ProjectionPlane::new(normal), &polygons.part, &mut polygons.flat) {
            continue;
        }
        let flat = &polygons.flat;
        let point = |corner: u8| flat[(usize::from(corner) + hole.n_ring() - from) % hole.n_ring()];
        polygons.corners.clone_from(&polygons.part);
        if cut_ears(&mut polygons.corners, point, order, &mut filling.triangles) {
            return true;
        }
        filling.triangles.truncate(n_before);
    }
    false
}

pub(super) fn collect_part(hole: &Hole, from: usize, to: usize, part: &mut Vec<u8>) {
    part.clear();
    let mut at = from;
    part.push(ring_index(at));
    while at != to {
        at = hole.next(at);
        part.push(ring_index(at));
    }
}

#[expect(clippy::cast_possible_truncation, reason = "ring indices stay below MAX_VALENCE + 1")]
pub(super) fn ring_index(i: usize) -> u8 {
    i as u8
}

/// Projects the part, mirrored if it would run clockwise. Returns whether its border is simple.
fn project_part(hole: &Hole, plane: &ProjectionPlane, part: &[u8], flat: &mut Vec<Point2>) -> bool {
    flat.clear();
    flat.extend(part.iter().map(|&i| plane.project(hole.points[usize::from(i)], hole.apex)));
    let area = polygon_area(flat);
    if area < 0.0 {
        flat.iter_mut().for_each(|p| p[0] = -p[0]);
    }
    area != 0.0 && is_simple(flat)
}
