//! From the tetrahedra of a file to tetrahedra that fit each other: weld, drop, turn, right, count
//! everything.
//!
//! A *point* is a place of the mesh. A *vertex* is a point with one value of each field. Where a
//! field jumps, at a fault or an interface, a point has several vertices, each of which belongs to
//! the tetrahedra on one side. Points decide how tetrahedra fit.
//!
//! The rules, in this order:
//!
//! 1. Vertices at one position become one point if the mesh stays one by it: everywhere if no face
//!    gets a third tetrahedron and no edge of the boundary a third face; otherwise only within
//!    tetrahedra, which are flat and go. A grid that is wrapped around on itself with crossing
//!    diagonals keeps its seam that way. Vertices of one point become one vertex if all their
//!    values agree.
//! 2. A tetrahedron with two corners in one point, or with the points of an earlier one, is
//!    dropped.
//! 3. Corners in the wrong order are put right: where the volume is negative and the faces do not
//!    fit those of the neighbours, or all are negative.
//! 4. What is negative still is turned inside out by its points. It is righted by moving one point
//!    inside the mesh towards the middle of its neighbours, if that makes all volumes around it
//!    positive. One whose points are all on the boundary is dropped if two of its faces are, and
//!    the boundary goes over to its other two. Others are kept.
//! 5. A tetrahedron of zero volume with four distinct points is kept: its neighbours are joined
//!    through it.
//! 6. Vertices that no tetrahedron uses are dropped.

use super::UsedVertices;
use super::places::n_moved;
use super::tetra_weld::{Weld, ascending, is_degenerate, is_first, weld};
use super::tetrahedra::{FACES, Sides, boundary_triangles, faces_by_least_vertex};
use crate::flat::{Groups, NO_INDEX};
use crate::geometry::distance::Triangle;
use crate::geometry::vector::widen;
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
    /// Vertices merged into another at the same position with the same values.
    pub vertices_welded: usize,
    /// Vertices at the point of another, kept for their values: a field jumps there.
    pub vertices_at_jumps: usize,
    /// Vertices at the position of another that are points of their own.
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
    /// Faces of the boundary that lie on others the other way round, as at the hanging nodes of a
    /// refined part: a wall inside.
    pub faces_at_hanging_nodes: usize,
    /// Values of fields that are not a number (NaN), kept. Deviations of their fields are over the
    /// other values.
    pub values_nan: usize,
    /// Values of fields that are infinite, kept. Deviations of their fields are over the other
    /// values.
    pub values_infinite: usize,
}

/// Tetrahedra that fit each other.
#[derive(Clone, Debug)]
pub(crate) struct RepairedVolume {
    /// Every vertex is used.
    pub mesh: TetrahedronMesh,
    /// The point of each vertex, named by its first vertex; `None` if each vertex is a point of its
    /// own.
    pub points: Option<Vec<u32>>,
    /// What the input's boundary has and that of the mesh does not, and the other way round.
    pub lost: LostParts,
    /// What was done.
    pub report: TetrahedronRepairReport,
}

/// Where the boundary of a repaired mesh is not that of the input. Triangles may be segments and
/// points.
#[derive(Clone, Debug, Default)]
pub(crate) struct LostParts {
    /// Tetrahedra that were dropped as degenerate, if nothing of the mesh covers them.
    pub loose: Vec<Triangle>,
    /// Faces of the mesh at the points of `loose`.
    pub beside_loose: Vec<Triangle>,
    /// Faces of the input's boundary that were peeled off.
    pub peeled: Vec<Triangle>,
    /// Faces of the mesh's boundary that came to light by that.
    pub bared: Vec<Triangle>,
}

/// Applies the rules of this module. O(n log n).
pub(crate) fn repair_tetrahedra(input: &TetrahedronMesh) -> RepairedVolume {
    let mut report = TetrahedronRepairReport::default();
    let Weld { points, vertices, n_apart, degenerate } = weld(input);
    let mut volume = Volume::new(input, &points, &vertices);
    report.vertices_coincident = n_apart;
    report.tetrahedra_degenerate = degenerate.len();
    drop_duplicates(&mut volume, &mut report);
    let mut lost = LostParts::default();
    volume.find_loose(degenerate, &mut lost);
    turn(&mut volume, &mut report);
    right(&mut volume.mesh, &mut report);
    peel(&mut volume, &mut report, &mut lost);
    let geometry = &volume.mesh;
    report.tetrahedra_flat = geometry.tetrahedra.iter().filter(|&&t| geometry.six_volumes(t) == 0.0).count();
    report.tetrahedra_inverted =
        geometry.tetrahedra.iter().filter(|&&t| geometry.six_volumes(t) < 0.0).count();
    report.faces_crowded = Sides::new(&geometry.tetrahedra, geometry.positions.len()).misfits.len();
    let (mesh, points) = volume.keep_used(input, &points);
    let points = named_by_first(&points, input.positions.len());
    report.vertices_welded = n_moved(&vertices);
    report.vertices_unreferenced = vertices.len() - mesh.positions.len() - report.vertices_welded;
    report.vertices_at_jumps = points.as_ref().map_or(0, |points| n_moved(points));
    let values = || mesh.attributes.iter().flat_map(Attribute::values);
    report.values_nan = values().filter(|value| value.is_nan()).count();
    report.values_infinite = values().filter(|value| value.is_infinite()).count();
    RepairedVolume { mesh, points, lost, report }
}

