//! STL files, binary and text.

use super::colors;
use super::weld::weld;
use crate::files::contents::figure;
use crate::files::coordinates::{Coordinates, check_coordinate, from_f32, from_text};
use crate::files::error::{MeshError, Place};
use crate::files::faces::Faces;
use crate::files::report::ItemId;
use crate::files::text::{Scanner, Style};
use crate::{FileReport, Kind, MeshFormat, TriangleMesh};

const HEADER_BYTES: usize = 80;
const TRIANGLE_BYTES: usize = 50;

/// The length that a binary file with the triangle count in these bytes has.
pub(crate) fn length_of_binary(bytes: &[u8]) -> Option<u64> {
    let count = u32::from_le_bytes(*bytes.get(HEADER_BYTES..)?.first_chunk()?);
    Some(HEADER_BYTES as u64 + 4 + TRIANGLE_BYTES as u64 * u64::from(count))
}

/// Reads an STL file.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(crate) fn read(bytes: &[u8]) -> Result<(TriangleMesh, FileReport), MeshError> {
    let mut report = FileReport::new(MeshFormat::Stl);
    let (Coordinates { origin, positions: corners, rounding }, triangles) =
        if is_text(bytes) { read_text(bytes, &mut report)? } else { read_binary(bytes, &mut report)? };
    if triangles.is_empty() {
        return Err(MeshError::NoFaces { n_vertices: corners.len() });
    }
    let (positions, vertices) = weld(&corners);
    report.n_welded = corners.len() - positions.len();
    let triangles =
        triangles.iter().map(|triangle| triangle.map(|corner| vertices[corner as usize])).collect();
    Ok((TriangleMesh { origin, positions, triangles, attributes: Vec::new(), rounding }, report))
}

/// Whether a file is text: it begins with `solid`, has not the length of a binary file, and no NUL
/// near its beginning.
fn is_text(bytes: &[u8]) -> bool {
    const SEARCHED_BYTES: usize = 1024;
    let beginning = &bytes[..bytes.len().min(SEARCHED_BYTES)];
    let word = Scanner::new(beginning, Style::default()).word();
    length_of_binary(bytes) != Some(bytes.len() as u64)
        && word.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && !beginning.contains(&0)
}

/// Corners of all triangles, and the triangles over them.
type Soup = (Coordinates, Vec<[u32; 3]>);

fn read_binary(bytes: &[u8], report: &mut FileReport) -> Result<Soup, MeshError> {
    let found = bytes.len() as u64;
    let truncated = |what, expected| MeshError::Truncated { place: Place::Byte(0), what, expected, found };
    let mut expected =
        length_of_binary(bytes).ok_or_else(|| truncated("STL header", HEADER_BYTES as u64 + 4))?;
    let (records, rest) = bytes[HEADER_BYTES + 4..].as_chunks::<TRIANGLE_BYTES>();
    let stated = (expected - HEADER_BYTES as u64 - 4) / TRIANGLE_BYTES as u64;
    // Programs that write while they count leave 0 or all ones; a file that was cut claims too
    // much.
    let is_unknown = stated == u64::from(u32::MAX) && !records.is_empty();
    if rest.is_empty() && (stated < records.len() as u64 || is_unknown) {
        let n = figure(records.len() as u64);
        report.remark(format!(
            "the header states {} triangles, the file holds {n}, which are read",
            figure(stated)
        ));
        expected = found;
    }
    if found < expected {
        return Err(truncated("STL file", expected));
    }
    report.count(Kind::TrailingByte, found - expected);
    let n_triangles = usize::try_from((expected - HEADER_BYTES as u64 - 4) / TRIANGLE_BYTES as u64);
    let records = &records[..n_triangles.unwrap_or(usize::MAX).min(records.len())];
    let mut corners = Vec::with_capacity(3 * records.len());
    for record in records {
        // A normal, three corners, and two bytes, which may be a colour.
        let (values, _) = record[12..48].as_chunks::<4>();
        corners.extend(values.as_chunks::<3>().0.iter().map(|corner| corner.map(f32::from_le_bytes)));
    }
    colors::register(&bytes[..HEADER_BYTES], records, report);
    let coordinates = from_f32(corners)?;
    let triangles = (0..corner_number(coordinates.positions.len())?)
        .step_by(3)
        .map(|corner| [corner, corner + 1, corner + 2]);
    Ok((coordinates, triangles.collect()))
}

