//! Pieces of a grid, and several joined into one.

use roxmltree::Node;

use super::arrays::{Encoding, unsupported};
use super::document::{arrays, child, name_of};
use crate::files::error::{MeshError, Place};
use crate::files::volume::cells::Cells;
use crate::files::volume::ghosts::{Ghosts, tells_ghosts};
use crate::files::volume::scalars::Numbers;
use crate::files::volume::vtk::kind_of;
use crate::{FileReport, Kind};

/// A piece of a grid, or all up to one.
pub(super) struct Piece {
    /// Coordinates, three a point.
    pub points: Numbers,
    pub is_text: bool,
    pub cells: Cells,
    pub fields: Vec<Field>,
}

/// Values at the points of a piece.
pub(super) struct Field {
    pub name: String,
    pub n_components: u32,
    pub numbers: Numbers,
}

impl Field {
    /// Whether there is a value for each of the points with so many coordinates.
    fn fits(&self, n_coordinates: usize) -> bool {
        self.numbers.len() * 3 == n_coordinates * self.n_components as usize
    }

    fn is_like(&self, other: &Self) -> bool {
        (&self.name, self.n_components, self.numbers.number)
            == (&other.name, other.n_components, other.numbers.number)
    }
}

impl Piece {
    /// Adds the next piece to what there is. One without points changes nothing.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unsupported`] or [`MeshError::CountTooLarge`].
    pub(super) fn join(whole: Option<Self>, next: Self, report: &mut FileReport) -> Result<Self, MeshError> {
        match whole {
            Some(whole) if next.points.len() == 0 => Ok(whole),
            Some(whole) if whole.points.len() > 0 => whole.with(next, report),
            _ => Ok(next),
        }
    }

    fn with(mut self, next: Self, report: &mut FileReport) -> Result<Self, MeshError> {
        if self.points.number != next.points.number {
            return Err(unsupported("pieces with points of different types".to_owned()));
        }
        let [n_before, n_next] = [self.points.len(), next.points.len()];
        let count = ((n_before + n_next) / 3) as u64;
        let first = u32::try_from(n_before / 3).ok().filter(|_| count <= u32::MAX.into());
        let (place, limit) = (Place::File, u32::MAX.into());
        let first = first.ok_or(MeshError::CountTooLarge { place, what: "points", count, limit })?;
        self.points.bytes.extend_from_slice(&next.points.bytes);
        self.is_text |= next.is_text;
        self.cells.append(next.cells, first);
        let (mut others, unfit): (Vec<Field>, Vec<Field>) =
            next.fields.into_iter().partition(|field| field.fits(n_next));
        let mut leave_out = |name: &str| {
            let id = report.named(Kind::Field, name);
            report.leave_out(id, "not every piece has it in the same form");
        };
        self.fields.retain_mut(|field| {
            match others.iter().position(|other| other.is_like(field)).filter(|_| field.fits(n_before)) {
                Some(at) => field.numbers.bytes.extend(others.remove(at).numbers.bytes),
                None => {
                    leave_out(&field.name);
                    return false;
                }
            }
            true
        });
        others.iter().chain(&unfit).for_each(|field| leave_out(&field.name));
        Ok(self)
    }
}

/// Whether a piece says that it has no points and no cells, and has no place for points. Programs
/// that write in parallel leave such pieces where a process had nothing to write.
pub(super) fn is_bare(piece: Node<'_, '_>) -> bool {
    let has_none = |name| piece.attribute(name).is_some_and(|count| count.parse() == Ok(0_u64));
    let coordinates = child(piece, "Points").ok().and_then(|points| arrays(points).next());
    has_none("NumberOfPoints") && has_none("NumberOfCells") && coordinates.is_none()
}

/// Reads a piece.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read_piece(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
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
    let ghosts = read_cell_data(piece, encoding, report)?;
    let cells = read_cells(piece, encoding, n_points, &ghosts, report)?;
    let fields = read_fields(piece, encoding, n_points, report)?;
    name_field_data(piece, report);
    Ok(Piece { points, is_text, cells, fields })
}

/// Reports data that belong to no point and no cell.
pub(super) fn name_field_data(parent: Node<'_, '_>, report: &mut FileReport) {
    for array in child(parent, "FieldData").into_iter().flat_map(arrays) {
        report.named(Kind::FieldData, name_of(array));
    }
}

/// Reads the values at points. Texts and what is encoded in an unknown way are left out and
/// reported.
fn read_fields(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
    n_points: usize,
    report: &mut FileReport,
) -> Result<Vec<Field>, MeshError> {
    let mut fields = Vec::new();
    for array in child(piece, "PointData").into_iter().flat_map(arrays) {
        let name = name_of(array);
        if tells_ghosts(name) {
            report.named(Kind::Field, name);
            continue;
        }
        let n_components = array.attribute("NumberOfComponents").map_or(Ok(1), str::parse).unwrap_or(0);
        match encoding.numbers(array) {
            Ok(mut numbers) => {
                if array.attribute("type") == Some("Bit") {
                    // The bits fill up their last byte.
                    numbers.bytes.truncate(n_points.saturating_mul(n_components as usize));
                }
                fields.push(Field { name: name.to_owned(), n_components, numbers });
            }
            Err(MeshError::Unsupported { feature, .. }) => {
                let id = report.named(Kind::Field, name);
                report.leave_out(id, feature);
            }
            Err(error) => return Err(error),
        }
    }
    Ok(fields)
}

/// Reports the values at cells and finds out which cells are ghosts.
fn read_cell_data(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
    report: &mut FileReport,
) -> Result<Ghosts, MeshError> {
    let mut ghosts = Ghosts::default();
    for array in child(piece, "CellData").into_iter().flat_map(arrays) {
        let name = name_of(array);
        if tells_ghosts(name) {
            ghosts.read(name, &encoding.numbers(array)?);
        } else {
            report.named(Kind::CellData, name);
        }
    }
    Ok(ghosts)
}

/// The cells of a piece of `n_points` points.
fn read_cells(
    piece: Node<'_, '_>,
    encoding: &Encoding<'_>,
    n_points: usize,
    ghosts: &Ghosts,
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
        let place = Place::Part("offsets");
        return Err(MeshError::CountTooLarge { place, what: "offsets", count, limit });
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
            nodes.push(node_index(index, n_points, place)?);
        }
        if !ghosts.leaves_out(cell, report) {
            cells.push(kind, &nodes, n_points, place, report)?;
        }
    }
    Ok(cells)
}

/// An index of one of so many points.
fn node_index(index: Option<i64>, n_points: usize, place: Place) -> Result<u32, MeshError> {
    let own = index.and_then(|index| u32::try_from(index).ok()).filter(|&index| (index as usize) < n_points);
    own.ok_or(MeshError::IndexOutOfRange {
        place,
        what: "vertex",
        index: index.unwrap_or(i64::MAX),
        count: n_points as u64,
    })
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
