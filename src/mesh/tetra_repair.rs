//! From the tetrahedra of a file to tetrahedra that fit each other: weld, drop, turn, right, count
//! everything.
//!
//! The rules, in this order:
//!
//! 1. Vertices at one position become one where the mesh stays one by it: everywhere if no face
//!    gets a third tetrahedron and no edge of the boundary a third face by that; otherwise only
//!    within tetrahedra, which are flat and go. A grid that is wrapped around on itself with
//!    crossing diagonals keeps its seam that way.
//! 2. A tetrahedron with two corners in one vertex, or with the corners of an earlier one, is
//!    dropped.
//! 3. Corners in the wrong order are put right: where the volume is negative and the faces do not
//!    fit those of the neighbours, or all are negative.
//! 4. What is negative still is turned inside out by its vertices. It is righted by moving one
//!    vertex inside the mesh towards the middle of its neighbours, if that makes all volumes around
//!    it positive. One whose vertices are all on the boundary is dropped if two of its faces are,
//!    and the boundary goes over to its other two. Others are kept.
//! 5. A tetrahedron of zero volume with four distinct corners is kept: its neighbours are joined
//!    through it.
//! 6. Vertices that no tetrahedron uses are dropped.

use super::UsedVertices;
use super::tetrahedra::{FACES, Sides, boundary_triangles, faces_by_least_vertex};
use crate::flat::{DisjointSets, Groups};
use nephrite_formats::{Attribute, TetrahedronMesh};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;

/// How many vertices and tetrahedra each rule of the repair touched.
///
/// ```
/// use nephrite::{TetrahedronRepairReport, generate, repair_volume};
/// let (_, report) = repair_volume(&generate::box_volume([2; 3]))?;
/// assert_eq!(report, TetrahedronRepairReport::default());
/// # Ok::<(), nephrite::MeshFault>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TetrahedronRepairReport {
    /// Vertices merged into another at the same position.
    pub vertices_welded: usize,
    /// Vertices at the position of another that were kept apart.
    pub vertices_coincident: usize,
    /// Vertices dropped because no tetrahedron uses them.
    pub vertices_unreferenced: usize,
    /// Vertices moved to right a tetrahedron.
    pub vertices_moved: usize,
    /// Tetrahedra dropped because two of their corners are one vertex.
    pub tetrahedra_degenerate: usize,
    /// Tetrahedra dropped because an earlier one has the same corners.
    pub tetrahedra_duplicate: usize,
    /// Tetrahedra whose corners were put in the right order.
    pub tetrahedra_turned: usize,
    /// Tetrahedra of negative volume on the boundary, dropped.
    pub tetrahedra_peeled: usize,
    /// Tetrahedra of zero volume, kept.
    pub tetrahedra_flat: usize,
    /// Tetrahedra of negative volume, kept.
    pub tetrahedra_inverted: usize,
    /// Faces of three tetrahedra or more, or of two on the same side, whose corners stay where they
    /// are.
    pub faces_crowded: usize,
    /// Values of fields that are not a number (NaN), kept. Deviations of their fields are over the
    /// other values.
    pub values_nan: usize,
    /// Values of fields that are infinite, kept. Deviations of their fields are over the other
    /// values.
    pub values_infinite: usize,
}

/// Applies the rules of this module. O(n log n).
pub fn repair_tetrahedra(input: &TetrahedronMesh) -> (TetrahedronMesh, TetrahedronRepairReport) {
    let mut report = TetrahedronRepairReport::default();
    let mut tetrahedra = weld(input, &mut report);
    drop_duplicates(&mut tetrahedra, &mut report);
    let mut mesh = keep_used(input, tetrahedra, &mut report);
    turn(&mut mesh, &mut report);
    right(&mut mesh, &mut report);
    peel(&mut mesh, &mut report);
    report.tetrahedra_flat = mesh.tetrahedra.iter().filter(|&&t| mesh.six_volumes(t) == 0.0).count();
    report.tetrahedra_inverted = mesh.tetrahedra.iter().filter(|&&t| mesh.six_volumes(t) < 0.0).count();
    report.faces_crowded = Sides::new(&mesh.tetrahedra, mesh.positions.len()).misfits.len();
    let values = || mesh.attributes.iter().flat_map(Attribute::values);
    report.values_nan = values().filter(|value| value.is_nan()).count();
    report.values_infinite = values().filter(|value| value.is_infinite()).count();
    (mesh, report)
}

