//! MFEM meshes (`MFEM mesh v1.0` to `v1.3`), text.
//!
//! Elements come before vertices. In a curved mesh the vertices have no coordinates of their own:
//! they are the first degrees of freedom of a field of nodes, if the field is continuous.
//!
//! Reference: MFEM, "Mesh formats" (mfem.org).

use std::collections::BTreeSet;

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::words::{count, integer, point};
use crate::files::error::{MeshError, Place, shown_name};
use crate::files::text::{Scanner, Style};
use crate::{FileReport, Kind, TetrahedronMesh, VolumeFormat};

/// How a file begins.
pub(super) const MAGIC: &[u8] = b"MFEM mesh v1.";

/// Reads an MFEM mesh. Attributes of elements are left out and reported; boundary elements are
/// counted.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut reader = Reader {
        scanner: Scanner::new(bytes, Style { hash_comments: true, continued_lines: false }),
        report: FileReport::new(VolumeFormat::Mfem),
        elements: Vec::new(),
        attributes: BTreeSet::new(),
        points: Vec::new(),
        n_vertices: 0,
        is_curved: false,
    };
    if !bytes.trim_ascii_start().starts_with(MAGIC) {
        let found = crate::files::error::excerpt(bytes.trim_ascii_start());
        return Err(MeshError::Unexpected {
            place: Place::Line(1),
            expected: "MFEM mesh v1.0 to v1.3",
            found,
        });
    }
    // Three words say what the file is.
    let mut keyword = (0..4).map(|_| reader.scanner.word()).last().flatten();
    while let Some(word) = keyword {
        keyword = reader.section(word)?;
    }
    reader.finish()
}

/// A solid as the file gives it. Its vertices come later.
struct Element {
    kind: CellKind,
    corners: [u32; 8],
    place: Place,
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    report: FileReport,
    elements: Vec<Element>,
    /// Attributes of solids.
    attributes: BTreeSet<i64>,
    points: Vec<[f64; 3]>,
    n_vertices: usize,
    is_curved: bool,
}

impl<'a> Reader<'a> {
    /// Reads the section of a keyword and returns the next keyword.
    fn section(&mut self, keyword: &'a [u8]) -> Result<Option<&'a [u8]>, MeshError> {
        match keyword {
            b"dimension" => {
                if integer(&mut self.scanner)? != 3 {
                    return Err(self.unsupported("MFEM in other than three dimensions".to_owned()));
                }
            }
            b"elements" => {
                for (attribute, element) in self.elements()? {
                    self.attributes.insert(attribute);
                    self.elements.push(element);
                }
            }
            b"boundary" => {
                let n_solids = self.elements()?.len();
                self.report.n_cells_ignored += n_solids;
            }
            b"vertices" => return self.vertices(),
            b"nodes" => return self.nodes(),
            b"mfem_mesh_end" => {}
            _ if keyword.first().is_some_and(u8::is_ascii_alphabetic) => {
                let name = String::from_utf8_lossy(keyword);
                self.report.named(Kind::Section, &name);
                return Ok(self.next_keyword());
            }
            _ => return Err(self.scanner.unexpected("a section of MFEM", Some(keyword))),
        }
        Ok(self.scanner.word())
    }

    /// Passes everything up to the next word that begins a line and has no digit first.
    fn next_keyword(&mut self) -> Option<&'a [u8]> {
        while self.scanner.next_line() {
            let word = self.scanner.word_in_line();
            if word.is_some_and(|word| word.first().is_some_and(u8::is_ascii_lowercase)) {
                return word;
            }
        }
        None
    }

    fn unsupported(&self, feature: String) -> MeshError {
        MeshError::Unsupported { place: self.scanner.place(), feature }
    }

    /// Reads a list of elements: an attribute, a type, vertices. Returns the solids with their
    /// attributes and counts all others.
    fn elements(&mut self) -> Result<Vec<(i64, Element)>, MeshError> {
        let mut solids = Vec::new();
        for _ in 0..count(&mut self.scanner, "elements")? {
            let attribute = integer(&mut self.scanner)?;
            let number = integer(&mut self.scanner)?;
            let (kind, n_vertices) = element_type(number)
                .ok_or_else(|| self.unsupported(format!("MFEM element type {number}")))?;
            let mut corners = [0; 8];
            for corner in &mut corners[..n_vertices] {
                let index = integer(&mut self.scanner)?;
                let (place, what, count) = (self.scanner.place(), "vertex", self.n_vertices as u64);
                let in_range = u32::try_from(index).ok();
                *corner = in_range.ok_or(MeshError::IndexOutOfRange { place, what, index, count })?;
            }
            if kind == CellKind::Flat {
                self.report.n_cells_ignored += 1;
            } else {
                solids.push((attribute, Element { kind, corners, place: self.scanner.place() }));
            }
        }
        Ok(solids)
    }

