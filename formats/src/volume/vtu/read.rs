//! Reading a VTU file.

use std::cell::Cell;

use roxmltree::{Document, Node};

use super::arrays::{Encoding, is_base64, unsupported};
use crate::error::{MeshError, Place, quoted_name, shortened};
use crate::volume::cells::Cells;
use crate::volume::pending::{Fields, Points, finish};
use crate::volume::scalars::Numbers;
use crate::volume::vtk::kind_of;
use crate::{FileReport, Kind, TetrahedronMesh, VolumeFormat};

/// Reads a VTU file. Of several pieces the points are numbered on, and a field is taken where every piece has it with as many components
/// of one type. Pieces that have neither points nor cells say nothing, whatever else they have or lack.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(in crate::volume) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let (xml, appended) = split_appended(bytes);
    let place = Place::Part("XML");
    let xml = std::str::from_utf8(&xml).map_err(|_| MeshError::Unexpected {
        place,
        expected: "UTF-8",
        found: "other bytes".to_owned(),
    })?;
    let document = Document::parse(xml).map_err(|error| MeshError::Unexpected {
        place,
        expected: "well-formed XML",
        found: shortened(&error),
    })?;
    let root = document.root_element();
    let kind = root.attribute("type").unwrap_or("");
    if root.tag_name().name() != "VTKFile" || kind != "UnstructuredGrid" {
        return Err(unsupported(format!("VTK file of type {}", quoted_name(kind))));
    }
    let encoding = encoding(root, appended)?;
    let grid = child(root, "UnstructuredGrid")?;
    let mut report = FileReport::new(VolumeFormat::Vtu);
    let mut whole: Option<Piece> = None;
    for node in grid.children().filter(|node| node.has_tag_name("Piece") && !is_bare(*node)) {
        let n_before = whole.as_ref().map_or(0, |whole| whole.points.len());
        let piece = read_piece(node, &encoding, n_before, &mut report)?;
        whole = Some(match whole {
            Some(whole) if piece.points.len() == 0 => whole,
            Some(whole) if whole.points.len() > 0 => whole.join(piece, &mut report)?,
            _ => piece,
        });
    }
    let Piece { points, is_text, cells, fields } =
        whole.ok_or(MeshError::Missing { place: Place::File, what: "piece" })?;
    let mut kept = Fields::default();
    for Field { name, n_components, numbers } in fields {
        kept.push(&name, n_components, numbers, points.len() / 3, &mut report);
    }
    finish(Points::new(&points, is_text), cells, kept, report)
}

/// The XML without the appended data, closed where it was cut, and the data.
fn split_appended(bytes: &[u8]) -> (Vec<u8>, &[u8]) {
    const TAG: &[u8] = b"<AppendedData";
    let Some(tag) = bytes.windows(TAG.len()).position(|window| window == TAG) else {
        return (bytes.to_vec(), &[]);
    };
    let behind =
        |byte: u8, from: usize| bytes[from..].iter().position(|&found| found == byte).map(|at| from + at + 1);
    let open = behind(b'>', tag).unwrap_or(bytes.len());
    let data = behind(b'_', open).unwrap_or(bytes.len());
    let mut xml = bytes[..open].to_vec();
    xml.extend_from_slice(b"</AppendedData></VTKFile>");
    (xml, &bytes[data..])
}