/// Points named by their first vertex, from names below `n_names`; `None` if each vertex has its
/// own.
fn named_by_first(points: &[u32], n_names: usize) -> Option<Vec<u32>> {
    let mut firsts = vec![NO_INDEX; n_names];
    let name = |(v, &point): (u32, &u32)| {
        let first = &mut firsts[point as usize];
        *first = (*first).min(v);
        *first
    };
    let named: Vec<u32> = (0..).zip(points).map(name).collect();
    (n_moved(&named) > 0).then_some(named)
}

/// A volume under repair: its geometry is over points, which are vertices of the input.
struct Volume {
    /// Without fields; the corners of its tetrahedra are points.
    mesh: TetrahedronMesh,
    /// The vertices at the corners of each tetrahedron, in the same order.
    corners: Vec<[u32; 4]>,
}

impl Volume {
    /// The tetrahedra with four points.
    fn new(input: &TetrahedronMesh, points: &[u32], vertices: &[u32]) -> Self {
        let over_points = |t: &[u32; 4]| t.map(|v| points[v as usize]);
        let (tetrahedra, corners) = (input.tetrahedra.iter())
            .map(|t| (over_points(t), t.map(|v| vertices[v as usize])))
            .filter(|&(over_points, _)| !is_degenerate(over_points))
            .unzip();
        let mesh = TetrahedronMesh {
            origin: input.origin,
            positions: input.positions.clone(),
            attributes: vec![],
            tetrahedra,
            rounding: input.rounding,
        };
        Self { mesh, corners }
    }

    /// Keeps those tetrahedra that are marked.
    fn retain(&mut self, is_kept: &[bool]) {
        for tetrahedra in [&mut self.mesh.tetrahedra, &mut self.corners] {
            let mut kept = is_kept.iter();
            tetrahedra.retain(|_| kept.next().copied().unwrap_or(true));
        }
    }

    /// Turns a tetrahedron.
    fn swap(&mut self, tetrahedron: usize) {
        self.mesh.tetrahedra[tetrahedron].swap(0, 1);
        self.corners[tetrahedron].swap(0, 1);
    }

    fn face(&self, tetrahedron: usize, corner: usize) -> Triangle {
        FACES[corner].map(|i| widen(self.mesh.positions[self.mesh.tetrahedra[tetrahedron][i] as usize]))
    }

    /// Sets apart the degenerate tetrahedra, each as its ascending points, that are no face, edge
    /// or corner of the others. O(n) if there are any.
    fn find_loose(&self, mut degenerate: Vec<[u32; 3]>, lost: &mut LostParts) {
        if degenerate.is_empty() {
            return;
        }
        degenerate.sort_unstable();
        degenerate.dedup();
        let mut is_at_one = vec![false; self.mesh.positions.len()];
        degenerate.as_flattened().iter().for_each(|&point| is_at_one[point as usize] = true);
        let mut is_loose = vec![true; degenerate.len()];
        for tetrahedron in self.mesh.tetrahedra.iter().filter(|t| t.iter().any(|&v| is_at_one[v as usize])) {
            for simplex in parts(*tetrahedron) {
                if let Ok(at) = degenerate.binary_search(&simplex) {
                    is_loose[at] = false;
                }
            }
        }
        is_at_one.fill(false);
        let loose: Vec<[u32; 3]> =
            degenerate.into_iter().zip(is_loose).filter(|&(_, is_loose)| is_loose).map(|(t, _)| t).collect();
        loose.as_flattened().iter().for_each(|&point| is_at_one[point as usize] = true);
        lost.loose = loose.iter().map(|t| t.map(|v| widen(self.mesh.positions[v as usize]))).collect();
        let faces = (0..self.mesh.tetrahedra.len()).flat_map(|t| (0..4).map(move |corner| (t, corner)));
        let is_beside = |&(t, corner): &(usize, usize)| {
            FACES[corner].iter().any(|&i| is_at_one[self.mesh.tetrahedra[t][i] as usize])
        };
        if !loose.is_empty() {
            lost.beside_loose = faces.filter(is_beside).map(|(t, corner)| self.face(t, corner)).collect();
        }
    }

    /// The volume over the vertices that are used, with the fields of `input`, and which of its
    /// vertices those are.
    fn keep_used(self, input: &TetrahedronMesh, points: &[u32]) -> (TetrahedronMesh, Vec<u32>) {
        let Self { mesh, corners: mut tetrahedra } = self;
        let used = UsedVertices::new(input.positions.len(), tetrahedra.as_flattened());
        used.renumber(tetrahedra.as_flattened_mut());
        let of_points = used.pick(points);
        let mesh = TetrahedronMesh {
            positions: of_points.iter().map(|&point| mesh.positions[point as usize]).collect(),
            attributes: used.pick_attributes(&input.attributes),
            tetrahedra,
            ..mesh
        };
        (mesh, of_points)
    }
}

