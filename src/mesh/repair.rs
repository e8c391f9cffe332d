//! From the triangles of a file to the triangles of a mesh: weld, drop degenerate triangles, count
//! everything.
//!
//! The rules, in this order:
//!
//! 1. Vertices equal in position (bit for bit, `-0` equal to `0`) and in every attribute become one
//!    vertex.
//! 2. Vertices equal in position alone are *seam* vertices: they stay apart in the output, since
//!    their attributes differ, and share one *point* in the topology, so that the two sides of a
//!    seam never come apart. Where nothing but their normals differs they share their *look* as
//!    well, and the seam binds nobody: flat shading would make a seam of every edge.
//! 3. A triangle with two corners on one point has no area and is dropped.
//! 4. A triangle with the same three points in the same orientation as an earlier one is dropped.
//!    The opposite orientation is kept: two-sided sheets are drawn that way.
//! 5. A triangle of zero area with three distinct points is kept: its neighbours are joined through
//!    it.
//! 6. Vertices that no triangle uses are dropped.

use super::places::{n_moved, order_by, position_key};
use crate::flat::{NO_INDEX, canonical};
use crate::geometry::distance::Triangle;
use crate::geometry::vector::{cross, length_sq, sub, widen};
use nephrite_formats::{Attribute, TriangleMesh};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// How many vertices and triangles each rule of the repair touched.
///
/// ```
/// use nephrite::{BuildOptions, RepairReport, build, generate};
/// let mut mesh = generate::torus(16, 8);
/// mesh.triangles.push(mesh.triangles[0]);
/// let build = build(&mesh, &BuildOptions::default())?;
/// let expected = RepairReport { triangles_duplicate: 1, ..RepairReport::default() };
/// assert_eq!(*build.repairs(), expected);
/// # Ok::<(), nephrite::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RepairReport {
    /// Vertices merged into an identical one.
    pub vertices_welded: usize,
    /// Vertices that share their position with another one and differ from it in an attribute.
    pub vertices_on_seams: usize,
    /// Vertices dropped because no triangle uses them.
    pub vertices_unreferenced: usize,
    /// Triangles dropped because two of their corners are one point.
    pub triangles_degenerate: usize,
    /// Triangles dropped because an earlier one has the same points in the same orientation.
    pub triangles_duplicate: usize,
    /// Triangles of zero area, kept.
    pub triangles_zero_area: usize,
}

/// A mesh whose triangles are distinct and have three distinct points each.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Repaired {
    /// The mesh; its vertices keep the order they had.
    pub mesh: TriangleMesh,
    /// The point of each vertex, where some vertices share one: `points[v] <= v` is the first
    /// vertex at that position. `None` where every vertex has a position of its own.
    pub points: Option<Vec<u32>>,
    /// The look of each vertex, where `points` is there: the first vertex that differs from it at
    /// most in the normal.
    pub looks: Option<Vec<u32>>,
    /// Points of the input's surface that are not part of the mesh: each is a dropped triangle with
    /// two equal corners, which is a segment, or with three, which is a point.
    pub dropped: Vec<Triangle>,
    /// What was done.
    pub report: RepairReport,
}

/// Applies the rules of this module, in the arrays that the mesh has. O(n log n).
pub(crate) fn repair(mut mesh: TriangleMesh) -> Repaired {
    let mut report = RepairReport::default();
    let Weld { vertices, points, looks } = weld(&mesh);
    report.vertices_welded = n_moved(&vertices);

    let degenerate = take_degenerate(&mut mesh.triangles, &points);
    report.triangles_degenerate = degenerate.len();
    for v in mesh.triangles.as_flattened_mut() {
        *v = vertices[*v as usize];
    }
    drop(vertices);
    report.triangles_duplicate = drop_duplicates(&mut mesh.triangles, &points);
    report.triangles_zero_area = mesh.triangles.iter().filter(|t| has_zero_area(&mesh, t)).count();
    let dropped = outside(&mesh, &points, degenerate);

    let renumbered = renumber_referenced(mesh.positions.len(), &mesh.triangles);
    let n_used = renumbered.iter().filter(|&&v| v != NO_INDEX).count();
    report.vertices_unreferenced = mesh.positions.len() - n_used - report.vertices_welded;
    for v in mesh.triangles.as_flattened_mut() {
        *v = renumbered[*v as usize];
    }
    let points = first_used(&points, &renumbered, n_used);
    report.vertices_on_seams = count_shared(&points);
    let has_seams = report.vertices_on_seams > 0;
    let looks = has_seams.then(|| first_used(&looks, &renumbered, n_used));
    let points = has_seams.then_some(points);
    keep_used(&mut mesh, &renumbered, n_used);
    Repaired { mesh, points, looks, dropped, report }
}