fn encoding<'a>(root: Node<'_, '_>, appended: &'a [u8]) -> Result<Encoding<'a>, MeshError> {
    let choice = |name: &str, default: &'static str| root.attribute(name).unwrap_or(default).to_owned();
    let is_big_endian = match choice("byte_order", "LittleEndian").as_str() {
        "LittleEndian" => false,
        "BigEndian" => true,
        other => return Err(unsupported(format!("byte order {}", quoted_name(other)))),
    };
    let header_bytes = match choice("header_type", "UInt32").as_str() {
        "UInt32" => 4,
        "UInt64" => 8,
        other => return Err(unsupported(format!("header type {}", quoted_name(other)))),
    };
    let is_compressed = match choice("compressor", "").as_str() {
        "" => false,
        "vtkZLibDataCompressor" => true,
        other => return Err(unsupported(format!("compressor {}", quoted_name(other)))),
    };
    let data = root.children().find(|node| node.has_tag_name("AppendedData"));
    let is_appended_base64 = data.and_then(|node| node.attribute("encoding")) == Some("base64");
    let is_end = |byte: &u8| is_appended_base64 && !is_base64(*byte);
    let appended = &appended[..appended.iter().position(is_end).unwrap_or(appended.len())];
    let n_unused = Cell::new(appended.len());
    Ok(Encoding { is_big_endian, header_bytes, is_compressed, appended, is_appended_base64, n_unused })
}

/// A piece of the grid, or all up to one.
struct Piece {
    /// Coordinates, three a point.
    points: Numbers,
    is_text: bool,
    cells: Cells,
    fields: Vec<Field>,
}

/// Values at the points of a piece.
struct Field {
    name: String,
    n_components: u32,
    numbers: Numbers,
}

impl Piece {
    /// Adds the next piece, whose cells count their points on from this one's already.
    fn join(mut self, next: Self, report: &mut FileReport) -> Result<Self, MeshError> {
        if self.points.number != next.points.number {
            return Err(unsupported("pieces with points of different types".to_owned()));
        }
        self.points.bytes.extend_from_slice(&next.points.bytes);
        self.is_text |= next.is_text;
        self.cells.append(next.cells);
        let fits = |field: &Field, n_numbers: usize| {
            field.numbers.len() * 3 == n_numbers * field.n_components as usize
        };
        let n_before = self.points.len() - next.points.len();
        let (mut others, unfit): (Vec<Field>, Vec<Field>) =
            next.fields.into_iter().partition(|field| fits(field, next.points.len()));
        let mut leave_out = |name: String| {
            let id = report.found(Kind::Field, &name);
            report.leave_out(id, "not every piece has it in the same form");
        };
        self.fields.retain_mut(|field| {
            let fits_before = fits(field, n_before);
            let Field { name, n_components, numbers } = field;
            let is_same = |other: &Field| {
                (&other.name, other.n_components, other.numbers.number)
                    == (name, *n_components, numbers.number)
            };
            match others.iter().position(is_same).filter(|_| fits_before) {
                Some(at) => numbers.bytes.extend(others.remove(at).numbers.bytes),
                None => {
                    leave_out(std::mem::take(name));
                    return false;
                }
            }
            true
        });
        others.into_iter().chain(unfit).for_each(|field| leave_out(field.name));
        Ok(self)
    }
}

/// Whether a piece says that it has no points and no cells, and has no place for points: writers in parallel leave such pieces where
/// a process had nothing to write.
fn is_bare(piece: Node<'_, '_>) -> bool {
    let has_none = |name| piece.attribute(name).is_some_and(|count| count.parse() == Ok(0_u64));
    let coordinates = child(piece, "Points").ok().and_then(|points| arrays(points).next());
    has_none("NumberOfPoints") && has_none("NumberOfCells") && coordinates.is_none()
}

/// Reads a piece before whose points there are those of others, three numbers each.
fn read_piece(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
    n_numbers_before: usize,
    report: &mut FileReport,
) -> Result<Piece, MeshError> {
    let coordinates = arrays(child(piece, "Points")?).next();
    let coordinates =
        coordinates.ok_or(MeshError::Missing { place: Place::Part("Points"), what: "array" })?;
    let is_text = coordinates.attribute("format") == Some("ascii");
    let mut points = encoding.numbers(coordinates)?;
    let n_points = points.len() / 3;
    points.bytes.truncate(3 * n_points * points.number.size_bytes());
    check_count(piece, "NumberOfPoints", n_points)?;
    let cells = read_cells(piece, encoding, [n_numbers_before / 3, n_points], report)?;
    let mut fields = Vec::new();
    if let Ok(data) = child(piece, "PointData") {
        for array in arrays(data) {
            let name = array.attribute("Name").unwrap_or("").to_owned();
            let n_components = array.attribute("NumberOfComponents").map_or(Ok(1), str::parse);
            match encoding.numbers(array) {
                Ok(numbers) => {
                    fields.push(Field { name, n_components: n_components.unwrap_or(0), numbers });
                }
                Err(MeshError::Unsupported { .. }) => {
                    report.found(Kind::Field, &name);
                }
                Err(error) => return Err(error),
            }
        }
    }
    for (part, kind) in [("CellData", Kind::CellData), ("FieldData", Kind::FieldData)] {
        for array in child(piece, part).into_iter().flat_map(arrays) {
            let name = array.attribute("Name").unwrap_or("").to_owned();
            report.found(kind, &name);
        }
    }
    Ok(Piece { points, is_text, cells, fields })
}

