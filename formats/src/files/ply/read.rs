//! The elements of a PLY file, one after another, made into a mesh.

use super::binary::Binary;
use super::corners::CornerTexcoords;
use super::face::{Record, Wanted};
use super::header::{Element, Encoding, Header};
use super::text::{Layout, Text};
use crate::files::error::{MeshError, Place};
use crate::files::face_colors::FaceColors;
use crate::files::faces::Faces;
use crate::files::vertices::Vertices;
use crate::{FileReport, Kind, MeshFormat, TriangleMesh};

/// Reads a PLY file.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(crate) fn read(bytes: &[u8]) -> Result<(TriangleMesh, FileReport), MeshError> {
    let header = Header::parse(bytes)?;
    match header.encoding {
        Encoding::Text => {
            let by_words = read_elements(&header, Text::new(bytes, &header, Layout::Words));
            by_words.or_else(|error| {
                let by_lines = read_elements(&header, Text::new(bytes, &header, Layout::Lines));
                by_lines.map_err(|_| error)
            })
        }
        encoding => read_elements(&header, Binary::new(bytes, header.data_start, encoding)),
    }
}

/// The values after a header, as text or as bytes; elements are taken from it in the header's
/// order.
pub(crate) trait Values {
    /// Positions and attributes from the vertex element.
    fn vertices(&mut self, element: &Element, report: &mut FileReport) -> Result<Vertices, MeshError>;

    /// Calls `visit` with the place and the wanted values of every record.
    fn records(&mut self, element: &Element, wanted: &Wanted, visit: &mut Visit<'_>)
    -> Result<(), MeshError>;

    /// Adds faces that have nothing but indices, every index below `n_vertices`.
    fn faces(
        &mut self,
        element: &Element,
        wanted: &Wanted,
        n_vertices: u32,
        faces: &mut Faces,
    ) -> Result<(), MeshError> {
        let mut corners = Vec::new();
        self.records(element, wanted, &mut |place, record| {
            check_indices(&record.indices, n_vertices, place, &mut corners)?;
            faces.push(&corners);
            Ok(())
        })
    }

    /// Passes over an element.
    fn skip(&mut self, element: &Element) -> Result<(), MeshError>;

    /// Lines of which the rest was passed over.
    fn n_lines_cut(&self) -> usize {
        0
    }

    /// Bytes after the last element.
    fn n_trailing_bytes(&mut self) -> usize;
}

/// What is called with each record.
pub(crate) type Visit<'a> = dyn FnMut(Place, &Record) -> Result<(), MeshError> + 'a;

fn read_elements(header: &Header, mut values: impl Values) -> Result<(TriangleMesh, FileReport), MeshError> {
    let mut report = FileReport::new(MeshFormat::Ply);
    let n_vertices = n_vertices(header)?;
    for texture in &header.textures {
        report.named(Kind::Texture, texture);
    }
    let mut vertices = None;
    let mut faces = Faces::default();
    let mut texcoords = None;
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" | "vertices" if vertices.is_none() => {
                vertices = Some(values.vertices(element, &mut report)?);
            }
            "face" | "faces" if element.count > 0 => {
                let wanted = Wanted::of_faces(element)?;
                note_face_data(element, &wanted, &mut report);
                if wanted.texcoords.is_some() || !wanted.colors.is_empty() {
                    check_vertices_fit(header, n_vertices)?;
                    let into = (&mut faces, &mut texcoords);
                    dressed_faces(&mut values, (element, &wanted), n_vertices, into, &mut report)?;
                } else {
                    values.faces(element, &wanted, n_vertices, &mut faces)?;
                }
            }
            "tristrips" if element.count > 0 => {
                let wanted = Wanted::indices_of(element, "tristrips element")?;
                values.records(element, &wanted, &mut |place, record| {
                    add_strips(place, &record.indices, n_vertices, &mut faces)
                })?;
            }
            _ => {
                let id = report.named(Kind::Element, &element.name);
                report.grow(id, element.count, "records");
                values.skip(element)?;
            }
        }
    }
    let n_lines = values.n_lines_cut();
    if n_lines > 0 {
        report
            .remark(format!("the rest of {n_lines} lines is left out: it is more than the header declares"));
    }
    report.count(Kind::TrailingByte, values.n_trailing_bytes() as u64);
    let mut vertices =
        vertices.ok_or(MeshError::Missing { place: Place::Part("header"), what: "vertex element" })?;
    if let Some(texcoords) = texcoords {
        texcoords.finish(&mut vertices.points, &mut vertices.attributes, &mut report);
    }
    vertices.into_mesh(faces, report)
}

