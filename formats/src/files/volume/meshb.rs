//! Binary MEDIT files (`.meshb`).
//!
//! A file begins with the integer 1 in its byte order and the version. Keywords follow, each with
//! the offset of the next one. Coordinates are `f32` in version 1 and `f64` from version 2 on;
//! offsets have 64 bits from version 3 on, integers in version 4.
//!
//! Reference: L. Maréchal: "The LibMeshb library" (INRIA, 2018), "Binary file format".

use std::collections::BTreeSet;

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::scalars::{NumberType, Numbers};
use crate::files::error::{MeshError, Place};
use crate::{FileReport, Kind, ScalarType, TetrahedronMesh, VolumeFormat};

/// The first number of a file in the byte order of the machine that wrote it.
const ONE: u32 = 1;

/// Whether bytes begin as a binary MEDIT file does, in either byte order.
pub(super) fn is_meshb(bytes: &[u8]) -> bool {
    let [Some(one), Some(version)] = [bytes.first_chunk(), bytes.get(4..).and_then(<[u8]>::first_chunk)]
    else {
        return false;
    };
    let read: [fn([u8; 4]) -> u32; 2] = [u32::from_le_bytes, u32::from_be_bytes];
    read.iter().any(|read| read(*one) == ONE && (1..=4).contains(&read(*version)))
}

/// Reads a binary MEDIT file. References of vertices and elements are left out; surface elements
/// are counted.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let is_big_endian = bytes.first() == Some(&0);
    let mut reader = Reader { bytes, at: 4, is_big_endian, version: 0 };
    reader.version = reader.unsigned(4)?;
    let mut report = FileReport::new(VolumeFormat::Medit);
    let mut points = Numbers { number: reader.real(), bytes: Vec::new() };
    let mut elements: Vec<List> = Vec::new();
    // An offset that leads backwards is refused, so the file is passed once.
    loop {
        let keyword = reader.unsigned(4)?;
        if keyword == END {
            break;
        }
        let next = reader.offset()?;
        match keyword {
            DIMENSION => reader.dimension()?,
            VERTICES => {
                let n = reader.count(3 * points.number.size_bytes() + reader.integer_bytes())?;
                points.bytes.clear();
                reader.vertices(n, &mut points, &mut report)?;
            }
            5..=7 | 24 | 25 | 27 => report.n_cells_ignored += reader.count(1)?,
            _ => match solid(keyword) {
                Some((kind, n_nodes)) => {
                    let size_bytes = (n_nodes + 1) * reader.integer_bytes();
                    let n = reader.count(size_bytes)?;
                    elements.push(List { kind, n_nodes, n, at: reader.at });
                    // Lists must not overlap: a small file could declare many over the same bytes.
                    reader.at += n * size_bytes;
                }
                None => drop(report.named(Kind::Section, &name_of(keyword))),
            },
        }
        match next {
            0 => break,
            next if (reader.at..=bytes.len()).contains(&next) => reader.at = next,
            _ => {
                return Err(reader.unexpected("an offset behind this keyword, in the file", next.to_string()));
            }
        }
    }
    let n_points = points.len() / 3;
    let mut cells = Cells::default();
    let mut references = BTreeSet::new();
    for list in elements {
        references.extend(reader.elements(&list, n_points, (&mut cells, &mut report))?);
    }
    name_references("references", &references, &mut report);
    finish(Points::new(&points, false), cells, Fields::default(), report)
}

const DIMENSION: usize = 3;
const VERTICES: usize = 4;
const END: usize = 54;

/// The solid that a keyword lists, and the number of its nodes.
fn solid(keyword: usize) -> Option<(CellKind, usize)> {
    match keyword {
        8 => Some((CellKind::Tetrahedron, 4)),
        9 => Some((CellKind::Prism, 6)),
        10 => Some((CellKind::Hexahedron, 8)),
        30 => Some((CellKind::Tetrahedron, 10)),
        33 => Some((CellKind::Hexahedron, 27)),
        49 => Some((CellKind::Pyramid, 5)),
        _ => None,
    }
}

