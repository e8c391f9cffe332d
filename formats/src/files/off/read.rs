//! OFF files as text, and what they share with binary ones.

use super::binary;
use super::columns::Columns;
use super::keyword::Keyword;
use crate::files::coordinates::{Points, check_coordinate};
use crate::files::error::{MeshError, Place};
use crate::files::face_colors::{FaceColors, from_unit};
use crate::files::faces::Faces;
use crate::files::text::{Scanner, Style, parse_integer, parse_number};
use crate::files::vertices::Vertices;
use crate::{FileReport, Kind, MeshFormat, TriangleMesh};

/// Reads an OFF file; the keyword `OFF` may be missing, as its definition allows.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(crate) fn read(bytes: &[u8]) -> Result<(TriangleMesh, FileReport), MeshError> {
    let mut scanner = Scanner::new(bytes, Style { hash_comments: true, continued_lines: false });
    let mut word = scanner.word();
    let mut keyword = Keyword::default();
    if let Some(found) = word.and_then(Keyword::parse) {
        keyword = found;
        word = scanner.word();
    }
    if keyword.has_other_dimension {
        let feature = "OFF with other than three coordinates".to_owned();
        return Err(MeshError::Unsupported { place: Place::Line(1), feature });
    }
    let mut report = FileReport::new(MeshFormat::Off);
    if word == Some(b"BINARY") {
        scanner.next_line();
        let (vertices, faces) = binary::read(&scanner, keyword, &mut report)?;
        return vertices.into_mesh(faces, report);
    }
    let n_vertices = count(&scanner, word, "vertices")?;
    let word = scanner.word();
    let n_faces = count(&scanner, word, "faces")?;
    // The number of edges is not used, and some files lack it.
    scanner.next_line();
    let vertices = vertices(&mut scanner, keyword, n_vertices, &mut report)?;
    let faces = faces(&mut scanner, n_faces, n_vertices, &mut report)?;
    if let Some(word) = scanner.word() {
        report.count(Kind::TrailingByte, (word.len() + scanner.n_bytes_left()) as u64);
    }
    vertices.into_mesh(faces, report)
}

/// A count that the bytes left can hold, a line of a digit each at least.
fn count(scanner: &Scanner<'_>, word: Option<&[u8]>, what: &'static str) -> Result<u32, MeshError> {
    let count = word.and_then(parse_integer).and_then(|count| u64::try_from(count).ok());
    let count = count.ok_or_else(|| scanner.unexpected("a count", word))?;
    let limit = (scanner.n_bytes_left() as u64 / 2).min(u32::MAX.into());
    let valid = u32::try_from(count).ok().filter(|_| count <= limit);
    valid.ok_or(MeshError::CountTooLarge { place: scanner.place(), what, count, limit })
}

fn vertices(
    scanner: &mut Scanner<'_>,
    keyword: Keyword,
    n_vertices: u32,
    report: &mut FileReport,
) -> Result<Vertices, MeshError> {
    let n_columns = n_columns(scanner, keyword);
    let mut points = Vec::with_capacity(n_vertices as usize);
    let mut bad_places = Vec::new();
    let mut columns = Columns::new(n_columns);
    let mut n_lines_cut = 0;
    for found in 0..n_vertices {
        check_more(scanner, "vertices", n_vertices, found)?;
        let point = [scanner.number()?, scanner.number()?, scanner.number()?];
        if point.iter().any(|&value| check_coordinate(value, scanner.place()).is_err()) {
            bad_places.push((points.len(), scanner.place()));
        }
        points.push(point);
        for column in 0..n_columns {
            // Only what the keyword announces may go on in the next line.
            let word = if keyword.is_plain() { scanner.word_in_line() } else { scanner.word() };
            if word.is_none() && keyword.is_plain() {
                columns.push_missing(column);
                continue;
            }
            let value = word.and_then(parse_number).ok_or_else(|| scanner.unexpected("a number", word))?;
            columns.push(column, value, word.is_some_and(|word| word.iter().all(u8::is_ascii_digit)));
        }
        n_lines_cut += u64::from(scanner.word_in_line().is_some());
        scanner.next_line();
    }
    if n_lines_cut > 0 {
        report.remark(format!("the rest of {n_lines_cut} lines of vertices is left out"));
    }
    let attributes = columns.into_attributes(keyword, report);
    Ok(Vertices { points: Points::Text(points), attributes, bad_places })
}