fn read_text(bytes: &[u8], report: &mut FileReport) -> Result<Soup, MeshError> {
    let mut scanner = Scanner::new(bytes, Style::default());
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut faces = Faces::default();
    let mut face: Vec<u32> = Vec::new();
    let mut solid: Option<ItemId> = None;
    let mut is_closed = false;
    while let Some(word) = scanner.word() {
        is_closed = false;
        match word.to_ascii_lowercase().as_slice() {
            b"solid" => {
                let name = scanner.rest_of_line();
                solid = (!name.is_empty()).then(|| report.named(Kind::Solid, &name));
            }
            // The normal's three numbers are not looked at: some programs write `nan` or `-1.#IND`.
            b"facet" => pass_words(&mut scanner, 4),
            b"outer" => pass_words(&mut scanner, 1),
            b"vertex" => {
                let point = [scanner.number()?, scanner.number()?, scanner.number()?];
                point.iter().try_for_each(|&value| check_coordinate(value, scanner.place()))?;
                face.push(corner_number(points.len())?);
                points.push(point);
            }
            b"endloop" => {
                if let Some(solid) = solid {
                    report.grow(solid, face.len().saturating_sub(2) as u64, "triangles");
                }
                faces.push(&std::mem::take(&mut face));
            }
            b"endfacet" => {}
            b"endsolid" => {
                scanner.rest_of_line();
                is_closed = true;
            }
            _ => return Err(scanner.unexpected("an STL keyword", Some(word))),
        }
    }
    if !is_closed {
        return Err(scanner.unexpected("endsolid", None));
    }
    let coordinates = from_text(&points)?;
    let triangles = faces.into_triangles(&coordinates.positions, report);
    Ok((coordinates, triangles))
}

fn pass_words(scanner: &mut Scanner<'_>, n_words: usize) {
    for _ in 0..n_words {
        scanner.word();
    }
}

fn corner_number(corner: usize) -> Result<u32, MeshError> {
    let (count, limit) = (corner as u64 + 1, u64::from(u32::MAX));
    u32::try_from(corner).map_err(|_| MeshError::CountTooLarge {
        place: Place::File,
        what: "corners",
        count,
        limit,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid a facet of life\n facet normal 0 0 -1.#IND\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
        vertex 0 1 0\n  endloop\n endfacet\n FACET NORMAL 0 0 1\n  OUTER LOOP\n   VERTEX 1 0 0\n   VERTEX 1.0 1e0 0\n   \
        VERTEX 0 1 -0\n  ENDLOOP\n ENDFACET\nendsolid a facet of life\n";

    fn binary(name: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = name.to_vec();
        bytes.resize(HEADER_BYTES, b' ');
        bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|value| value.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn text_is_welded() {
        let (mesh, report) = read(TEXT.as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(report.n_welded, 2);
    }

    #[test]
    fn binary_that_begins_with_solid_is_told_by_its_length() {
        let bytes = binary(b"solid something", &[TRIANGLE, TRIANGLE]);
        let (mesh, report) = read(&bytes).unwrap();
        assert_eq!((mesh.positions.len(), mesh.triangles.len(), report.n_welded), (3, 2, 3));
    }

    #[test]
    fn wrong_lengths_are_told_apart() {
        let mut bytes = binary(b"x", &[TRIANGLE]);
        bytes.push(0);
        let (_, report) = read(&bytes).unwrap();
        assert_eq!(report.notes(), ["1 byte behind the mesh is left out"]);
        bytes.truncate(100);
        let message = "STL file at byte 0 is cut short: 134 bytes expected, 100 found";
        assert_eq!(read(&bytes).unwrap_err().to_string(), message);
        bytes[80..84].fill(0xff);
        let error = read(&bytes[..84]).unwrap_err();
        assert!(
            matches!(error, MeshError::Truncated { expected: 214_748_364_834, found: 84, .. }),
            "{error}"
        );
        assert!(matches!(read(b"").unwrap_err(), MeshError::Truncated { expected: 84, found: 0, .. }));
        assert!(matches!(read(&binary(b"x", &[])).unwrap_err(), MeshError::NoFaces { n_vertices: 0 }));
    }

    #[test]
    fn text_faults_are_named_by_line() {
        let check = |from: &str, to: &str, message: &str| {
            assert_eq!(read(TEXT.replacen(from, to, 1).as_bytes()).unwrap_err().to_string(), message);
        };
        check("vertex 1 0 0", "vertex 1 x 0", "line 5: expected a number, found \"x\"");
        check("vertex 1 0 0", "vertex 1 inf 0", "line 5: coordinate inf is not finite");
        check("endloop", "end loop", "line 7: expected an STL keyword, found \"end\"");
        check("endsolid a facet of life\n", "", "line 16: expected endsolid, found the end of the file");
    }

    #[test]
    fn loops_of_more_corners_are_cut_and_of_fewer_dropped() {
        let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n\
            endfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid";
        let (mesh, report) = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.triangles.len(), 2);
        assert_eq!((report.n_polygons_triangulated, report.n_faces_dropped), (1, 1));
    }

    #[test]
    fn coordinates_that_are_not_finite_name_their_corner() {
        let bytes = binary(b"x", &[TRIANGLE, [[0.0; 3], [f32::NAN; 3], [1.0; 3]]]);
        let error = read(&bytes).unwrap_err();
        assert!(matches!(error, MeshError::NonFinite { place: Place::Item("vertex", 4), .. }), "{error}");
    }
}