/// The tetrahedra over welded vertices, without those that are degenerate by it.
fn weld(input: &TetrahedronMesh, report: &mut TetrahedronRepairReport) -> Vec<[u32; 4]> {
    let n_vertices = input.positions.len();
    let firsts = first_at_position(input);
    let n_coincident = (0u32..).zip(&firsts).filter(|(v, first)| v != *first).count();
    let without_degenerate = |firsts: &[u32]| -> Vec<[u32; 4]> {
        let welded = input.tetrahedra.iter().map(|t| t.map(|v| firsts[v as usize]));
        welded.filter(|&t| !is_degenerate(t)).collect()
    };
    let mut tetrahedra = without_degenerate(&firsts);
    let mut firsts = firsts;
    if n_coincident > 0 && n_faults(&tetrahedra, n_vertices) > n_faults(&input.tetrahedra, n_vertices) {
        firsts = first_in_tetrahedra(input, &firsts);
        tetrahedra = without_degenerate(&firsts);
    }
    report.vertices_welded = (0u32..).zip(&firsts).filter(|(v, first)| v != *first).count();
    report.vertices_coincident = n_coincident - report.vertices_welded;
    report.tetrahedra_degenerate = input.tetrahedra.len() - tetrahedra.len();
    tetrahedra
}

fn is_degenerate([a, b, c, d]: [u32; 4]) -> bool {
    a == b || a == c || a == d || b == c || b == d || c == d
}

/// The first vertex at the position of each, `-0` equal to `0`.
fn first_at_position(mesh: &TetrahedronMesh) -> Vec<u32> {
    let key = |v: u32| mesh.positions[v as usize].map(|x| (x + 0.0).to_bits());
    #[expect(clippy::cast_possible_truncation, reason = "MAX_VERTICES is below")]
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    order.sort_unstable_by_key(|&v| (key(v), v));
    let mut firsts: Vec<u32> = order.clone();
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        same.iter().for_each(|&v| firsts[v as usize] = same[0]);
    }
    firsts
}

/// As `firsts`, but only where a tetrahedron has both vertices.
fn first_in_tetrahedra(mesh: &TetrahedronMesh, firsts: &[u32]) -> Vec<u32> {
    let mut sets = DisjointSets::new(firsts.len());
    for tetrahedron in &mesh.tetrahedra {
        for (i, &a) in tetrahedron.iter().enumerate() {
            for &b in &tetrahedron[..i] {
                if firsts[a as usize] == firsts[b as usize] {
                    sets.join(a, b);
                }
            }
        }
    }
    (0..).take(firsts.len()).map(|v| sets.root(v)).collect()
}

/// Faces with more than two tetrahedra, and edges of the boundary with other than two faces.
fn n_faults(tetrahedra: &[[u32; 4]], n_vertices: usize) -> usize {
    let mut n_faults = 0;
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for list in faces_by_least_vertex(tetrahedra, n_vertices).iter_mut() {
        list.sort_unstable();
        for same in list.chunk_by(|a, b| a.others == b.others) {
            n_faults += usize::from(same.len() > 2);
            if let [face] = same {
                let [a, b, c] = FACES[face.corner as usize].map(|i| tetrahedra[face.slot as usize][i]);
                edges.extend([ascending(a, b), ascending(b, c), ascending(c, a)]);
            }
        }
    }
    edges.sort_unstable();
    n_faults + edges.chunk_by(|a, b| a == b).filter(|faces| faces.len() != 2).count()
}