/// For each vertex the first one that is the same in some sense.
struct Weld {
    /// Identical to it.
    vertices: Vec<u32>,
    /// At its position.
    points: Vec<u32>,
    /// At its position, with the same attributes but for the normal.
    looks: Vec<u32>,
}

fn weld(mesh: &TriangleMesh) -> Weld {
    let n_vertices = vertex_count(mesh);
    let key = |v: u32| position_key(mesh.positions[v as usize]);
    let order = order_by(mesh.positions.len(), key);
    let mut vertices: Vec<u32> = (0..n_vertices).collect();
    let (mut points, mut looks) = (vertices.clone(), vertices.clone());
    let mut sorted = vec![];
    for same_place in order.chunk_by(|&a, &b| key(a) == key(b)) {
        let &[point, _, ..] = same_place else { continue };
        sorted.clear();
        sorted.extend_from_slice(same_place);
        sorted.sort_by(|&a, &b| compare_attributes_of(mesh, a, b));
        for same_look in sorted.chunk_by(|&a, &b| compare_looks(mesh, a, b).is_eq()) {
            let look = lowest(same_look);
            for same in same_look.chunk_by(|&a, &b| compare_attributes_of(mesh, a, b).is_eq()) {
                for &v in same {
                    vertices[v as usize] = same[0];
                    points[v as usize] = point;
                    looks[v as usize] = look;
                }
            }
        }
    }
    Weld { vertices, points, looks }
}

fn lowest(vertices: &[u32]) -> u32 {
    vertices.iter().copied().min().unwrap_or_default()
}

#[expect(clippy::cast_possible_truncation, reason = "MAX_VERTICES is below")]
fn vertex_count(mesh: &TriangleMesh) -> u32 {
    mesh.positions.len() as u32
}

/// By look, then by normal.
fn compare_attributes_of(mesh: &TriangleMesh, a: u32, b: u32) -> Ordering {
    compare_looks(mesh, a, b).then_with(|| {
        compare_attributes(mesh.attributes.iter().filter(|attribute| is_normal(attribute)), a, b)
    })
}

/// By all attributes but the normal.
fn compare_looks(mesh: &TriangleMesh, a: u32, b: u32) -> Ordering {
    compare_attributes(mesh.attributes.iter().filter(|attribute| !is_normal(attribute)), a, b)
}

fn compare_attributes<'a>(attributes: impl Iterator<Item = &'a Attribute>, a: u32, b: u32) -> Ordering {
    let mut orders = attributes.map(|attribute| value(attribute, a).cmp(value(attribute, b)));
    orders.find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// Whether an attribute is what readers call a normal.
fn is_normal(attribute: &Attribute) -> bool {
    attribute.name == "normal"
}

fn value(attribute: &Attribute, v: u32) -> &[u8] {
    let stride = attribute.stride_bytes();
    &attribute.bytes[v as usize * stride..][..stride]
}

/// Takes out the triangles with fewer than three points; gives the points of their corners, in
/// ascending order.
fn take_degenerate(triangles: &mut Vec<[u32; 3]>, points: &[u32]) -> Vec<[u32; 3]> {
    let mut degenerate = vec![];
    triangles.retain(|triangle| {
        let mut corners = triangle.map(|v| points[v as usize]);
        corners.sort_unstable();
        let is_degenerate = corners[0] == corners[1] || corners[1] == corners[2];
        if is_degenerate {
            degenerate.push(corners);
        }
        !is_degenerate
    });
    degenerate
}

/// Those of the degenerate triangles that are neither a corner nor an edge of a triangle of `mesh`,
/// each once. O(mesh) if there are any degenerate triangles.
fn outside(mesh: &TriangleMesh, points: &[u32], mut degenerate: Vec<[u32; 3]>) -> Vec<Triangle> {
    degenerate.sort_unstable();
    degenerate.dedup_by_key(|&mut [low, _, high]| [low, high]);
    let ends: Vec<[u32; 2]> = degenerate.iter().map(|&[low, _, high]| [low, high]).collect();
    if ends.is_empty() {
        return vec![];
    }
    let mut is_end = vec![false; mesh.positions.len()];
    ends.as_flattened().iter().for_each(|&point| is_end[point as usize] = true);
    let mut is_outside = vec![true; ends.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize]);
        for [p, q] in [[a, a], [b, b], [c, c], [a, b], [b, c], [c, a]] {
            if is_end[p as usize]
                && is_end[q as usize]
                && let Ok(at) = ends.binary_search(&[p.min(q), p.max(q)])
            {
                is_outside[at] = false;
            }
        }
    }
    let place = |point: u32| widen(mesh.positions[point as usize]);
    let left = ends.iter().zip(is_outside).filter(|&(_, is_outside)| is_outside);
    left.map(|(&[low, high], _)| [place(low), place(low), place(high)]).collect()
}

