//! TetGen files: vertices in `.node`, tetrahedra in `.ele`, which belong together by name.
//!
//! Each item has a line. A header may leave out its last numbers: `125` and `125 3` are both 125
//! vertices without attributes and markers.
//!
//! Reference: H. Si: TetGen user's manual, "File formats".

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::scalars::{NumberType, Numbers};
use super::words::{Names, checked_count};
use crate::files::error::MeshError;
use crate::files::text::{Scanner, Style, parse_integer, parse_number};
use crate::{FileReport, Kind, ScalarType, TetrahedronMesh, VolumeFormat};

/// Reads the contents of the two files. Attributes of vertices are the fields `attribute_1` and on.
/// Markers of vertices and attributes of tetrahedra are left out and reported.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(node: &[u8], ele: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut report = FileReport::new(VolumeFormat::Tetgen);
    let mut names = Names::default();
    let (points, fields) = vertices(&mut Lines::new(node), &mut names, &mut report)?;
    let cells = tetrahedra(&mut Lines::new(ele), &names, &mut report)?;
    finish(Points::Text(points), cells, fields, report)
}

fn vertices(
    lines: &mut Lines<'_>,
    names: &mut Names,
    report: &mut FileReport,
) -> Result<(Vec<[f64; 3]>, Fields), MeshError> {
    let (n, [n_dimensions, n_attributes, n_markers]) = lines.header("vertices", [3, 0, 0])?;
    if n_dimensions != 3 || !(0..=MAX_ATTRIBUTES).contains(&n_attributes) || !(0..=1).contains(&n_markers) {
        return Err(lines.unexpected("three dimensions, attributes and at most one marker", None));
    }
    let mut points = Vec::with_capacity(n);
    let mut columns = vec![Vec::new(); usize::try_from(n_attributes).unwrap_or(0)];
    let mut has_markers = false;
    for _ in 0..n {
        let name = lines.begin_item()?;
        names.push(name, lines.scanner.place())?;
        points.push([lines.number()?, lines.number()?, lines.number()?]);
        for column in &mut columns {
            column.extend(lines.number()?.to_le_bytes());
        }
        if n_markers == 1 {
            has_markers |= lines.optional_integer()?.is_some_and(|marker| marker != 0);
        }
        lines.end_item();
    }
    if has_markers {
        report.found(Kind::References, "boundary markers");
    }
    lines.tell_rests("vertices", report);
    let mut fields = Fields::default();
    for (i, bytes) in columns.into_iter().enumerate() {
        let numbers = Numbers { number: NumberType::Kept(ScalarType::F64), bytes };
        fields.push(&format!("attribute_{}", i + 1), 1, numbers, points.len(), report);
    }
    Ok((points, fields))
}

fn tetrahedra(lines: &mut Lines<'_>, names: &Names, report: &mut FileReport) -> Result<Cells, MeshError> {
    let (n, [n_nodes, n_attributes]) = lines.header("tetrahedra", [4, 0])?;
    if !matches!(n_nodes, 4 | 10) || !(0..=MAX_ATTRIBUTES).contains(&n_attributes) {
        return Err(lines.unexpected("4 or 10 nodes and at most 64 attributes", None));
    }
    let n_nodes = if n_nodes == 4 { 4 } else { 10 };
    let mut cells = Cells::default();
    for _ in 0..n {
        lines.begin_item()?;
        let mut nodes = [0; 10];
        for node in &mut nodes[..n_nodes] {
            let name = lines.integer()?;
            *node = names.find(name, lines.scanner.place())?;
        }
        (0..n_attributes).try_for_each(|_| lines.number().map(drop))?;
        let place = lines.scanner.place();
        lines.end_item();
        cells.push(CellKind::Tetrahedron, &nodes[..n_nodes], names.len(), place, report)?;
    }
    if n_attributes > 0 {
        report.found(Kind::References, "attributes of tetrahedra");
    }
    lines.tell_rests("tetrahedra", report);
    Ok(cells)
}

/// Most attributes of an item.
const MAX_ATTRIBUTES: i64 = 64;