fn drop_duplicates(tetrahedra: &mut Vec<[u32; 4]>, report: &mut TetrahedronRepairReport) {
    let key = |mut t: [u32; 4]| {
        t.sort_unstable();
        t
    };
    let mut order: Vec<(usize, [u32; 4])> = tetrahedra.iter().map(|&t| key(t)).enumerate().collect();
    order.sort_unstable_by_key(|&(index, key)| (key, index));
    let mut is_kept = vec![true; tetrahedra.len()];
    for same in order.chunk_by(|a, b| a.1 == b.1) {
        same[1..].iter().for_each(|&(index, _)| is_kept[index] = false);
    }
    let n_before = tetrahedra.len();
    let mut kept = is_kept.into_iter();
    tetrahedra.retain(|_| kept.next().unwrap_or(true));
    report.tetrahedra_duplicate = n_before - tetrahedra.len();
}

fn keep_used(
    input: &TetrahedronMesh,
    mut tetrahedra: Vec<[u32; 4]>,
    report: &mut TetrahedronRepairReport,
) -> TetrahedronMesh {
    let used = UsedVertices::new(input.positions.len(), tetrahedra.as_flattened());
    report.vertices_unreferenced = input.positions.len() - used.len() - report.vertices_welded;
    used.renumber(tetrahedra.as_flattened_mut());
    TetrahedronMesh {
        origin: input.origin,
        positions: used.pick(&input.positions),
        attributes: used.pick_attributes(&input.attributes),
        tetrahedra,
        rounding: input.rounding,
    }
}

/// Puts corners in the right order, by rule 3.
fn turn(mesh: &mut TetrahedronMesh, report: &mut TetrahedronRepairReport) {
    let negative: Vec<usize> =
        (0..mesh.tetrahedra.len()).filter(|&i| mesh.six_volumes(mesh.tetrahedra[i]) < 0.0).collect();
    if negative.is_empty() {
        return;
    }
    negative.iter().for_each(|&i| mesh.tetrahedra[i].swap(0, 1));
    report.tetrahedra_turned = negative.len();
    if negative.len() == mesh.tetrahedra.len() {
        return;
    }
    // Positive now, but those whose every shared face is seen from the side of the neighbour were
    // in order before.
    let fits = fitting_faces(mesh);
    for i in negative {
        let [n_fitting, n_shared] = fits[i];
        if n_shared > 0 && n_fitting == 0 {
            mesh.tetrahedra[i].swap(0, 1);
            report.tetrahedra_turned -= 1;
        }
    }
}

/// Of each tetrahedron the faces that a neighbour sees from the other side, and those it shares.
fn fitting_faces(mesh: &TetrahedronMesh) -> Vec<[u8; 2]> {
    let mut counts = vec![[0; 2]; mesh.tetrahedra.len()];
    for list in faces_by_least_vertex(&mesh.tetrahedra, mesh.positions.len()).iter_mut() {
        list.sort_unstable();
        for same in list.chunk_by(|a, b| a.others == b.others) {
            if let [a, b] = same {
                let fits = a.is_even(&mesh.tetrahedra) != b.is_even(&mesh.tetrahedra);
                for face in [a, b] {
                    counts[face.slot as usize][0] += u8::from(fits);
                    counts[face.slot as usize][1] += 1;
                }
            }
        }
    }
    counts
}

/// Largest star of a vertex that is moved: all of it is looked at once for each inverted
/// tetrahedron there.
const MAX_STAR: usize = 512;