/// Numbers behind the coordinates of each vertex: as many as the keyword announces, with colours of
/// three or four by the first line; under a plain keyword those of the first line, 4 at most.
fn n_columns(scanner: &Scanner<'_>, keyword: Keyword) -> usize {
    let mut line = scanner.clone();
    let first = usize::from(line.word().is_some());
    let n_others = keyword.n_columns_without_colors();
    let n_words = first + std::iter::from_fn(|| line.word_in_line()).take(3 + n_others + 4).count();
    match keyword {
        _ if keyword.is_plain() => match n_words {
            6 | 7 => n_words - 3,
            _ => 0,
        },
        _ if !keyword.has_colors => n_others,
        _ if n_words == 3 + n_others + 3 => n_others + 3,
        _ => n_others + 4,
    }
}

fn faces(
    scanner: &mut Scanner<'_>,
    n_faces: u32,
    n_vertices: u32,
    report: &mut FileReport,
) -> Result<Faces, MeshError> {
    let mut faces = Faces::default();
    let mut corners: Vec<u32> = Vec::new();
    let mut colors = FaceColors::default();
    let mut n_indexed = 0;
    for found in 0..n_faces {
        check_more(scanner, "faces", n_faces, found)?;
        let word = scanner.word();
        let n_corners = word.and_then(parse_integer).and_then(|count| u64::try_from(count).ok());
        let n_corners = n_corners.ok_or_else(|| scanner.unexpected("a number of corners", word))?;
        let limit = (scanner.n_bytes_left() as u64).div_ceil(2);
        if n_corners > limit {
            let place = scanner.place();
            return Err(MeshError::CountTooLarge { place, what: "corners", count: n_corners, limit });
        }
        corners.clear();
        for _ in 0..n_corners {
            let word = scanner.word();
            let index = word.and_then(parse_integer).ok_or_else(|| scanner.unexpected("an index", word))?;
            let valid = u32::try_from(index).ok().filter(|&index| index < n_vertices);
            let (place, count) = (scanner.place(), n_vertices.into());
            corners.push(valid.ok_or(MeshError::IndexOutOfRange { place, what: "vertex", index, count })?);
        }
        let n_triangles = corners.len().saturating_sub(2) as u64;
        match face_color(scanner) {
            FaceColor::None => {}
            FaceColor::Indexed => n_indexed += n_triangles,
            FaceColor::Known(color) => colors.add(color, n_triangles),
        }
        scanner.next_line();
        faces.push(&corners);
    }
    colors.register(report);
    if n_indexed > 0 {
        let id = report.found(Kind::FaceData, "color");
        report.grow(id, n_indexed, "triangles");
    }
    Ok(faces)
}

/// What stands behind the corners of a face.
enum FaceColor {
    None,
    /// An index into a table of colours, or anything else that is no colour.
    Indexed,
    Known([u8; 4]),
}

/// The rest of a face's line: three or four numbers, in bytes where all are whole.
fn face_color(scanner: &mut Scanner<'_>) -> FaceColor {
    let mut values = [0.0; 4];
    let mut n_values = 0;
    let mut is_whole = true;
    while let Some(word) = scanner.word_in_line().filter(|_| n_values < 4) {
        let Some(value) = parse_number(word) else { return FaceColor::Indexed };
        is_whole &= word.iter().all(u8::is_ascii_digit);
        values[n_values] = value;
        n_values += 1;
    }
    let largest = if is_whole { 255.0 } else { 1.0 };
    match n_values {
        0 => FaceColor::None,
        3 | 4 => FaceColor::Known(from_unit(&values.map(|value| value / largest)[..n_values])),
        _ => FaceColor::Indexed,
    }
}

