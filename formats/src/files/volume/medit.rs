//! MEDIT files (`.mesh`), text.
//!
//! A file is a sequence of words: where lines end means nothing. A keyword begins with a letter and
//! everything up to the next keyword belongs to it, so that a section of an unknown kind can be
//! left out.
//!
//! Reference: P. Frey: "MEDIT: an interactive mesh visualization software" (INRIA RT-0253, 2001),
//! appendix; sections of a higher order: L. Maréchal: "The LibMeshb library" (INRIA, 2018).

use std::collections::BTreeSet;

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::words::{count, integer, point};
use crate::files::error::{MeshError, Place};
use crate::files::text::{Scanner, Style, parse_number};
use crate::{FileReport, Kind, TetrahedronMesh, VolumeFormat};

/// Reads a MEDIT file. References of vertices and elements are left out and reported; surface
/// elements are counted.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut reader = Reader {
        scanner: Scanner::new(bytes, Style { hash_comments: true, continued_lines: false }),
        report: FileReport::new(VolumeFormat::Medit),
        points: Vec::new(),
        elements: Vec::new(),
        references: [BTreeSet::new(), BTreeSet::new()],
    };
    let mut keyword = reader.scanner.word();
    if !keyword.is_some_and(|word| word.eq_ignore_ascii_case(b"meshversionformatted")) {
        return Err(reader.scanner.unexpected("MeshVersionFormatted", keyword));
    }
    while let Some(word) = keyword {
        let lower = word.to_ascii_lowercase();
        if lower == b"end" {
            break;
        }
        keyword = reader.section(&lower, word)?;
    }
    reader.finish()
}

/// A solid as the file gives it. Its vertices may come later.
struct Element {
    kind: CellKind,
    has_more_nodes: bool,
    corners: [u32; 8],
    place: Place,
}

/// What has a reference.
#[derive(Clone, Copy)]
enum Referring {
    Vertex,
    Solid,
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    report: FileReport,
    points: Vec<[f64; 3]>,
    elements: Vec<Element>,
    /// References of vertices, and of solids.
    references: [BTreeSet<i64>; 2],
}