/// Number of vertices that the header announces, known before any face is read.
fn n_vertices(header: &Header) -> Result<u32, MeshError> {
    let vertex =
        header.elements.iter().find(|element| matches!(element.name.as_str(), "vertex" | "vertices"));
    let count =
        vertex.ok_or(MeshError::Missing { place: Place::Part("header"), what: "vertex element" })?.count;
    let limit = u64::from(u32::MAX);
    let too_large = MeshError::CountTooLarge { place: Place::Part("header"), what: "vertices", count, limit };
    u32::try_from(count).map_err(|_| too_large)
}

/// Refuses a number of vertices that the file has no room for, where they come behind the faces.
fn check_vertices_fit(header: &Header, n_vertices: u32) -> Result<(), MeshError> {
    let (count, limit) = (u64::from(n_vertices), header.n_bytes as u64);
    let place = Place::Part("header");
    if count > limit {
        return Err(MeshError::CountTooLarge { place, what: "vertices", count, limit });
    }
    Ok(())
}

/// Names the properties of faces that are not read.
fn note_face_data(element: &Element, wanted: &Wanted, report: &mut FileReport) {
    for (_, property) in element.properties.iter().enumerate().filter(|&(place, _)| !wanted.has(place)) {
        let id = report.named(Kind::FaceData, &property.name);
        report.grow(id, element.count, "faces");
    }
}

/// Adds faces that have texture coordinates at their corners, or colours, which are counted.
fn dressed_faces(
    values: &mut impl Values,
    (element, wanted): (&Element, &Wanted),
    n_vertices: u32,
    (faces, texcoords): (&mut Faces, &mut Option<CornerTexcoords>),
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let mut colors = FaceColors::default();
    let mut corners = Vec::new();
    values.records(element, wanted, &mut |place, record| {
        check_indices(&record.indices, n_vertices, place, &mut corners)?;
        if wanted.texcoords.is_some() {
            let texcoords = texcoords.get_or_insert_with(|| CornerTexcoords::new(n_vertices));
            texcoords.apply(&mut corners, &record.texcoords, place)?;
        }
        if !wanted.colors.is_empty() {
            colors.add(wanted.color(record), corners.len().saturating_sub(2) as u64);
        }
        faces.push(&corners);
        Ok(())
    })?;
    colors.register(report);
    Ok(())
}

/// Adds the strips of one list, which negative indices (also written as the largest unsigned one)
/// separate.
fn add_strips(place: Place, indices: &[i64], n_vertices: u32, faces: &mut Faces) -> Result<(), MeshError> {
    let mut strip = Vec::new();
    for part in indices.split(|&index| index == -1 || index == i64::from(u32::MAX)) {
        strip.clear();
        for &index in part {
            strip.push(check_index(index, n_vertices, place)?);
        }
        faces.push_strip(&strip);
    }
    Ok(())
}

/// Indices as they are stored, if all point at vertices.
fn check_indices(
    indices: &[i64],
    n_vertices: u32,
    place: Place,
    corners: &mut Vec<u32>,
) -> Result<(), MeshError> {
    corners.clear();
    for &index in indices {
        corners.push(check_index(index, n_vertices, place)?);
    }
    Ok(())
}