/// Drops every triangle whose points, in orientation, an earlier one has; returns how many.
fn drop_duplicates(triangles: &mut Vec<[u32; 3]>, points: &[u32]) -> usize {
    let key = |t: u32| canonical(triangles[t as usize].map(|v| points[v as usize]));
    let mut keep = vec![true; triangles.len()];
    for pair in order_by(triangles.len(), key).windows(2) {
        if key(pair[0]) == key(pair[1]) {
            keep[pair[1] as usize] = false;
        }
    }
    let n_before = triangles.len();
    let mut kept = keep.iter();
    triangles.retain(|_| kept.next() == Some(&true));
    n_before - triangles.len()
}

fn has_zero_area(mesh: &TriangleMesh, triangle: &[u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|v| widen(mesh.positions[v as usize]));
    length_sq(cross(sub(b, a), sub(c, a))) == 0.0
}

/// New index of each vertex that a triangle uses, in the old order; [`NO_INDEX`] for the others.
fn renumber_referenced(n_vertices: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut renumbered = vec![NO_INDEX; n_vertices];
    for &v in triangles.as_flattened() {
        renumbered[v as usize] = 0;
    }
    let used = renumbered.iter_mut().filter(|index| **index != NO_INDEX);
    used.zip(0..).for_each(|(index, next)| *index = next);
    renumbered
}

/// For each kept vertex, in the new numbering, the first kept vertex with the same entry in
/// `firsts`.
fn first_used(firsts: &[u32], renumbered: &[u32], n_used: usize) -> Vec<u32> {
    let mut first_kept = vec![NO_INDEX; firsts.len()];
    let mut kept = Vec::with_capacity(n_used);
    for (&first, &index) in firsts.iter().zip(renumbered).filter(|&(_, &index)| index != NO_INDEX) {
        let first = &mut first_kept[first as usize];
        if *first == NO_INDEX {
            *first = index;
        }
        kept.push(*first);
    }
    kept
}

/// Vertices whose point another vertex shares.
fn count_shared(points: &[u32]) -> usize {
    let mut n_at_point = vec![0_u32; points.len()];
    for &point in points {
        n_at_point[point as usize] += 1;
    }
    points.iter().filter(|&&point| n_at_point[point as usize] > 1).count()
}

/// Drops the vertices that are not among the `n_used` numbered ones, in place.
fn keep_used(mesh: &mut TriangleMesh, renumbered: &[u32], n_used: usize) {
    for attribute in &mut mesh.attributes {
        let stride = attribute.stride_bytes();
        for (v, &index) in renumbered.iter().enumerate().filter(|&(_, &index)| index != NO_INDEX) {
            // Never to a place behind the one it comes from.
            attribute.bytes.copy_within(v * stride..(v + 1) * stride, index as usize * stride);
        }
        attribute.bytes.truncate(n_used * stride);
    }
    let mut indices = renumbered.iter();
    mesh.positions.retain(|_| indices.next().is_some_and(|&index| index != NO_INDEX));
}

#[cfg(test)]
mod tests {
    use super::*;
    use nephrite_formats::ScalarType;

    fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> TriangleMesh {
        TriangleMesh {
            positions: positions.to_vec(),
            triangles: triangles.to_vec(),
            ..TriangleMesh::default()
        }
    }

    const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

    #[test]
    fn a_clean_mesh_is_left_alone() {
        let clean = mesh(&CORNERS, &[[0, 1, 2], [2, 1, 3]]);
        let repaired = repair(clean.clone());
        assert_eq!(repaired, Repaired { mesh: clean, ..Repaired::default() });
    }

    #[test]
    fn equal_positions_weld_and_minus_zero_is_zero() {
        let soup = mesh(
            &[CORNERS[0], CORNERS[1], CORNERS[2], [-0.0, 1.0, -0.0], CORNERS[1], CORNERS[3]],
            &[[0, 1, 2], [3, 4, 5]],
        );
        let repaired = repair(soup);
        assert_eq!(repaired.mesh, mesh(&CORNERS, &[[0, 1, 2], [2, 1, 3]]));
        assert_eq!(repaired.report, RepairReport { vertices_welded: 2, ..RepairReport::default() });
    }

    #[test]
    fn vertices_that_differ_in_an_attribute_share_only_their_point() {
        let mut seam = mesh(&[CORNERS[0], CORNERS[1], CORNERS[2], CORNERS[1]], &[[0, 1, 2], [2, 3, 0]]);
        seam.attributes.push(Attribute {
            name: "shade".into(),
            scalar: ScalarType::U8,
            n_components: 1,
            bytes: vec![7, 7, 7, 9],
        });
        let repaired = repair(seam.clone());
        assert_eq!(repaired.mesh, seam);
        assert_eq!(repaired.points, Some(vec![0, 1, 2, 1]));
        assert_eq!(repaired.looks, Some(vec![0, 1, 2, 3]));
        assert_eq!(repaired.report, RepairReport { vertices_on_seams: 2, ..RepairReport::default() });
    }

    #[test]
    fn vertices_that_differ_in_the_normal_share_their_look() {
        let mut flat = mesh(&[CORNERS[0], CORNERS[1], CORNERS[2], CORNERS[1]], &[[0, 1, 2], [2, 3, 0]]);
        let bytes = vec![1, 1, 1, 2];
        flat.attributes.push(Attribute {
            name: "normal".into(),
            scalar: ScalarType::U8,
            n_components: 1,
            bytes,
        });
        let repaired = repair(flat.clone());
        assert_eq!(repaired.mesh, flat);
        assert_eq!((repaired.points, repaired.looks), (Some(vec![0, 1, 2, 1]), Some(vec![0, 1, 2, 1])));
    }

    #[test]
    fn triangles_that_are_no_surface_or_repeat_one_are_dropped_and_counted() {
        let mut positions = CORNERS.to_vec();
        positions.push([9.0; 3]);
        positions.push([2.0, 0.0, 0.0]);
        let messy =
            mesh(&positions, &[[0, 1, 2], [1, 1, 2], [1, 2, 0], [2, 1, 0], [2, 1, 3], [0, 1, 5], [4, 4, 4]]);
        let repaired = repair(messy);
        assert_eq!(repaired.mesh.triangles, [[0, 1, 2], [2, 1, 0], [2, 1, 3], [0, 1, 4]]);
        let expected = RepairReport {
            vertices_unreferenced: 1,
            triangles_degenerate: 2,
            triangles_duplicate: 1,
            triangles_zero_area: 1,
            ..RepairReport::default()
        };
        assert_eq!(repaired.report, expected);
        // The edge from 1 to 2 is there still; vertex 4 is not.
        assert_eq!(repaired.dropped, [[[9.0; 3]; 3]]);
    }

    #[test]
    fn segments_that_no_triangle_has_are_handed_back_once() {
        let mut positions = CORNERS.to_vec();
        positions.push([0.0, 0.0, 5.0]);
        let needle = [[0, 1, 2], [2, 1, 3], [0, 0, 4], [4, 0, 4], [1, 2, 1], [3, 3, 3]];
        let repaired = repair(mesh(&positions, &needle));
        assert_eq!(repaired.report.triangles_degenerate, 4);
        assert_eq!(repaired.dropped, [[[0.0; 3], [0.0; 3], [0.0, 0.0, 5.0]]]);
    }
}