/// Lines of a file, one for each item; empty ones and comments are passed.
struct Lines<'a> {
    scanner: Scanner<'a>,
    /// Lines that hold more than the header announces.
    n_longer: usize,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let scanner = Scanner::new(bytes, Style { hash_comments: true, continued_lines: false });
        Self { scanner, n_longer: 0 }
    }

    /// The count at the beginning, and the numbers behind it, which the line may leave out.
    fn header<const N: usize>(
        &mut self,
        what: &'static str,
        usual: [i64; N],
    ) -> Result<(usize, [i64; N]), MeshError> {
        let word = self.scanner.word();
        let n = checked_count(&self.scanner, word, what)?;
        let mut numbers = usual;
        for number in &mut numbers {
            let Some(value) = self.optional_integer()? else { break };
            *number = value;
        }
        self.scanner.next_line();
        Ok((n, numbers))
    }

    /// The number of the item on the next line that is not empty.
    fn begin_item(&mut self) -> Result<i64, MeshError> {
        let word = self.scanner.word();
        word.and_then(parse_integer).ok_or_else(|| self.unexpected("a whole number", word))
    }

    /// Goes to the next line.
    fn end_item(&mut self) {
        self.n_longer += usize::from(self.scanner.word_in_line().is_some());
        self.scanner.next_line();
    }

    fn number(&mut self) -> Result<f64, MeshError> {
        let word = self.scanner.word_in_line();
        word.and_then(parse_number).ok_or_else(|| self.unexpected("a number", word))
    }

    fn integer(&mut self) -> Result<i64, MeshError> {
        self.optional_integer()?.ok_or_else(|| self.unexpected("a whole number", None))
    }

    /// A whole number, or `None` at the end of the line.
    fn optional_integer(&mut self) -> Result<Option<i64>, MeshError> {
        let Some(word) = self.scanner.word_in_line() else { return Ok(None) };
        parse_integer(word).map(Some).ok_or_else(|| self.unexpected("a whole number", Some(word)))
    }

    fn unexpected(&self, expected: &'static str, found: Option<&[u8]>) -> MeshError {
        self.scanner.unexpected(expected, found)
    }

    /// Reports lines that hold more than announced.
    fn tell_rests(&self, what: &'static str, report: &mut FileReport) {
        if self.n_longer > 0 {
            let lines = if self.n_longer == 1 { "line" } else { "lines" };
            report.remark(format!("the rest of {} {lines} of {what} is left out", self.n_longer));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [&str; 4] = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];

    fn nodes(header: &str, rest: &str) -> String {
        let lines = (1..).zip(POINTS).map(|(name, point)| format!("{name} {point}{rest}\n"));
        format!("# nodes\n{header}\n\n{}", lines.collect::<String>())
    }

    #[test]
    fn headers_may_leave_out_their_last_numbers() {
        for header in ["4 3 0 0", "4 3 0", "4 3", "4", "4 # of them"] {
            for element in ["1 4 0\n1 1 2 3 4\n", "1 4\n1 1 2 3 4\n", "1\n1 1 2 3 4\n"] {
                let (mesh, report) = read(nodes(header, "").as_bytes(), element.as_bytes()).unwrap();
                assert_eq!((mesh.tetrahedra.as_slice(), report.notes().len()), (&[[0, 1, 2, 3]][..], 0));
            }
        }
    }

    #[test]
    fn what_is_not_kept_is_named() {
        let (mesh, report) = read(nodes("4 3 1 1", " 7.5 2").as_bytes(), b"1 4 2\n1 1 2 3 4 5 6\n").unwrap();
        assert_eq!(mesh.attribute("attribute_1").unwrap().values().collect::<Vec<_>>(), [7.5; 4]);
        let notes = ["boundary markers", "attributes of tetrahedra"];
        assert_eq!(report.notes(), notes.map(|name| format!("element data \"{name}\" is left out")));
        // A short header does not let the rest of a line become the next item.
        let (mesh, report) = read(nodes("4", " 7.5 2").as_bytes(), b"1\n1 1 2 3 4 5 6\n").unwrap();
        assert_eq!((mesh.tetrahedra.len(), mesh.attributes.len()), (1, 0));
        let notes = ["4 lines of vertices", "1 line of tetrahedra"];
        assert_eq!(report.notes(), notes.map(|lines| format!("the rest of {lines} is left out")));
    }

    #[test]
    fn a_line_that_is_too_short_is_an_error() {
        let node = nodes("4", "");
        let short = read(node.as_bytes(), b"2\n1 1 2 3\n4\n");
        assert!(matches!(short, Err(MeshError::Unexpected { .. })), "{short:?}");
    }
}