/// Moves vertices to make volumes positive, by rule 4.
fn right(mesh: &mut TetrahedronMesh, report: &mut TetrahedronRepairReport) {
    let inverted: Vec<[u32; 4]> =
        mesh.tetrahedra.iter().copied().filter(|&t| mesh.six_volumes(t) < 0.0).collect();
    if inverted.is_empty() {
        return;
    }
    let mut is_on_boundary = vec![false; mesh.positions.len()];
    let sides = Sides::new(&mesh.tetrahedra, mesh.positions.len());
    for (tetrahedron, bits) in mesh.tetrahedra.iter().zip(sides.boundary) {
        for corner in (0..4).filter(|corner| bits >> corner & 1 == 1) {
            FACES[corner].iter().for_each(|&i| is_on_boundary[tetrahedron[i] as usize] = true);
        }
    }
    let at_corners = (0..).zip(&mesh.tetrahedra).flat_map(|(slot, t)| t.map(|v| (v, slot)));
    let stars: Groups<u32> = Groups::new(mesh.positions.len(), at_corners);
    for tetrahedron in inverted {
        if mesh.six_volumes(tetrahedron) >= 0.0 {
            continue;
        }
        let may_move = |v: u32| !is_on_boundary[v as usize] && stars.of(v).len() <= MAX_STAR;
        for v in tetrahedron.into_iter().filter(|&v| may_move(v)) {
            if move_to_middle(mesh, v, stars.of(v)) {
                report.vertices_moved += 1;
                break;
            }
        }
    }
}

/// Drops inverted tetrahedra with two faces on the boundary whose other two meet in an edge inside,
/// by rule 4.
fn peel(mesh: &mut TetrahedronMesh, report: &mut TetrahedronRepairReport) {
    let is_inverted = |mesh: &TetrahedronMesh, i: usize| mesh.six_volumes(mesh.tetrahedra[i]) < 0.0;
    let inverted: Vec<usize> = (0..mesh.tetrahedra.len()).filter(|&i| is_inverted(mesh, i)).collect();
    if inverted.is_empty() {
        return;
    }
    let bits = Sides::new(&mesh.tetrahedra, mesh.positions.len()).boundary;
    let surface = boundary_triangles(&mesh.tetrahedra, mesh.positions.len());
    let edges: HashSet<[u32; 2]> =
        surface.iter().flat_map(|&[a, b, c]| [ascending(a, b), ascending(b, c), ascending(c, a)]).collect();
    let mut is_kept = vec![true; mesh.tetrahedra.len()];
    let mut is_touched = vec![false; mesh.positions.len()];
    for i in inverted {
        let corners = mesh.tetrahedra[i];
        let opposite: Vec<u32> =
            (0..4).filter(|corner| bits[i] >> corner & 1 == 1).map(|c| corners[c]).collect();
        let [a, b] = opposite[..] else { continue };
        let is_inside = !edges.contains(&ascending(a, b));
        let is_apart = !corners.iter().any(|&v| is_touched[v as usize]);
        if is_inside && is_apart {
            is_kept[i] = false;
            corners.iter().for_each(|&v| is_touched[v as usize] = true);
            report.tetrahedra_peeled += 1;
        }
    }
    let mut kept = is_kept.into_iter();
    mesh.tetrahedra.retain(|_| kept.next().unwrap_or(true));
}

