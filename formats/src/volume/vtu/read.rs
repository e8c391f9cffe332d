//! Reading a VTU file.

use std::cell::Cell;

use roxmltree::{Document, Node};

use super::arrays::{Encoding, is_base64, unsupported};
use crate::error::{MeshError, Place, quoted_name, shortened};
use crate::volume::cells::Cells;
use crate::volume::pending::{Fields, Points, finish};
use crate::volume::scalars::Numbers;
use crate::volume::vtk::kind_of;
use crate::{TetrahedronMesh, VolumeFormat, VolumeReport, VolumeWarning};

/// Reads a VTU file of one piece.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(in crate::volume) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, VolumeReport), MeshError> {
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
    let mut pieces = grid.children().filter(|node| node.has_tag_name("Piece"));
    let piece = pieces.next().ok_or(MeshError::Missing { place: Place::File, what: "piece" })?;
    if pieces.next().is_some() {
        return Err(unsupported("more than one piece".to_owned()));
    }
    read_piece(piece, &encoding)
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

fn read_piece(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
) -> Result<(TetrahedronMesh, VolumeReport), MeshError> {
    let mut report = VolumeReport::new(VolumeFormat::Vtu);
    let coordinates = arrays(child(piece, "Points")?).next();
    let coordinates =
        coordinates.ok_or(MeshError::Missing { place: Place::Part("Points"), what: "array" })?;
    let is_text = coordinates.attribute("format") == Some("ascii");
    let points = Points::new(&encoding.numbers(coordinates)?, is_text);
    check_count(piece, "NumberOfPoints", points.len())?;
    let cells = read_cells(piece, encoding, points.len(), &mut report)?;
    let mut fields = Fields::default();
    if let Ok(data) = child(piece, "PointData") {
        for array in arrays(data) {
            let name = array.attribute("Name").unwrap_or("");
            let n_components = array.attribute("NumberOfComponents").map_or(Ok(1), str::parse);
            match encoding.numbers(array) {
                Ok(numbers) => {
                    fields.push(name, n_components.unwrap_or(0), numbers, points.len(), &mut report);
                }
                Err(MeshError::Unsupported { .. }) => {
                    let name = name.to_owned();
                    report.warnings.push(VolumeWarning::DataIgnored { kind: "point data", name });
                }
                Err(error) => return Err(error),
            }
        }
    }
    for (part, kind) in [("CellData", "cell data"), ("FieldData", "field data")] {
        for array in child(piece, part).into_iter().flat_map(arrays) {
            let name = array.attribute("Name").unwrap_or("").to_owned();
            report.warnings.push(VolumeWarning::DataIgnored { kind, name });
        }
    }
    finish(points, cells, fields, report)
}

fn read_cells(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
    n_points: usize,
    report: &mut VolumeReport,
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
            nodes.push(index.and_then(|index| u32::try_from(index).ok()).ok_or_else(out_of_range)?);
        }
        cells.push(kind, &nodes, n_points, place, report)?;
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