/// The cells of a piece of `n_points` points behind `n_before` others.
fn read_cells(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
    [n_before, n_points]: [usize; 2],
    report: &mut FileReport,
) -> Result<Cells, MeshError> {
    let node = child(piece, "Cells")?;
    let named = |name: &'static str| -> Result<Numbers, MeshError> {
        let array = arrays(node).find(|array| array.attribute("Name") == Some(name));
        encoding.numbers(array.ok_or(MeshError::Missing { place: Place::Part("Cells"), what: name })?)
    };
    let (connectivity, offsets, types) = (named("connectivity")?, named("offsets")?, named("types")?);
    check_count(piece, "NumberOfCells", types.len())?;
    if offsets.len() != types.len() {
        let (count, limit) = (offsets.len() as u64, types.len() as u64);
        return Err(MeshError::CountTooLarge {
            place: Place::Part("offsets"),
            what: "offsets",
            count,
            limit,
        });
    }
    let indices: Vec<Option<i64>> = connectivity.to_integers().collect();
    let mut cells = Cells::default();
    let (mut start, mut nodes) = (0, Vec::new());
    for (cell, (offset, cell_type)) in offsets.to_integers().zip(types.to_integers()).enumerate() {
        let place = Place::item("cell", cell);
        let kind = kind_of(cell_type.unwrap_or(-1), place)?;
        let end = offset.and_then(|end| usize::try_from(end).ok());
        let range = end.filter(|end| (start..=indices.len()).contains(end)).map(|end| start..end);
        let range = range.ok_or_else(|| MeshError::Unexpected {
            place,
            expected: "offsets that ascend to the number of nodes",
            found: offset.map_or_else(|| "none".to_owned(), |offset| offset.to_string()),
        })?;
        start = range.end;
        nodes.clear();
        for &index in &indices[range] {
            let count = n_points as u64;
            let out_of_range = || MeshError::IndexOutOfRange {
                place,
                what: "vertex",
                index: index.unwrap_or(i64::MAX),
                count,
            };
            let own = index.and_then(|index| usize::try_from(index).ok()).filter(|&index| index < n_points);
            let index = own.and_then(|index| u32::try_from(n_before + index).ok());
            nodes.push(index.ok_or_else(out_of_range)?);
        }
        cells.push(kind, &nodes, n_before + n_points, place, report)?;
    }
    Ok(cells)
}

/// Compares a count that the piece announces with what is there.
fn check_count(piece: Node<'_, '_>, name: &'static str, found: usize) -> Result<(), MeshError> {
    let announced = piece.attribute(name).and_then(|count| count.parse::<u64>().ok());
    match announced {
        Some(count) if count != found as u64 => Err(MeshError::CountTooLarge {
            place: Place::Part("piece"),
            what: name,
            count,
            limit: found as u64,
        }),
        _ => Ok(()),
    }
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &'static str) -> Result<Node<'a, 'input>, MeshError> {
    let child = node.children().find(|child| child.has_tag_name(name));
    child.ok_or(MeshError::Missing { place: Place::Part("VTU file"), what: name })
}

fn arrays<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(|child| child.has_tag_name("DataArray"))
}