/// The corners, edges and faces of a tetrahedron, each as three ascending points.
fn parts([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 20] {
    let edges = [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]];
    let of_edges = edges.into_iter().flat_map(|[p, q]| [[p, p, q], [p, q, q]]);
    let of_corners = [a, b, c, d].into_iter().map(|p| [p; 3]);
    let faces = [[a, b, c], [a, b, d], [a, c, d], [b, c, d]];
    let mut parts = [[0; 3]; 20];
    for (part, mut points) in parts.iter_mut().zip(of_edges.chain(of_corners).chain(faces)) {
        points.sort_unstable();
        *part = points;
    }
    parts
}

fn drop_duplicates(volume: &mut Volume, report: &mut TetrahedronRepairReport) {
    let is_first = is_first(&volume.mesh.tetrahedra);
    report.tetrahedra_duplicate = is_first.iter().filter(|is_first| !**is_first).count();
    volume.retain(&is_first);
}

/// Puts corners in the right order, by rule 3.
fn turn(volume: &mut Volume, report: &mut TetrahedronRepairReport) {
    let mesh = &volume.mesh;
    let negative: Vec<usize> =
        (0..mesh.tetrahedra.len()).filter(|&i| mesh.six_volumes(mesh.tetrahedra[i]) < 0.0).collect();
    if negative.is_empty() {
        return;
    }
    negative.iter().for_each(|&i| volume.swap(i));
    report.tetrahedra_turned = negative.len();
    if negative.len() == volume.mesh.tetrahedra.len() {
        return;
    }
    // Positive now, but those whose every shared face is seen from the side of the neighbour were
    // in order before.
    let fits = fitting_faces(&volume.mesh);
    for i in negative {
        let [n_fitting, n_shared] = fits[i];
        if n_shared > 0 && n_fitting == 0 {
            volume.swap(i);
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
fn peel(volume: &mut Volume, report: &mut TetrahedronRepairReport, lost: &mut LostParts) {
    let mesh = &volume.mesh;
    let is_inverted = |&i: &usize| mesh.six_volumes(mesh.tetrahedra[i]) < 0.0;
    let inverted: Vec<usize> = (0..mesh.tetrahedra.len()).filter(is_inverted).collect();
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
            for corner in 0..4 {
                let is_peeled = bits[i] >> corner & 1 == 1;
                let side = if is_peeled { &mut lost.peeled } else { &mut lost.bared };
                side.push(volume.face(i, corner));
            }
        }
    }
    volume.retain(&is_kept);
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

    fn repaired(input: &TetrahedronMesh) -> (TetrahedronMesh, TetrahedronRepairReport) {
        let RepairedVolume { mesh, report, .. } = repair_tetrahedra(input);
        (mesh, report)
    }

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
        let (mesh, report) = repaired(&mesh(&points, &tetrahedra));
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
        let (turned, report) = repaired(&mesh(&POINTS, &[[1, 0, 2, 3], [1, 2, 3, 4]]));
        assert_eq!((report.tetrahedra_turned, report.tetrahedra_inverted), (1, 0));
        assert!(turned.tetrahedra.iter().all(|&t| turned.six_volumes(t) > 0.0));
        let (_, report) = repaired(&mesh(&POINTS, &[[1, 0, 2, 3], [2, 1, 3, 4]]));
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
        let (_, report) = repaired(&around([0.25; 3]));
        assert_eq!(report, TetrahedronRepairReport::default());
        let (righted, report) = repaired(&around([0.25, 0.25, -0.01]));
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
        let (_, report) = repaired(&mesh(&points, &fan));
        assert_eq!(report, TetrahedronRepairReport::default());
        points[2] = ring(1.2);
        let (peeled, report) = repaired(&mesh(&points, &fan));
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
        let (_, report) = repaired(&copies(&one, N));
        assert_eq!((report.vertices_moved, report.tetrahedra_inverted), (N as usize, 0));
    }

    #[test]
    fn inverted_tetrahedra_in_many_places_are_peeled_off() {
        const N: u32 = 50_000;
        // A flat one over two others; two of its corners pushed up through the edge between the
        // other two.
        let points = |z| [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, z], [0.0, 1.0, z], [0.5, 0.5, -1.0]];
        let one = |z| mesh(&points(z), &[[0, 1, 2, 3], [3, 2, 0, 4], [2, 3, 1, 4]]);
        assert_eq!(repaired(&one(-0.125)).1, TetrahedronRepairReport::default());
        let one = one(0.125);
        let n_peeled = repaired(&one).1.tetrahedra_peeled;
        let (_, report) = repaired(&copies(&one, N));
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
        let (_, report) = repaired(&mesh(&positions, &tetrahedra));
        assert_eq!((report.vertices_welded, report.vertices_coincident), (N as usize - 1, 2));
        assert_eq!(report.tetrahedra_degenerate, N as usize - 1);
    }
}
