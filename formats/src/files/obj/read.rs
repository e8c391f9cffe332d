//! The statements of an OBJ file made into a mesh.

use std::collections::HashMap;

use super::parse::{NONE, Statements};
use crate::files::coordinates::Points;
use crate::files::error::{MeshError, Place};
use crate::files::faces::Faces;
use crate::files::normals::{COMPUTED, smooth};
use crate::files::vertices::{assemble, place_of};
use crate::{Attribute, Change, FileReport, Kind, MeshFormat, TriangleMesh};

/// Reads an OBJ file.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(crate) fn read(bytes: &[u8]) -> Result<(TriangleMesh, FileReport), MeshError> {
    let mut report = FileReport::new(MeshFormat::Obj);
    let statements = Statements::parse(bytes, &mut report)?;
    let vertices = Vertices::number(&statements)?;
    let mut faces = Faces::default();
    let mut start = 0;
    for &end in &statements.face_ends {
        faces.push(&vertices.of_corners[start..end]);
        start = end;
    }
    note_further_numbers(&statements, &mut report);
    let points: Vec<[f64; 3]> =
        vertices.triples.iter().map(|triple| statements.positions[triple[0] as usize]).collect();
    let mut attributes = attributes(&statements, &vertices, &mut report);
    fill_normals(&points, &faces, &vertices, &mut attributes, &mut report);
    let place_of = |vertex: usize| place_of(&statements.bad_places, vertices.triples[vertex][0] as usize);
    assemble(Points::Text(points), attributes, faces, &place_of, report)
}

/// Registers numbers behind those that are read.
fn note_further_numbers(statements: &Statements, report: &mut FileReport) {
    for (name, n, unit) in [
        ("weight", statements.n_weights, "vertices"),
        ("third texture coordinate", statements.n_third_texcoords, "lines"),
    ] {
        if n > 0 {
            let id = report.found(Kind::Attribute, name);
            report.grow(id, n, unit);
        }
    }
}

/// Computes the normals of vertices that have none where others have.
fn fill_normals(
    points: &[[f64; 3]],
    faces: &Faces,
    vertices: &Vertices,
    attributes: &mut [Attribute],
    report: &mut FileReport,
) {
    let Some(normal) = attributes.iter_mut().find(|attribute| attribute.name == "normal") else { return };
    let lacks = |(vertex, triple): (usize, &[u32; 3])| {
        triple[2] == NONE && vertices.is_used.get(vertex).is_none_or(|&is_used| is_used)
    };
    let n_vertices = vertices.triples.iter().enumerate().filter(|&pair| lacks(pair)).count() as u64;
    if n_vertices == 0 {
        return;
    }
    let normals = smooth(points, faces.fans());
    for (vertex, (bytes, triple)) in
        normal.bytes.as_chunks_mut::<12>().0.iter_mut().zip(&vertices.triples).enumerate()
    {
        if triple[2] == NONE {
            for (bytes, value) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(normals[vertex]) {
                *bytes = value.to_le_bytes();
            }
        }
    }
    let id = report.named(Kind::Attribute, "normal");
    report.change(id, Change::Filled { n_vertices, value: COMPUTED });
}

/// The mesh's vertices: distinct triples of position, texture coordinate and normal.
struct Vertices {
    /// The triple of each vertex; the first ones in the order of the positions, so that vertex `i`
    /// has position `i`.
    triples: Vec<[u32; 3]>,
    /// The vertex of each corner.
    of_corners: Vec<u32>,
    /// Whether a face uses the position of the same number.
    is_used: Vec<bool>,
}