fn ascending(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Moves a vertex with a star as little as makes every tetrahedron around it positive, or not at
/// all.
fn move_to_middle(mesh: &mut TetrahedronMesh, v: u32, star: &[u32]) -> bool {
    const PARTS: f32 = 16.0;
    let star: Vec<[u32; 4]> = star.iter().map(|&slot| mesh.tetrahedra[slot as usize]).collect();
    let others: Vec<u32> = star.iter().flatten().copied().filter(|&w| w != v).collect();
    let mut middle = [0.0_f32; 3];
    for &w in &others {
        let part = 1.0 / others.len() as f32;
        (0..3).for_each(|axis| middle[axis] += part * mesh.positions[w as usize][axis]);
    }
    let before = mesh.positions[v as usize];
    for step in 1..=16_u8 {
        let part = f32::from(step) / PARTS;
        mesh.positions[v as usize] =
            std::array::from_fn(|axis| before[axis] + part * (middle[axis] - before[axis]));
        if star.iter().all(|&t| mesh.six_volumes(t) > 0.0) {
            return true;
        }
    }
    mesh.positions[v as usize] = before;
    false
}

#[cfg(test)]
#[allow(clippy::cast_precision_loss, reason = "coordinates below 2^24")]
mod tests {
    use super::*;

    fn mesh(positions: &[[f32; 3]], tetrahedra: &[[u32; 4]]) -> TetrahedronMesh {
        TetrahedronMesh {
            positions: positions.to_vec(),
            tetrahedra: tetrahedra.to_vec(),
            ..Default::default()
        }
    }

    const POINTS: [[f32; 3]; 5] =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];

    #[test]
    fn every_rule_counts_what_it_does() {
        let mut points = POINTS.to_vec();
        // A copy of vertex 0, used beside it, and a vertex that nobody uses.
        points.extend([[-0.0, 0.0, 0.0], [5.0; 3]]);
        let tetrahedra = [[0, 1, 2, 3], [1, 2, 3, 4], [5, 2, 1, 3], [0, 5, 1, 2]];
        let (mesh, report) = repair_tetrahedra(&mesh(&points, &tetrahedra));
        assert_eq!(mesh.tetrahedra.len(), 2);
        assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0));
        let expected = TetrahedronRepairReport {
            vertices_welded: 1,
            vertices_unreferenced: 1,
            tetrahedra_degenerate: 1,
            tetrahedra_duplicate: 1,
            ..Default::default()
        };
        assert_eq!(report, expected);
    }

    #[test]
    fn wrong_orders_are_turned() {
        let (turned, report) = repair_tetrahedra(&mesh(&POINTS, &[[1, 0, 2, 3], [1, 2, 3, 4]]));
        assert_eq!((report.tetrahedra_turned, report.tetrahedra_inverted), (1, 0));
        assert!(turned.tetrahedra.iter().all(|&t| turned.six_volumes(t) > 0.0));
        let (_, report) = repair_tetrahedra(&mesh(&POINTS, &[[1, 0, 2, 3], [2, 1, 3, 4]]));
        assert_eq!((report.tetrahedra_turned, report.tetrahedra_inverted), (2, 0));
    }

    #[test]
    fn a_vertex_that_turns_a_tetrahedron_inside_out_is_moved_back() {
        // A vertex in the middle of a tetrahedron, pushed out through one of its faces.
        let around = |point| {
            let mut points = POINTS[..4].to_vec();
            points.push(point);
            mesh(&points, &[[4, 1, 2, 3], [0, 4, 2, 3], [0, 1, 4, 3], [0, 1, 2, 4]])
        };
        let (_, report) = repair_tetrahedra(&around([0.25; 3]));
        assert_eq!(report, TetrahedronRepairReport::default());
        let (righted, report) = repair_tetrahedra(&around([0.25, 0.25, -0.01]));
        assert_eq!((report.vertices_moved, report.tetrahedra_inverted), (1, 0));
        assert!((righted.volume() - 1.0 / 6.0).abs() < 1e-6);
    }

    #[test]
    fn an_inverted_tetrahedron_on_the_boundary_is_peeled_off() {
        // Four tetrahedra around the edge 0 1, the first of them turned inside out by its outer
        // vertex.
        let ring = |angle: f32| [angle.cos(), angle.sin(), 0.5];
        let mut points = vec![[0.0; 3], [0.0, 0.0, 1.0]];
        points.extend([0.0, 1.0, 2.0, 3.0, 4.0].map(ring));
        let fan = [[0, 1, 2, 3], [0, 1, 3, 4], [0, 1, 4, 5], [0, 1, 5, 6]];
        let (_, report) = repair_tetrahedra(&mesh(&points, &fan));
        assert_eq!(report, TetrahedronRepairReport::default());
        points[2] = ring(1.2);
        let (peeled, report) = repair_tetrahedra(&mesh(&points, &fan));
        assert_eq!(report.tetrahedra_peeled + report.tetrahedra_inverted, 1);
        assert_eq!(peeled.tetrahedra.len(), 4 - report.tetrahedra_peeled);
    }

    /// Copies of a mesh beside each other.
    fn copies(one: &TetrahedronMesh, n: u32) -> TetrahedronMesh {
        let n_vertices = u32::try_from(one.positions.len()).unwrap();
        let place = |i: u32| [(4 * (i % 256)) as f32, (4 * (i / 256)) as f32];
        let positions = (0..n).flat_map(|i| {
            let [right, up] = place(i);
            one.positions.iter().map(move |&[x, y, z]| [x + right, y + up, z])
        });
        let tetrahedra =
            (0..n).flat_map(|i| one.tetrahedra.iter().map(move |t| t.map(|v| v + i * n_vertices)));
        TetrahedronMesh {
            positions: positions.collect(),
            tetrahedra: tetrahedra.collect(),
            ..TetrahedronMesh::default()
        }
    }

    // In the three tests below, a pass over the mesh for each place would be ten thousand million
    // steps and more.

    #[test]
    fn vertices_that_turn_tetrahedra_inside_out_in_many_places_are_moved_back() {
        const N: u32 = 50_000;
        let mut points = POINTS[..4].to_vec();
        points.push([0.25, 0.25, -0.125]);
        let one = mesh(&points, &[[4, 1, 2, 3], [0, 4, 2, 3], [0, 1, 4, 3], [0, 1, 2, 4]]);
        let (_, report) = repair_tetrahedra(&copies(&one, N));
        assert_eq!((report.vertices_moved, report.tetrahedra_inverted), (N as usize, 0));
    }

    #[test]
    fn inverted_tetrahedra_in_many_places_are_peeled_off() {
        const N: u32 = 50_000;
        // A flat one over two others; two of its corners pushed up through the edge between the
        // other two.
        let points = |z| [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, z], [0.0, 1.0, z], [0.5, 0.5, -1.0]];
        let one = |z| mesh(&points(z), &[[0, 1, 2, 3], [3, 2, 0, 4], [2, 3, 1, 4]]);
        assert_eq!(repair_tetrahedra(&one(-0.125)).1, TetrahedronRepairReport::default());
        let one = one(0.125);
        let n_peeled = repair_tetrahedra(&one).1.tetrahedra_peeled;
        let (_, report) = repair_tetrahedra(&copies(&one, N));
        assert_eq!((n_peeled, report.tetrahedra_peeled), (1, N as usize));
    }

    #[test]
    fn very_many_vertices_at_one_place_are_welded() {
        // Two tetrahedra that share the place of an edge only, and flat ones in a chain, from its
        // end.
        const N: u32 = 300_000;
        let mut positions = vec![[9.0; 3]; N as usize];
        positions.extend([[8.0; 3], [7.0, 8.0, 9.0]]);
        let edge = [[0.0; 3], [1.0, 0.0, 0.0]];
        positions.extend(edge.into_iter().chain([[0.0, 1.0, 0.0], [0.0, 1.0, 1.0]]));
        positions.extend(edge.into_iter().chain([[0.0, -1.0, 0.0], [0.0, -1.0, -1.0]]));
        let flat = (1..N).rev().map(|i| [i, i - 1, N, N + 1]);
        let whole = [2, 6].map(|i| [i, i + 1, i + 2, i + 3].map(|v| v + N));
        let tetrahedra: Vec<[u32; 4]> = whole.into_iter().chain(flat).collect();
        let (_, report) = repair_tetrahedra(&mesh(&positions, &tetrahedra));
        assert_eq!((report.vertices_welded, report.vertices_coincident), (N as usize - 1, 2));
        assert_eq!(report.tetrahedra_degenerate, N as usize - 1);
    }
}
