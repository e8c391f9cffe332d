//! OFF files.

use crate::coordinates::{Coordinates, from_text, nearest_f32};
use crate::error::{MeshError, Place};
use crate::faces::Faces;
use crate::text::{Scanner, Style, parse_integer, parse_number};
use crate::{Attribute, FileReport, Kind, MeshFormat, ScalarType, TriangleMesh};

/// What the keyword at the beginning of a file says about its vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Keyword {
    has_texcoords: bool,
    has_colors: bool,
    has_normals: bool,
    /// Four or n coordinates instead of three.
    has_other_dimension: bool,
}

impl Keyword {
    /// Reads a keyword: `[ST][C][N][4][n]OFF`.
    pub(crate) fn parse(word: &[u8]) -> Option<Self> {
        let (has_texcoords, word) = strip(word, b"ST");
        let (has_colors, word) = strip(word, b"C");
        let (has_normals, word) = strip(word, b"N");
        let (has_four, word) = strip(word, b"4");
        let (has_n, word) = strip(word, b"n");
        let has_other_dimension = has_four || has_n;
        (word == b"OFF").then_some(Self { has_texcoords, has_colors, has_normals, has_other_dimension })
    }
}

fn strip<'a>(word: &'a [u8], prefix: &[u8]) -> (bool, &'a [u8]) {
    word.strip_prefix(prefix).map_or((false, word), |rest| (true, rest))
}

/// Reads an OFF file; the keyword `OFF` may be missing, as its definition allows.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(crate) fn read(bytes: &[u8]) -> Result<(TriangleMesh, FileReport), MeshError> {
    let mut scanner = Scanner::new(bytes, Style { hash_comments: true, continued_lines: false });
    let mut report = FileReport::new(MeshFormat::Off);
    let mut word = scanner.word();
    let mut keyword = Keyword::default();
    if let Some(found) = word.and_then(Keyword::parse) {
        keyword = found;
        word = scanner.word();
    }
    let unsupported =
        |feature: &str| MeshError::Unsupported { place: Place::Line(1), feature: feature.into() };
    if keyword.has_other_dimension {
        return Err(unsupported("OFF with other than three coordinates"));
    }
    if word == Some(b"BINARY") {
        return Err(unsupported("binary OFF"));
    }
    let n_vertices = count(&scanner, word, "vertices")?;
    let word = scanner.word();
    let n_faces = count(&scanner, word, "faces")?;
    // The number of edges means nothing to anybody and is sometimes missing.
    scanner.next_line();
    let (Coordinates { origin, positions, rounding }, attributes) =
        vertices(&mut scanner, keyword, n_vertices)?;
    for attribute in &attributes {
        let id = report.found(Kind::Attribute, &attribute.name);
        report.keep(id);
    }
    let triangles =
        faces(&mut scanner, n_faces, n_vertices, &mut report)?.into_triangles(&positions, &mut report);
    if let Some(word) = scanner.word() {
        report.count(Kind::TrailingByte, (word.len() + scanner.n_bytes_left()) as u64);
    }
    if triangles.is_empty() {
        return Err(MeshError::NoFaces { n_vertices: positions.len() });
    }
    Ok((TriangleMesh { origin, positions, triangles, attributes, rounding }, report))
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
) -> Result<(Coordinates, Vec<Attribute>), MeshError> {
    let n_color_components = if keyword.has_colors { color_components(scanner, keyword) } else { 0 };
    let n_extras =
        3 * usize::from(keyword.has_normals) + n_color_components + 2 * usize::from(keyword.has_texcoords);
    let mut points = Vec::with_capacity(n_vertices as usize);
    let mut extras: Vec<f64> = Vec::new();
    let mut has_whole_colors = true;
    let color_range = 3 * usize::from(keyword.has_normals)..n_extras - 2 * usize::from(keyword.has_texcoords);
    for found in 0..n_vertices {
        check_more(scanner, "vertices", n_vertices, found)?;
        points.push(scanner.point()?);
        for i in 0..n_extras {
            let word = scanner.word();
            let value = word.and_then(parse_number).ok_or_else(|| scanner.unexpected("a number", word))?;
            if color_range.contains(&i) {
                has_whole_colors &= word.is_some_and(is_byte);
            }
            extras.push(value);
        }
        scanner.next_line();
    }
    let column = |range: std::ops::Range<usize>| {
        extras.chunks_exact(n_extras.max(1)).flat_map(move |values| values[range.clone()].iter().copied())
    };
    let mut attributes = Vec::new();
    if keyword.has_normals {
        attributes.push(Attribute::from_f32("normal", 3, column(0..3).map(nearest_f32)));
    }
    if keyword.has_colors {
        attributes.push(color(n_color_components, has_whole_colors, column(color_range)));
    }
    if keyword.has_texcoords {
        attributes.push(Attribute::from_f32("texcoord", 2, column(n_extras - 2..n_extras).map(nearest_f32)));
    }
    Ok((from_text(&points)?, attributes))
}

/// Components of the colours, told by the number of words in the first vertex's line: three where there is no fourth.
fn color_components(scanner: &Scanner<'_>, keyword: Keyword) -> usize {
    let mut line = scanner.clone();
    let n_others = 3 + 3 * usize::from(keyword.has_normals) + 2 * usize::from(keyword.has_texcoords);
    let first = usize::from(line.word().is_some());
    let n_words = first + std::iter::from_fn(|| line.word_in_line()).take(n_others + 4).count();
    if n_words == n_others + 3 { 3 } else { 4 }
}

/// Whether a word is a whole number from 0 to 255 without a point: the sign of colours in bytes.
fn is_byte(word: &[u8]) -> bool {
    word.iter().all(u8::is_ascii_digit) && parse_integer(word).is_some_and(|value| value <= 255)
}

/// Colours as bytes where every component of the file is one, as `f32` otherwise.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the values are whole, from 0 to 255"
)]
fn color(n_components: usize, is_whole: bool, values: impl Iterator<Item = f64>) -> Attribute {
    let n_components = if n_components == 3 { 3 } else { 4 };
    if is_whole {
        let bytes = values.map(|value| value as u8).collect();
        return Attribute { name: "color".into(), scalar: ScalarType::U8, n_components, bytes };
    }
    Attribute::from_f32("color", n_components, values.map(nearest_f32))
}

fn faces(
    scanner: &mut Scanner<'_>,
    n_faces: u32,
    n_vertices: u32,
    report: &mut FileReport,
) -> Result<Faces, MeshError> {
    let mut faces = Faces::default();
    let mut corners: Vec<u32> = Vec::new();
    let mut n_colored = 0;
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
        n_colored += u64::from(scanner.word_in_line().is_some());
        scanner.next_line();
        faces.push(&corners);
    }
    if n_colored > 0 {
        let id = report.found(Kind::FaceData, "color");
        report.grow(id, n_colored, "faces");
    }
    Ok(faces)
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
        assert_eq!(texcoord, [0.5, 0.25, 0.0, 0.0, 1.0, 1.0]);
        assert_eq!(mesh.attribute("normal").unwrap().values().nth(2), Some(1.0));
        assert_eq!(report.notes(), ["face data \"color\" (1 face) is left out"]);
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
        check_error("OFF BINARY\n\0\0\0\u{1}", "line 1: binary OFF is not supported");
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
