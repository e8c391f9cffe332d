//! How far the fields of two volumes are apart, sampled at the vertices of each in the other.

use super::locator::{Locator, Place};
use super::{MeasureError, Side};
use crate::geometry::barycentric::{interpolate, largest};
use crate::mesh::has_coincident;
use nephrite_formats::{Attribute, ScalarType, TetrahedronMesh};
use rayon::prelude::*;
use serde::Serialize;

/// How far one field of two volumes is apart, in the unit of the field. For a field of several
/// components it is the length of the difference; for one of whole numbers it is 1 where the value
/// is not that of the nearest corner, and 0 elsewhere. Values that are not finite are left out.
/// Sampled, not proven.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FieldDistance {
    /// Name of the field, which both volumes have.
    pub name: String,
    /// The larger of both directions.
    pub max: f64,
    /// Largest difference at a vertex of the reference.
    pub max_forward: f64,
    /// Largest difference at a vertex of the mesh.
    pub max_backward: f64,
    /// Root of the mean squared difference at the vertices of the reference.
    pub rms: f64,
    /// Length of the diagonal of the box of all values of the reference, which percentages may
    /// refer to.
    pub range: f64,
    /// Vertices of both volumes that were sampled.
    pub n_samples: usize,
    /// Vertices of both volumes that are outside the other one and were left out.
    pub n_outside: usize,
}

/// Measures every field that both volumes have under the same name and with the same number of
/// components. O(n log n).
///
/// # Errors
///
/// [`MeasureError::Inconsistent`] for a volume that contradicts itself.
///
/// ```
/// use nephrite::generate::box_volume;
/// use nephrite::measure::measure_fields;
/// use nephrite::{Attribute, ScalarType};
/// let heights = |lift: f64| {
///     let mut volume = box_volume([3; 3]);
///     let values: Vec<f64> = volume.positions.iter().map(|p| f64::from(p[2]) + lift).collect();
///     volume.attributes.push(Attribute::from_values("height", ScalarType::F64, 1, values));
///     volume
/// };
/// let fields = measure_fields(&heights(0.0), &heights(0.5))?;
/// let height = fields.iter().find(|field| field.name == "height").ok_or("no height")?;
/// assert!((height.max - 0.5).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn measure_fields(
    reference: &TetrahedronMesh,
    mesh: &TetrahedronMesh,
) -> Result<Vec<FieldDistance>, MeasureError> {
    for (side, volume) in [(Side::Reference, reference), (Side::Mesh, mesh)] {
        volume.check().map_err(|fault| MeasureError::Inconsistent { side, fault })?;
    }
    let pairs: Vec<[&Attribute; 2]> = reference
        .attributes
        .iter()
        .filter_map(|field| {
            let same = mesh.attribute(&field.name)?;
            (same.n_components == field.n_components).then_some([field, same])
        })
        .collect();
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let fields: Vec<[Field; 2]> = pairs.iter().map(|pair| pair.map(Field::new)).collect();
    let forward = differences(reference, mesh, &fields);
    let swapped: Vec<[Field; 2]> =
        fields.iter().map(|[ours, theirs]| [theirs.clone(), ours.clone()]).collect();
    let backward = differences(mesh, reference, &swapped);
    let measured = pairs.iter().zip(&fields).enumerate().map(|(i, ([ours, _], [field, _]))| {
        let of_field = |rows: &[Option<Vec<f64>>]| -> Vec<f64> {
            rows.iter().flatten().map(|row| row[i]).filter(|difference| !difference.is_nan()).collect()
        };
        let [there, back] = [&forward, &backward].map(|rows| of_field(rows));
        let max = |differences: &[f64]| differences.iter().copied().fold(0.0, f64::max);
        let squares: f64 = there.iter().map(|difference| difference * difference).sum();
        let n_outside = forward.iter().chain(&backward).filter(|row| row.is_none()).count();
        FieldDistance {
            name: ours.name.clone(),
            max: max(&there).max(max(&back)),
            max_forward: max(&there),
            max_backward: max(&back),
            rms: (squares / there.len().max(1) as f64).sqrt(),
            range: range(&field.values, field.n_components),
            n_samples: there.len() + back.len(),
            n_outside,
        }
    });
    Ok(measured.collect())
}

/// A field in `f64`.
#[derive(Clone)]
struct Field {
    values: Vec<f64>,
    n_components: usize,
    is_whole: bool,
}

impl Field {
    fn new(attribute: &Attribute) -> Self {
        Self {
            values: attribute.values().collect(),
            n_components: attribute.n_components as usize,
            is_whole: !matches!(attribute.scalar, ScalarType::F32 | ScalarType::F64),
        }
    }

    fn at(&self, v: u32) -> &[f64] {
        &self.values[v as usize * self.n_components..][..self.n_components]
    }

    /// How far the values at a vertex are from those of another field at a place; NaN if none of
    /// them can be compared.
    fn difference(&self, v: u32, theirs: &Self, (corners, weights): Place) -> f64 {
        if self.is_whole && theirs.is_whole {
            let differs = self.at(v) != theirs.at(corners[largest(weights)]);
            return f64::from(u8::from(differs));
        }
        let there = |i: usize| interpolate(corners.map(|corner| theirs.at(corner)[i]), weights);
        let pairs = self.at(v).iter().enumerate().map(|(i, &here)| [here, there(i)]);
        let finite = pairs.filter(|pair| pair.iter().all(|value| value.is_finite()));
        let squares = finite.map(|[here, there]| (here - there).powi(2));
        squares.reduce(|sum, square| sum + square).map_or(f64::NAN, f64::sqrt)
    }
}

/// For each vertex the difference of each field from the other volume's at its place; `None`
/// outside. At a jump a place has the values of several sides: the least difference counts, since
/// the vertex belongs to one of them.
fn differences(
    vertices: &TetrahedronMesh,
    volume: &TetrahedronMesh,
    fields: &[[Field; 2]],
) -> Vec<Option<Vec<f64>>> {
    let locator = Locator::new(volume);
    let has_jumps = has_coincident(volume);
    let shift: [f64; 3] = std::array::from_fn(|axis| vertices.origin[axis] - volume.origin[axis]);
    let of_vertex = |places: &mut Vec<Place>, (v, p): (usize, &[f32; 3])| {
        let point = std::array::from_fn(|axis| f64::from(p[axis]) + shift[axis]);
        if has_jumps {
            locator.find_all(point, places);
        } else {
            places.clear();
            places.extend(locator.find(point));
        }
        #[expect(clippy::cast_possible_truncation, reason = "readers refuse more than u32::MAX vertices")]
        let v = v as u32;
        let difference = |[ours, theirs]: &[Field; 2]| {
            places.iter().map(|&place| ours.difference(v, theirs, place)).fold(f64::NAN, f64::min)
        };
        (!places.is_empty()).then(|| fields.iter().map(difference).collect())
    };
    vertices.positions.par_iter().enumerate().map_init(Vec::new, of_vertex).collect()
}

/// Length of the diagonal of the box of all finite values.
fn range(values: &[f64], n: usize) -> f64 {
    let side = |component: usize| {
        let values = values.iter().skip(component).step_by(n).filter(|value| value.is_finite());
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values.fold(start, |(low, high), &value| (low.min(value), high.max(value)));
        if high > low { (high - low).powi(2) } else { 0.0 }
    };
    (0..n).map(side).sum::<f64>().sqrt()
}