impl<'a> Reader<'a> {
    /// Reads the section of a keyword and returns the next keyword.
    fn section(&mut self, lower: &[u8], keyword: &'a [u8]) -> Result<Option<&'a [u8]>, MeshError> {
        if let Some((kind, n_nodes)) = solid(lower) {
            self.elements(kind, n_nodes)?;
            return Ok(self.scanner.word());
        }
        if let Some(n_nodes) = flat_nodes(lower) {
            let n = count(&mut self.scanner, "elements")?;
            self.report.n_cells_ignored += n;
            for _ in 0..n * (n_nodes + 1) {
                integer(&mut self.scanner)?;
            }
            return Ok(self.scanner.word());
        }
        match lower {
            b"meshversionformatted" => drop(integer(&mut self.scanner)?),
            b"dimension" => self.dimension()?,
            b"vertices" => {
                for _ in 0..count(&mut self.scanner, "vertices")? {
                    self.points.push(point(&mut self.scanner)?);
                    self.reference(Referring::Vertex)?;
                }
            }
            _ => return self.left_out(lower, keyword),
        }
        Ok(self.scanner.word())
    }

    fn dimension(&mut self) -> Result<(), MeshError> {
        if integer(&mut self.scanner)? == 3 {
            return Ok(());
        }
        let feature = "MEDIT in other than three dimensions".to_owned();
        Err(MeshError::Unsupported { place: self.scanner.place(), feature })
    }

    fn reference(&mut self, of: Referring) -> Result<(), MeshError> {
        self.references[of as usize].insert(integer(&mut self.scanner)?);
        Ok(())
    }

    /// A list of solids: their nodes, corners first, and a reference each.
    fn elements(&mut self, kind: CellKind, n_nodes: usize) -> Result<(), MeshError> {
        for _ in 0..count(&mut self.scanner, "elements")? {
            let mut corners = [0; 8];
            for node in 0..n_nodes {
                let index = integer(&mut self.scanner)?;
                let from_zero = u32::try_from(index).ok().and_then(|index| index.checked_sub(1));
                let from_zero = from_zero.ok_or(MeshError::IndexOutOfRange {
                    place: self.scanner.place(),
                    what: "vertex",
                    index,
                    count: self.points.len() as u64,
                })?;
                if let Some(corner) = corners.get_mut(node) {
                    *corner = from_zero;
                }
            }
            self.reference(Referring::Solid)?;
            let has_more_nodes = n_nodes > kind.n_corners();
            self.elements.push(Element { kind, has_more_nodes, corners, place: self.scanner.place() });
        }
        Ok(())
    }

    /// Leaves out a section that has no part in a volume: everything up to the next keyword.
    fn left_out(&mut self, lower: &[u8], keyword: &'a [u8]) -> Result<Option<&'a [u8]>, MeshError> {
        if !keyword.first().is_some_and(u8::is_ascii_alphabetic) {
            return Err(self.scanner.unexpected("a keyword of MEDIT", Some(keyword)));
        }
        let name = String::from_utf8_lossy(keyword).into_owned();
        if lower.strip_suffix(b"ordering").is_some_and(|of| solid(of).is_some()) {
            let feature =
                format!("an order of nodes of its own ({})", crate::files::error::shown_name(&name));
            return Err(MeshError::Unsupported { place: self.scanner.place(), feature });
        }
        self.report.found(Kind::Section, &name);
        if matches!(lower, b"identifier" | b"geometry") {
            pass_text(&mut self.scanner);
        }
        loop {
            match self.scanner.word() {
                Some(word) if !is_keyword(word) => {}
                word => return Ok(word),
            }
        }
    }

    fn finish(mut self) -> Result<(TetrahedronMesh, FileReport), MeshError> {
        for (references, name) in self.references.iter().zip(["references of vertices", "references"]) {
            // 0 stands for none.
            if references.iter().any(|&reference| reference != 0) {
                let id = self.report.found(Kind::References, name);
                self.report.grow(id, references.len() as u64, "values");
            }
        }
        let mut cells = Cells::default();
        for Element { kind, has_more_nodes, corners, place } in self.elements {
            let corners = &corners[..kind.n_corners()];
            cells.push(kind, corners, self.points.len(), place, &mut self.report)?;
            self.report.n_cells_straightened += usize::from(has_more_nodes);
        }
        finish(Points::Text(self.points), cells, Fields::default(), self.report)
    }
}

/// Whether a word begins a section: it begins with a letter and is not a number such as `nan`.
fn is_keyword(word: &[u8]) -> bool {
    word.first().is_some_and(u8::is_ascii_alphabetic) && parse_number::<f64>(word).is_none()
}

/// Passes a text, which may hold blanks where it is quoted.
fn pass_text(scanner: &mut Scanner<'_>) {
    let Some(first) = scanner.word() else { return };
    let quotes = |word: &[u8]| word.iter().filter(|&&byte| byte == b'"').count();
    let mut n_quotes = quotes(first);
    while n_quotes % 2 == 1 {
        let Some(word) = scanner.word_in_line() else { return };
        n_quotes += quotes(word);
    }
}

/// The solid of a keyword in lower case, and the number of its nodes.
fn solid(keyword: &[u8]) -> Option<(CellKind, usize)> {
    Some(match keyword {
        b"tetrahedra" => (CellKind::Tetrahedron, 4),
        b"tetrahedrap2" => (CellKind::Tetrahedron, 10),
        b"tetrahedrap3" => (CellKind::Tetrahedron, 20),
        b"tetrahedrap4" => (CellKind::Tetrahedron, 35),
        b"hexahedra" => (CellKind::Hexahedron, 8),
        b"hexahedraq2" => (CellKind::Hexahedron, 27),
        b"hexahedraq3" => (CellKind::Hexahedron, 64),
        b"hexahedraq4" => (CellKind::Hexahedron, 125),
        b"prisms" | b"pentahedra" => (CellKind::Prism, 6),
        b"prismsp2" => (CellKind::Prism, 18),
        b"prismsp3" => (CellKind::Prism, 40),
        b"prismsp4" => (CellKind::Prism, 75),
        b"pyramids" => (CellKind::Pyramid, 5),
        b"pyramidsp2" => (CellKind::Pyramid, 14),
        b"pyramidsp3" => (CellKind::Pyramid, 30),
        b"pyramidsp4" => (CellKind::Pyramid, 55),
        _ => return None,
    })
}

/// Nodes of the elements without a volume that a keyword in lower case lists.
fn flat_nodes(keyword: &[u8]) -> Option<usize> {
    Some(match keyword {
        b"edges" => 2,
        b"edgesp2" => 3,
        b"edgesp3" => 4,
        b"edgesp4" => 5,
        b"triangles" => 3,
        b"trianglesp2" => 6,
        b"trianglesp3" => 10,
        b"trianglesp4" => 15,
        b"quadrilaterals" => 4,
        b"quadrilateralsq2" => 9,
        b"quadrilateralsq3" => 16,
        b"quadrilateralsq4" => 25,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six tetrahedra that fill a unit cube, and a pyramid on it behind a section.
    fn with_section(section: &str) -> String {
        format!(
            "MeshVersionFormatted 2\nDimension 3\nVertices\n9\n0 0 0 0\n1 0 0 0\n0 1 0 0\n1 1 0 0\n0 0 1 0\n1 0 1 0\n\
             0 1 1 0\n1 1 1 0\n0.5 0.5 2 0\nTetrahedra\n6\n4 7 6 8 1\n5 6 4 7 1\n3 5 4 7 1\n4 5 2 6 1\n2 4 3 5 1\n\
             2 3 1 5 1\n{section}\nPyramids\n1\n5 6 8 7 9 0\nEnd\n"
        )
    }

    #[test]
    fn sections_end_where_the_next_keyword_begins() {
        let sections = [
            "RequiredVertices\n4\n1 2 3 4",
            "RequiredVertices 4 1\n2 3\n\n4",
            "Corners\n0",
            "Corners 0",
            "Ridges 2 1\n2",
            "AngleOfCornerBound 46",
            "AngleOfCornerBound\n1.04719755",
            "Identifier\n\"a name with blanks\"",
            "Geometry \"part.geo\"",
            "Identifier name",
            "NormalAtVertices 1 1 1 Normals 1 nan 0 -1.#IND",
            "Unheard 1 2 3 4 5 6 7",
            "SolAtVertices\n2\n1 1\n\n0.5\n0.25",
        ];
        for section in sections {
            for text in [with_section(section), with_section(section).replace("\nPyr", " Pyr")] {
                let (mesh, report) =
                    read(text.as_bytes()).unwrap_or_else(|error| panic!("{section}: {error}"));
                assert_eq!(mesh.tetrahedra.len(), 8, "{section}");
                assert!((mesh.volume() - 4.0 / 3.0).abs() < 1e-6, "{section}");
                let name = section.split_whitespace().next().unwrap();
                let note = format!("section \"{name}\" is left out");
                assert!(report.notes().contains(&note), "{section}: {:?}", report.notes());
            }
        }
    }

    #[test]
    fn words_count_and_lines_do_not() {
        let text = with_section("Triangles 1\n1 2\n3 4");
        let whole = read(text.as_bytes()).unwrap();
        assert_eq!(whole.1.n_cells_ignored, 1);
        for other in [
            text.replace('\n', " "),
            text.replace([' ', '\n'], "\n\n"),
            text.to_lowercase(),
            text.to_uppercase(),
            text.replace("End", "# only\nEND"),
            format!(" {text}"),
        ] {
            assert_eq!(read(other.as_bytes()).unwrap(), whole);
        }
    }

    #[test]
    fn solids_of_a_higher_order_keep_their_corners() {
        let text = with_section("TetrahedraP2 1 1 2 3 5 1 1 1 1 1 1 0\nHexahedraQ2 0");
        let (mesh, report) = read(text.as_bytes()).unwrap();
        assert_eq!((mesh.tetrahedra.len(), report.n_cells_straightened), (9, 1));
        assert!((mesh.volume() - 1.5).abs() < 1e-6);
        assert!(read(with_section("TrianglesP2Ordering 1 0 0 0").as_bytes()).is_ok());
        let text = with_section("TetrahedraP2Ordering 1 0 0 0 0");
        assert!(matches!(read(text.as_bytes()), Err(MeshError::Unsupported { .. })));
    }
}