impl Vertices {
    /// Gives every corner a vertex. Expected linear time.
    ///
    /// # Errors
    ///
    /// [`MeshError::CountTooLarge`] for more vertices than `u32` can number.
    fn number(statements: &Statements) -> Result<Self, MeshError> {
        let n_positions = statements.positions.len();
        vertex_number(n_positions)?;
        let mut triples: Vec<[u32; 3]> =
            (0..).take(n_positions).map(|position| [position, NONE, NONE]).collect();
        let mut is_used = vec![false; n_positions];
        let mut further: HashMap<[u32; 3], u32> = HashMap::new();
        let mut of_corners = Vec::with_capacity(statements.corners.len());
        for &corner in &statements.corners {
            let position = corner[0] as usize;
            if !is_used[position] {
                is_used[position] = true;
                triples[position] = corner;
            }
            if triples[position] == corner {
                of_corners.push(corner[0]);
                continue;
            }
            let next = vertex_number(triples.len())?;
            let vertex = *further.entry(corner).or_insert(next);
            if vertex == next {
                triples.push(corner);
            }
            of_corners.push(vertex);
        }
        Ok(Self { triples, of_corners, is_used })
    }

    /// Values of a list for every vertex, `neutral` where a triple has none; empty where no triple
    /// has one.
    fn gather<const N: usize>(
        &self,
        (name, list): (&'static str, usize),
        values: &[[f32; N]],
        neutral: [f32; N],
        report: &mut FileReport,
    ) -> Option<Attribute> {
        if values.is_empty() {
            return None;
        }
        let id = report.named(Kind::Attribute, name);
        let n_given = self.triples.iter().filter(|triple| triple[list] != NONE).count();
        if n_given == 0 {
            report.leave_out(id, "no face uses it");
            return None;
        }
        report.keep(id);
        let n_unused = self.is_used.iter().filter(|&&is_used| !is_used).count();
        let n_vertices = self.triples.len() - n_unused - n_given;
        if n_vertices > 0 && name != "normal" {
            report.change(id, Change::Filled { n_vertices: n_vertices as u64, value: "zero" });
        }
        let value = |triple: &[u32; 3]| values.get(triple[list] as usize).copied().unwrap_or(neutral);
        let n_components = u32::try_from(N).unwrap_or(u32::MAX);
        Some(Attribute::from_f32(name, n_components, self.triples.iter().flat_map(value)))
    }
}

/// Colours, texture coordinates and normals of all vertices, those that the file gives.
fn attributes(statements: &Statements, vertices: &Vertices, report: &mut FileReport) -> Vec<Attribute> {
    let mut attributes = Vec::new();
    if statements.n_colored > 0 {
        let n_vertices = (statements.positions.len() - statements.n_colored) as u64;
        let id = report.found(Kind::Attribute, "color");
        report.keep(id);
        if n_vertices > 0 {
            report.change(id, Change::Filled { n_vertices, value: "white" });
        }
        let n_components = statements.n_color_components;
        let color = |triple: &[u32; 3]| {
            let color = statements.colors.get(triple[0] as usize).copied().unwrap_or([1.0; 4]);
            color.into_iter().take(n_components as usize)
        };
        attributes.push(Attribute::from_f32("color", n_components, vertices.triples.iter().flat_map(color)));
    }
    attributes.extend(vertices.gather(("texcoord", 1), &statements.texcoords, [0.0; 2], report));
    attributes.extend(vertices.gather(("normal", 2), &statements.normals, [0.0; 3], report));
    attributes
}

fn vertex_number(index: usize) -> Result<u32, MeshError> {
    let limit = u64::from(u32::MAX);
    let too_large =
        MeshError::CountTooLarge { place: Place::File, what: "vertices", count: index as u64 + 1, limit };
    u32::try_from(index).ok().filter(|&index| index != NONE).ok_or(too_large)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    fn read_text(text: &str) -> (TriangleMesh, FileReport) {
        read(text.as_bytes()).unwrap()
    }

    fn check_error(text: &str, message: &str) {
        assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), message);
    }

    fn floats(attribute: &Attribute) -> Vec<f64> {
        attribute.values().collect()
    }

    #[test]
    fn all_ways_to_write_a_corner() {
        let lists = format!("{SQUARE}vt 0 0\nvt 1 0\nvn 0 0 1\n");
        for face in [
            "f 1 2 3",
            "f 1/1 2/1 3/2",
            "f 1//1 2//1 3//1",
            "f 1/1/1 2/2/1 3/1/1",
            "f -4 -3 -2",
            "f -4/-2/-1 2 3",
        ] {
            assert_eq!(read_text(&format!("{lists}{face}\n")).0.triangles, [[0, 1, 2]], "{face}");
        }
    }

    #[test]
    fn seams_make_vertices_in_first_seen_order() {
        let (mesh, report) = read_text(&format!(
            "{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\nf 1/1 2/2 3/3\nf 1/5 3/3 4/4\nf 1/5 2/1 4/4\n"
        ));
        assert_eq!(mesh.triangles, [[0, 1, 2], [4, 2, 3], [4, 5, 3]]);
        assert_eq!(mesh.positions[4..], [mesh.positions[0], mesh.positions[1]]);
        let texcoord = floats(mesh.attribute("texcoord").unwrap());
        // V is counted from the bottom in the file.
        assert_eq!(texcoord[8..], [0.5, 0.5, 0.0, 1.0]);
        assert!(report.notes().is_empty());
    }

    #[test]
    fn colours_follow_positions_and_gaps_are_filled_white() {
        let (mesh, report) = read_text("v 0 0 0\nv 1 0 0 0.5 0.25 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
        let color = mesh.attribute("color").unwrap();
        assert_eq!(
            (color.n_components, floats(color)),
            (3, vec![1.0, 1.0, 1.0, 0.5, 0.25, 0.0, 1.0, 0.0, 0.0])
        );
        assert_eq!(report.notes(), ["attribute \"color\" is absent at 1 vertex and white there"]);
    }

    #[test]
    fn continued_lines_forward_indices_and_other_statements() {
        let (mesh, report) = read_text(&format!(
            "mtllib a.mtl\no thing\nf 1 2 \\\n 3 4\n{SQUARE}g x\nusemtl y\ns off\nl 1 2\np 1\nf 1 2\n"
        ));
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!((report.n_polygons_triangulated, report.n_faces_dropped), (1, 1));
        let notes = [
            "material library \"a.mtl\" is left out",
            "object \"thing\" (2 triangles) is left out",
            "group \"x\" is left out",
            "material \"y\" is left out",
            "1 line is left out",
            "1 point is left out",
            "1 face with fewer than 3 corners is left out",
        ];
        assert_eq!(report.notes(), notes);
    }

    #[test]
    fn unused_positions_keep_their_numbers() {
        let (mesh, report) = read_text(&format!("{SQUARE}vn 0 0 1\nf 1//1 3//1 4//1\n"));
        assert_eq!((mesh.positions.len(), mesh.triangles[0]), (4, [0, 2, 3]));
        assert!(report.notes().is_empty());
    }

    #[test]
    fn faults_are_named_by_line() {
        check_error(&format!("{SQUARE}f 1 2 5\n"), "line 5: vertex index 5 is out of range (4 there)");
        check_error(&format!("{SQUARE}f 1 2 -5\n"), "line 5: vertex index -5 is out of range (4 there)");
        check_error(&format!("{SQUARE}f 0 1 2\n"), "line 5: vertex index 0 is out of range (4 there)");
        check_error(
            &format!("{SQUARE}f 6148914691236517207 1 2\n"),
            "line 5: vertex index 6148914691236517207 is out of range (4 there)",
        );
        check_error(
            &format!("{SQUARE}f 4294967296 1 2\n"),
            "line 5: vertex index 4294967296 is out of range (4 there)",
        );
        check_error(
            &format!("{SQUARE}f 1/1 2 3\n"),
            "line 5: texture coordinate index 1 is out of range (0 there)",
        );
        check_error(&format!("{SQUARE}f 1//9 2 3\n"), "line 5: normal index 9 is out of range (0 there)");
        check_error(&format!("{SQUARE}f 1 2 a\n"), "line 5: expected an index, found \"a\"");
        check_error(
            &format!("{SQUARE}f 1/1/1/1 2 3\n"),
            "line 5: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found \"1/1/1/1\"",
        );
        check_error("v 1 2\nf 1 1 1\n", "line 1: expected three coordinates, found the end of the line");
        check_error("\nv 1 inf 0\nf 1 1 1\n", "line 2: coordinate inf is not finite");
        check_error("v 1 x 0\n", "line 1: expected a number, found \"x\"");
        check_error(SQUARE, "no faces (4 vertices)");
        check_error("", "no faces (0 vertices)");
    }
}
