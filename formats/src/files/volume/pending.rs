//! The parts of a volume as a reader finds them, put together at the end of the file.

use super::cells::Cells;
use super::scalars::{Numbers, points_f32};
use crate::files::coordinates::Coordinates;
pub(super) use crate::files::coordinates::Points;
use crate::files::distinct::DistinctNames;
use crate::files::report::ItemId;
use crate::{Attribute, Change, FileReport, Kind, MeshError, TetrahedronMesh};

impl Points {
    /// Points of three numbers each. An incomplete last point is left out.
    pub(super) fn new(numbers: &Numbers, is_text: bool) -> Self {
        if let Some(points) = points_f32(numbers) {
            return Self::F32(points);
        }
        let values: Vec<f64> = numbers.to_f64().collect();
        let points = values.as_chunks::<3>().0.to_vec();
        if is_text { Self::Text(points) } else { Self::F64(points) }
    }

    /// For each point whether `f32` can hold its coordinates.
    fn usable(&self) -> Vec<bool> {
        let can_be_f32 = |value: f64| value.abs() <= f64::from(f32::MAX);
        match self {
            Self::F32(points) => {
                points.iter().map(|point| point.iter().all(|value| value.is_finite())).collect()
            }
            Self::F64(points) | Self::Text(points) => {
                points.iter().map(|point| point.iter().all(|&value| can_be_f32(value))).collect()
            }
        }
    }

    fn retain(&mut self, is_kept: &[bool]) {
        let mut kept = is_kept.iter().copied();
        match self {
            Self::F32(points) => points.retain(|_| kept.next().unwrap_or(true)),
            Self::F64(points) | Self::Text(points) => points.retain(|_| kept.next().unwrap_or(true)),
        }
    }
}

/// Fields in the order found.
#[derive(Default)]
pub(super) struct Fields {
    /// Each with its place in the report.
    fields: Vec<(Attribute, ItemId)>,
    names: DistinctNames,
}

impl Fields {
    /// Adds a field for `n_points` vertices. A field of another length is left out. A second field
    /// of one name gets a number behind its name. 64-bit integers are narrowed. The report tells
    /// each.
    pub(super) fn push(
        &mut self,
        name: &str,
        n_components: u32,
        numbers: Numbers,
        n_points: usize,
        report: &mut FileReport,
    ) {
        let found = numbers.len() as u64;
        let per_point = u64::from(n_components);
        let id = report.found(Kind::Field, name);
        if n_components == 0 || found != n_points as u64 * per_point {
            report.leave_out(id, wrong_length(found / per_point.max(1), n_points as u64));
            return;
        }
        let name = if name.is_empty() { "field" } else { name };
        // The `.neph` file ends names with a zero byte.
        let new_name = self.names.take(name.replace('\0', "\u{fffd}"));
        report.keep(id);
        if new_name != name {
            report.change(id, Change::Renamed { new_name: new_name.clone() });
        }
        let (scalar, bytes, is_narrowed) = numbers.into_kept();
        if is_narrowed {
            let scalar = if scalar == crate::ScalarType::I32 { "i32" } else { "f64" };
            report.change(id, Change::Narrowed { scalar });
        }
        self.fields.push((Attribute { name: new_name, scalar, n_components, bytes }, id));
    }
}

/// Why a field with another number of values than there are points is left out.
pub(super) fn wrong_length(found: u64, expected: u64) -> String {
    format!("it has {found} values for {expected} vertices")
}

/// Puts the parts of a volume together. Leaves out, and reports, fields for another number of
/// vertices (points stand behind them in the file, or twice) and unused points without a usable
/// position.
///
/// # Errors
///
/// [`MeshError::NoTetrahedra`], and coordinates of cells that are not finite or too large.
pub(super) fn finish(
    points: Points,
    mut cells: Cells,
    fields: Fields,
    mut report: FileReport,
) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let n_points = points.len();
    if cells.len() == 0 {
        return Err(MeshError::NoTetrahedra { n_vertices: n_points });
    }
    let (fields, misfits): (Vec<_>, Vec<_>) = fields
        .fields
        .into_iter()
        .partition(|(field, _)| field.bytes.len() == field.stride_bytes() * n_points);
    for (field, id) in misfits {
        let found = (field.bytes.len() / field.stride_bytes()) as u64;
        report.leave_out(id, wrong_length(found, n_points as u64));
    }
    let mut attributes: Vec<Attribute> = fields.into_iter().map(|(field, _)| field).collect();
    let mut points = points;
    if let Some(is_kept) = usable_or_used(&points, &cells) {
        let n_left_out = is_kept.iter().filter(|&&is_kept| !is_kept).count();
        report.count(Kind::UnusablePoint, n_left_out as u64);
        points.retain(&is_kept);
        attributes.iter_mut().for_each(|field| retain(field, &is_kept));
        let mut n_kept = 0;
        let number = |&is_kept: &bool| {
            n_kept += u32::from(is_kept);
            n_kept.saturating_sub(1)
        };
        cells.renumber(&is_kept.iter().map(number).collect::<Vec<u32>>());
    }
    let Coordinates { origin, positions, rounding } = points.into_coordinates()?;
    let tetrahedra = cells.into_tetrahedra(&positions);
    let mesh = TetrahedronMesh { origin, positions, tetrahedra, attributes, rounding };
    Ok((mesh, report))
}

/// For each point whether it has a usable position or a cell uses it; `None` if all have and
/// nothing is to be left out.
fn usable_or_used(points: &Points, cells: &Cells) -> Option<Vec<bool>> {
    let mut is_kept = points.usable();
    if is_kept.iter().all(|&is_usable| is_usable) {
        return None;
    }
    cells.corners().iter().for_each(|&corner| is_kept[corner as usize] = true);
    is_kept.contains(&false).then_some(is_kept)
}

/// Keeps the values of the kept vertices.
fn retain(field: &mut Attribute, is_kept: &[bool]) {
    let values = field.bytes.chunks_exact(field.stride_bytes());
    let kept = values.zip(is_kept).filter(|&(_, &is_kept)| is_kept);
    field.bytes = kept.flat_map(|(value, _)| value.iter().copied()).collect();
}