/// What a keyword is called in text files, or its number.
fn name_of(keyword: usize) -> String {
    let name = match keyword {
        11 => "AngleOfCornerBound",
        13 => "Corners",
        14 => "Ridges",
        15 => "RequiredVertices",
        16 => "RequiredEdges",
        17 => "RequiredTriangles",
        18 => "RequiredQuadrilaterals",
        20 => "NormalAtVertices",
        59 => "Tangents",
        60 => "Normals",
        61 => "TangentAtVertices",
        62 => "SolAtVertices",
        _ => return format!("keyword {keyword}"),
    };
    name.to_owned()
}

/// Reports references, of which 0 stands for none.
fn name_references(name: &str, references: &BTreeSet<usize>, report: &mut FileReport) {
    if references.iter().any(|&reference| reference != 0) {
        let id = report.found(Kind::References, name);
        report.grow(id, references.len() as u64, "values");
    }
}

/// A list of solids of one kind.
struct List {
    kind: CellKind,
    n_nodes: usize,
    n: usize,
    /// Where it begins.
    at: usize,
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    is_big_endian: bool,
    version: usize,
}

impl Reader<'_> {
    fn place(&self) -> Place {
        Place::Part("binary MEDIT file")
    }

    fn unexpected(&self, expected: &'static str, found: String) -> MeshError {
        MeshError::Unexpected { place: self.place(), expected, found }
    }

    /// Type of the coordinates.
    fn real(&self) -> NumberType {
        NumberType::Kept(if self.version == 1 { ScalarType::F32 } else { ScalarType::F64 })
    }

    fn integer_bytes(&self) -> usize {
        if self.version == 4 { 8 } else { 4 }
    }

    /// The next `n_bytes` bytes, at most 8, as an unsigned integer.
    fn unsigned(&mut self, n_bytes: usize) -> Result<usize, MeshError> {
        let found = self.bytes.len().saturating_sub(self.at);
        let bytes = self.bytes.get(self.at..self.at + n_bytes).ok_or(MeshError::Truncated {
            place: self.place(),
            what: "a number",
            expected: n_bytes as u64,
            found: found as u64,
        })?;
        self.at += n_bytes;
        let mut wide = [0; 8];
        wide[..n_bytes].copy_from_slice(bytes);
        if self.is_big_endian {
            wide[..n_bytes].reverse();
        }
        let value = u64::from_le_bytes(wide);
        usize::try_from(value).map_err(|_| self.unexpected("a number of this machine", value.to_string()))
    }

    fn integer(&mut self) -> Result<usize, MeshError> {
        self.unsigned(self.integer_bytes())
    }

    /// Where the next keyword is; 0 for none.
    fn offset(&mut self) -> Result<usize, MeshError> {
        self.unsigned(if self.version >= 3 { 8 } else { 4 })
    }

    fn dimension(&mut self) -> Result<(), MeshError> {
        match self.unsigned(4)? {
            3 => Ok(()),
            _ => {
                let feature = "MEDIT in other than three dimensions".to_owned();
                Err(MeshError::Unsupported { place: self.place(), feature })
            }
        }
    }

    /// A count of items of `size_bytes` each. The rest of the file holds that many bytes.
    fn count(&mut self, size_bytes: usize) -> Result<usize, MeshError> {
        let count = self.integer()?;
        let limit = (self.bytes.len() - self.at) / size_bytes;
        let (place, what) = (self.place(), "lines");
        if count > limit {
            return Err(MeshError::CountTooLarge { place, what, count: count as u64, limit: limit as u64 });
        }
        Ok(count)
    }

    /// Reads `n` vertices, whose bytes were checked to be there.
    fn vertices(&mut self, n: usize, points: &mut Numbers, report: &mut FileReport) -> Result<(), MeshError> {
        let size_bytes = 3 * points.number.size_bytes();
        let mut references = BTreeSet::new();
        for _ in 0..n {
            let coordinates = &self.bytes[self.at..self.at + size_bytes];
            points.bytes.extend(Numbers::from_bytes(points.number, coordinates, self.is_big_endian).bytes);
            self.at += size_bytes;
            references.insert(self.integer()?);
        }
        name_references("references of vertices", &references, report);
        Ok(())
    }

    fn elements(
        &mut self,
        &List { kind, n_nodes, n, at }: &List,
        n_points: usize,
        (cells, report): (&mut Cells, &mut FileReport),
    ) -> Result<BTreeSet<usize>, MeshError> {
        let mut references = BTreeSet::new();
        self.at = at;
        for element in 0..n {
            let mut nodes = [0; 27];
            for node in &mut nodes[..n_nodes] {
                let index = self.integer()?;
                let from_zero = index.checked_sub(1).filter(|&index| index < n_points);
                *node = from_zero.and_then(|index| u32::try_from(index).ok()).ok_or_else(|| {
                    MeshError::IndexOutOfRange {
                        place: Place::item("element", element),
                        what: "vertex",
                        index: i64::try_from(index).unwrap_or(i64::MAX),
                        count: n_points as u64,
                    }
                })?;
            }
            references.insert(self.integer()?);
            cells.push(kind, &nodes[..n_nodes], n_points, Place::item("element", element), report)?;
        }
        Ok(references)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two tetrahedra and a triangle in a version and byte order.
    fn sample(version: u32, is_big_endian: bool) -> Vec<u8> {
        const POINTS: [[f64; 3]; 5] =
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.5]];
        let sized = |value: u64, n_bytes: usize| {
            let mut bytes = value.to_le_bytes()[..n_bytes].to_vec();
            if is_big_endian {
                bytes.reverse();
            }
            bytes
        };
        let [integer_bytes, offset_bytes] =
            [if version == 4 { 8 } else { 4 }, if version >= 3 { 8 } else { 4 }];
        let mut file = [sized(1, 4), sized(version.into(), 4)].concat();
        let mut section = |keyword: u64, body: Vec<u8>| {
            let next = file.len() + 4 + offset_bytes + body.len();
            file.extend([sized(keyword, 4), sized(next as u64, offset_bytes), body].concat());
        };
        section(3, sized(3, 4));
        let real = |x: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "all of them are halves")]
            let narrow = u64::from((x as f32).to_bits());
            if version == 1 { sized(narrow, 4) } else { sized(x.to_bits(), 8) }
        };
        let points = POINTS.iter().flat_map(|p| {
            let coordinates = p.iter().flat_map(|&x| real(x));
            coordinates.chain(sized(0, integer_bytes)).collect::<Vec<u8>>()
        });
        let points: Vec<u8> = points.collect();
        section(4, [sized(5, integer_bytes), points].concat());
        let lines = |n: u64, numbers: &[u64]| {
            let count = sized(n, integer_bytes);
            count
                .into_iter()
                .chain(numbers.iter().flat_map(|&x| sized(x, integer_bytes)))
                .collect::<Vec<u8>>()
        };
        section(6, lines(1, &[1, 2, 3, 7]));
        section(8, lines(2, &[1, 2, 3, 4, 0, 2, 3, 4, 5, 9]));
        section(54, Vec::new());
        file
    }

    #[test]
    fn every_version_gives_the_same_two_tetrahedra_in_both_byte_orders() {
        for version in 1..=4 {
            for is_big_endian in [false, true] {
                let bytes = sample(version, is_big_endian);
                assert!(is_meshb(&bytes));
                let (mesh, report) = read(&bytes).unwrap();
                assert_eq!(mesh.tetrahedra, [[0, 1, 2, 3], [1, 2, 3, 4]]);
                assert_eq!(mesh.positions[4], [1.0, 1.0, 0.5]);
                assert_eq!((report.n_cells_ignored, report.notes().len()), (1, 2));
            }
        }
    }

    #[test]
    fn lists_that_share_bytes_and_offsets_beyond_the_file_are_refused() {
        let bytes = sample(3, false);
        let keyword = bytes.windows(4).rposition(|word| word == [8, 0, 0, 0]).unwrap();
        let with_next = |next: u64| {
            let mut changed = bytes.clone();
            changed[keyword + 4..keyword + 12].copy_from_slice(&next.to_le_bytes());
            read(&changed)
        };
        let behind_count = keyword as u64 + 16;
        for next in [behind_count, behind_count + 39, bytes.len() as u64 + 1, u64::MAX - 2, u64::MAX] {
            assert!(matches!(with_next(next), Err(MeshError::Unexpected { .. })), "{next}");
        }
        assert!(with_next(behind_count + 40).is_ok());
    }

    #[test]
    fn a_file_cut_anywhere_or_changed_anywhere_ends_in_an_answer() {
        let bytes = sample(3, false);
        for end in 0..bytes.len() - 12 {
            assert!(read(&bytes[..end]).is_err(), "{end}");
        }
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 0xFF;
            let _ = read(&changed);
        }
    }
}