    /// The number of vertices, and their dimension and coordinates unless the mesh is curved.
    fn vertices(&mut self) -> Result<Option<&'a [u8]>, MeshError> {
        self.n_vertices = count(&mut self.scanner, "vertices")?;
        let word = self.scanner.word();
        if word != Some(b"3") {
            return Ok(word);
        }
        for _ in 0..self.n_vertices {
            self.points.push(point(&mut self.scanner)?);
        }
        Ok(self.scanner.word())
    }

    /// A field of nodes, of which the first are the vertices.
    fn nodes(&mut self) -> Result<Option<&'a [u8]>, MeshError> {
        let [collection, n_components, ordering] =
            ["FiniteElementCollection:", "VDim:", "Ordering:"].map(|key| self.value_of(key.as_bytes()));
        let collection = collection.unwrap_or_default();
        let is_continuous =
            collection.starts_with("H1_") || matches!(collection.as_str(), "Linear" | "Quadratic" | "Cubic");
        if !is_continuous || n_components.as_deref() != Some("3") {
            let name = shown_name(&collection);
            return Err(self.unsupported(format!("MFEM nodes of the collection {name}")));
        }
        self.is_curved = !matches!(collection.as_str(), "Linear" | "H1_3D_P1");
        let mut numbers = Vec::new();
        let mut next = self.scanner.word();
        while let Some(number) = next.and_then(crate::files::text::parse_number::<f64>) {
            numbers.push(number);
            next = self.scanner.word();
        }
        let n_nodes = numbers.len() / 3;
        if n_nodes < self.n_vertices {
            let expected = self.n_vertices as u64;
            let (place, what, found) = (self.scanner.place(), "nodes", n_nodes as u64);
            return Err(MeshError::EndsEarly { place, what, expected, found });
        }
        let is_by_node = ordering.as_deref() == Some("1");
        let coordinate =
            |v: usize, axis: usize| numbers[if is_by_node { 3 * v + axis } else { axis * n_nodes + v }];
        self.points = (0..self.n_vertices).map(|v| [0, 1, 2].map(|axis| coordinate(v, axis))).collect();
        Ok(next)
    }

    /// The word behind a key, which is the next word but for others that are not looked at.
    fn value_of(&mut self, key: &[u8]) -> Option<String> {
        const WORDS_BETWEEN: usize = 4;
        for _ in 0..WORDS_BETWEEN {
            if self.scanner.word()? == key {
                return self.scanner.word().map(|word| String::from_utf8_lossy(word).into_owned());
            }
        }
        None
    }

    fn finish(mut self) -> Result<(TetrahedronMesh, FileReport), MeshError> {
        if self.attributes.len() > 1 {
            let id = self.report.found(Kind::References, "attributes");
            self.report.grow(id, self.attributes.len() as u64, "values");
        }
        let mut cells = Cells::default();
        for Element { kind, corners, place } in self.elements {
            let corners = &corners[..kind.n_corners()];
            cells.push(kind, corners, self.points.len(), place, &mut self.report)?;
        }
        if self.is_curved {
            self.report.n_cells_straightened += cells.len();
        }
        finish(Points::Text(self.points), cells, Fields::default(), self.report)
    }
}

/// What a type of element is, and how many vertices it has.
fn element_type(number: i64) -> Option<(CellKind, usize)> {
    Some(match number {
        0 => (CellKind::Flat, 1),
        1 => (CellKind::Flat, 2),
        2 => (CellKind::Flat, 3),
        3 => (CellKind::Flat, 4),
        4 => (CellKind::Tetrahedron, 4),
        5 => (CellKind::Hexahedron, 8),
        6 => (CellKind::Prism, 6),
        7 => (CellKind::Pyramid, 5),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRAIGHT: &str = "MFEM mesh v1.2\n\n# a comment\ndimension\n3\n\nelements\n2\n1 4 0 1 2 3\n2 4 1 2 3 4\n\n\
        boundary\n1\n1 2 0 1 2\n\nvertices\n5\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 0.5\n\nmfem_mesh_end\n";

    #[test]
    fn tetrahedra_are_read_and_attributes_named() {
        let (mesh, report) = read(STRAIGHT.as_bytes()).unwrap();
        assert_eq!(mesh.tetrahedra, [[0, 1, 2, 3], [1, 2, 3, 4]]);
        assert_eq!(mesh.positions[4], [1.0, 1.0, 0.5]);
        assert_eq!(report.n_cells_ignored, 1);
        assert_eq!(report.notes()[0], "element data \"attributes\" (2 values) is left out");
    }

    #[test]
    fn vertices_of_a_curved_mesh_are_its_first_nodes() {
        let head = "FiniteElementSpace\nFiniteElementCollection: H1_3D_P2\nVDim: 3\nOrdering:";
        let start = STRAIGHT.find("3\n0 0 0").unwrap();
        let by_node = "0 0 0 1 0 0 0 1 0 0 0 1 1 1 0.5 9 9 9";
        let by_axis = "0 1 0 0 1 9 0 0 1 0 1 9 0 0 0 1 0.5 9";
        let whole = read(STRAIGHT.as_bytes()).unwrap().0;
        for (ordering, numbers) in [(1, by_node), (0, by_axis)] {
            let text = format!("{}nodes\n{head} {ordering}\n\n{numbers}\n", &STRAIGHT[..start]);
            let (mesh, report) = read(text.as_bytes()).unwrap();
            assert_eq!(mesh, whole);
            assert_eq!(report.n_cells_straightened, 2);
            let other = text.replace("H1_3D_P2", "L2_T1_3D_P2");
            assert!(matches!(read(other.as_bytes()), Err(MeshError::Unsupported { .. })));
            let short = text.replace(numbers, "0 0 0 1 0 0");
            assert!(matches!(read(short.as_bytes()), Err(MeshError::EndsEarly { .. })));
        }
    }

    #[test]
    fn sections_that_are_not_read_are_named_and_passed() {
        let text = STRAIGHT.replace("boundary", "attribute_sets\n1\n\"all\" 2 1 2\n\nboundary");
        let (mesh, report) = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.tetrahedra.len(), 2);
        assert!(report.notes().contains(&"section \"attribute_sets\" is left out".to_owned()));
    }
}