/// An index as it is stored, if it points at a vertex.
pub(crate) fn check_index(index: i64, n_vertices: u32, place: Place) -> Result<u32, MeshError> {
    let count = u64::from(n_vertices);
    let valid = u32::try_from(index).ok().filter(|&index| index < n_vertices);
    valid.ok_or(MeshError::IndexOutOfRange { place, what: "vertex", index, count })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ScalarType;

    const TEXT: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n\
        property list uchar int vertex_indices\nend_header\n\
        0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 9 9 9\n3 0 1 2\n3 0 2 3\n";

    fn check_error(text: &str, message: &str) {
        assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), message);
    }

    #[test]
    fn text_gives_vertices_faces_and_colours() {
        let (mesh, report) = read(TEXT.as_bytes()).unwrap();
        assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        let color = mesh.attribute("color").unwrap();
        assert_eq!((color.scalar, color.n_components), (ScalarType::U8, 3));
        assert_eq!(color.bytes, [255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9]);
        assert!(report.notes().is_empty());
    }

    #[test]
    fn faces_may_come_first_and_unknown_elements_anywhere() {
        let text = "ply\nformat ascii 1.0\nelement edge 1\nproperty int a\nproperty int b\nelement face 1\n\
            property list int uint vertex_index\nproperty float q\nelement vertex 3\nproperty list uchar int tags\n\
            property double z\nproperty int y\nproperty char x\nend_header\n5 6 3 0 1 2 0.5 2 7 7 0 0 1 0 0 2 0 1 9 0 0 0";
        let (mesh, report) = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.positions, [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]]);
        let notes = [
            "element \"edge\" (1 record) is left out",
            "face data \"q\" (1 face) is left out",
            "attribute \"tags\" is left out: it is a list",
        ];
        assert_eq!(report.notes(), notes);
    }

    #[test]
    fn other_lists_of_a_face_are_passed_over() {
        let text = TEXT
            .replace("vertex_indices\n", "vertex_indices\nproperty list uchar float texcoord\n")
            .replace("3 0 1 2\n3 0 2 3\n", "3 0 1 2 2 0.5 0.5\n3 0 2 3 0\n");
        assert_eq!(read(text.as_bytes()).unwrap().0.triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn more_values_than_declared_are_cut_off_by_line() {
        let text = TEXT.replace("3 0 1 2\n3 0 2 3\n", "3 0 1 2 77 78\n3 0 2 3 9\n");
        let (mesh, report) = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        let rest = "the rest of 2 lines is left out: it is more than the header declares";
        assert_eq!(report.notes(), [rest]);
        let one_line = TEXT.replace("2 3\n", "2 3").replace("1 2\n", "1 2 ");
        assert_eq!(read(one_line.as_bytes()).unwrap().0.triangles, mesh.triangles);
    }

    #[test]
    fn strips_restart_and_drop_their_joints() {
        let strips = TEXT
            .replace("element face 2\nproperty list uchar int", "element tristrips 1\nproperty list int int")
            .replace("3 0 1 2\n3 0 2 3\n", "9 0 1 2 3 3 -1 1 2 3\n");
        let (mesh, _) = read(strips.as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [1, 2, 3]]);
    }

    #[test]
    fn contents_at_fault_are_named_by_line() {
        check_error(&TEXT.replace("3 0 2 3", "3 0 2 4"), "line 18: vertex index 4 is out of range (4 there)");
        check_error(
            &TEXT.replace("3 0 2 3", "3 0 -2 3"),
            "line 18: vertex index -2 is out of range (4 there)",
        );
        check_error(&TEXT.replace("1 1 0 0", "1 nan 0 0"), "line 15: coordinate NaN is not finite");
        check_error(
            &TEXT.replace("1 1 0 0", "1 1e39 0 0"),
            "line 15: coordinate 1e39 is beyond the range of single precision",
        );
        check_error(
            &TEXT.replace("9 9 9", "9 900 9"),
            "line 16: expected a value of the property's type, found \"900\"",
        );
        check_error(&TEXT.replace("3 0 2 3\n", ""), "the file ends at line 18 after 1 of 2 faces");
        check_error(&TEXT.replace("3 0 2 3\n", "-1"), "line 18: expected the length of a list, found \"-1\"");
        check_error(&TEXT.replace("property float z\n", "property float w\n"), "the vertex element has no z");
        check_error(
            &TEXT.replace("vertex_indices", "corners"),
            "the face element has no list vertex_indices",
        );
        check_error(&TEXT.replace("3 0 1 2\n3 0 2 3\n", "0\n2 0 1\n"), "no faces (4 vertices)");
    }

    #[test]
    fn giant_counts_are_refused_before_anything_is_allocated() {
        check_error(
            &TEXT.replace("vertex 4", "vertex 18446744073709551615"),
            "the header: 18446744073709551615 vertices announced, there can be at most 4294967295",
        );
        check_error(
            &TEXT.replace("vertex 4", "vertex 4000000000"),
            "line 13: 4000000000 vertices announced, there can be at most 5",
        );
        check_error(
            &TEXT.replace("3 0 2 3", "4000000000 0 2 3"),
            "line 18: 4000000000 list items announced, there can be at most 4",
        );
    }
}