fn check_more(scanner: &Scanner<'_>, what: &'static str, expected: u32, found: u32) -> Result<(), MeshError> {
    if scanner.clone().word().is_some() {
        return Ok(());
    }
    Err(MeshError::EndsEarly { place: scanner.place(), what, expected: expected.into(), found: found.into() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ScalarType;

    const SQUARE: &str = "OFF # a square\n#\n4 1 0\n0 0 0\n1 0 0 # here\n1 1 0\n\n0 1 0\n4 0 1 2 3\n";

    fn read_text(text: &str) -> (TriangleMesh, FileReport) {
        read(text.as_bytes()).unwrap()
    }

    fn check_error(text: &str, message: &str) {
        assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), message);
    }

    #[test]
    fn comments_blank_lines_and_headers_of_all_forms() {
        let (mesh, report) = read_text(SQUARE);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(report.n_polygons_triangulated, 1);
        for header in ["OFF 4 1 0\n", "4 1 0\n", "OFF\n4 1\n", "OFF\r\n4\n1 0\n"] {
            assert_eq!(
                read_text(&SQUARE.replace("OFF # a square\n#\n4 1 0\n", header)).0,
                mesh,
                "{header:?}"
            );
        }
    }

    #[test]
    fn vertex_data_in_the_order_normal_colour_texture() {
        let text = "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 9 0.5 0.25\n1 0 0 0 0 1 1 2 3 0 0\n0 1 0 0 0 1 4 5 6 1 1\n3 0 1 2 7 8 9\n";
        let (mesh, report) = read_text(text);
        let color = mesh.attribute("color").unwrap();
        assert_eq!((color.n_components, color.bytes.as_slice()), (3, &[255, 0, 9, 1, 2, 3, 4, 5, 6][..]));
        let texcoord: Vec<f64> = mesh.attribute("texcoord").unwrap().values().collect();
        // V is counted from the bottom in the file.
        assert_eq!(texcoord, [0.5, 0.75, 0.0, 1.0, 1.0, 0.0]);
        assert_eq!(mesh.attribute("normal").unwrap().values().nth(2), Some(1.0));
        assert_eq!(report.notes(), ["face colour \"#070809\" (1 triangle) is left out"]);
    }

    #[test]
    fn colours_with_a_point_are_floats() {
        let text = "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 0.5 0 0 1\n0 1 0 0 0 0 1\n3 0 1 2\n";
        let color = read_text(text).0.attributes.remove(0);
        assert_eq!((color.scalar, color.n_components), (ScalarType::F32, 4));
        assert_eq!(color.values().nth(4), Some(0.5));
    }

    #[test]
    fn other_forms_are_refused() {
        check_error("4OFF\n1 1 1\n", "line 1: OFF with other than three coordinates is not supported");
        check_error("nOFF\n3\n1 1 1\n", "line 1: OFF with other than three coordinates is not supported");
    }

    #[test]
    fn faults_are_named_by_line() {
        check_error(
            &SQUARE.replace("4 1 0", "353535235358 1 0"),
            "line 3: 353535235358 vertices announced, there can be at most 23",
        );
        check_error(&SQUARE.replace("4 1 0", "-4 1 0"), "line 3: expected a count, found \"-4\"");
        check_error(&SQUARE.replace("2 3\n", "2 4\n"), "line 9: vertex index 4 is out of range (4 there)");
        check_error(
            &SQUARE.replace("4 0 1", "4000000 0 1"),
            "line 9: 4000000 corners announced, there can be at most 5",
        );
        check_error(&SQUARE.replace("1 1 0\n", "1 nan 0\n"), "line 6: coordinate NaN is not finite");
        check_error(&SQUARE.replace("4 0 1 2 3\n", ""), "the file ends at line 9 after 0 of 1 faces");
        check_error(&SQUARE.replace("4 0 1 2 3\n", "2 0 1\n"), "no faces (4 vertices)");
        check_error("OFF\n", "line 2: expected a count, found the end of the file");
    }
}
