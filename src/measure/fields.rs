//! How far the fields of two volumes are apart, sampled at the vertices of each in the other.

use super::locator::Locator;
use super::{MeasureError, Side};
use nephrite_formats::{Attribute, TetrahedronMesh};
use rayon::prelude::*;
use serde::Serialize;

/// How far one field of two volumes is apart, in the unit of the field. For a field of several
/// components it is the length of the difference. Sampled, not proven.
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
    let forward = Places::find(reference, mesh);
    let backward = Places::find(mesh, reference);
    let measured = pairs.par_iter().map(|[ours, theirs]| {
        let n = ours.n_components as usize;
        let values = [ours, theirs].map(|field| field.values().collect::<Vec<f64>>());
        let [there, back] =
            [forward.differences(&values[0], &values[1], n), backward.differences(&values[1], &values[0], n)];
        let max = |differences: &[f64]| differences.iter().copied().fold(0.0, f64::max);
        let squares: f64 = there.iter().map(|difference| difference * difference).sum();
        let n_samples = there.len() + back.len();
        FieldDistance {
            name: ours.name.clone(),
            max: max(&there).max(max(&back)),
            max_forward: max(&there),
            max_backward: max(&back),
            rms: (squares / there.len().max(1) as f64).sqrt(),
            range: range(&values[0], n),
            n_samples,
            n_outside: reference.positions.len() + mesh.positions.len() - n_samples,
        }
    });
    Ok(measured.collect())
}

/// Where the vertices of one volume are in the other.
struct Places {
    places: Vec<Option<([u32; 4], [f64; 4])>>,
}

impl Places {
    fn find(vertices: &TetrahedronMesh, volume: &TetrahedronMesh) -> Self {
        let locator = Locator::new(volume);
        let shift: [f64; 3] = std::array::from_fn(|axis| vertices.origin[axis] - volume.origin[axis]);
        let find = |p: &[f32; 3]| locator.find(std::array::from_fn(|axis| f64::from(p[axis]) + shift[axis]));
        Self { places: vertices.positions.par_iter().map(find).collect() }
    }

    /// Lengths of the differences between values at vertices and the values of the other volume at
    /// the same places.
    fn differences(&self, ours: &[f64], theirs: &[f64], n: usize) -> Vec<f64> {
        let placed = self.places.iter().enumerate().filter_map(|(v, place)| Some((v, (*place)?)));
        placed
            .map(|(v, (corners, weights))| {
                let square = |component: usize| {
                    let value = |corner: u32| theirs[corner as usize * n + component];
                    let there: f64 = corners.iter().zip(weights).map(|(&corner, w)| w * value(corner)).sum();
                    (ours[v * n + component] - there).powi(2)
                };
                (0..n).map(square).sum::<f64>().sqrt()
            })
            .collect()
    }
}

fn range(values: &[f64], n: usize) -> f64 {
    let side = |component: usize| {
        let values = values.iter().skip(component).step_by(n);
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values.fold(start, |(low, high), &value| (low.min(value), high.max(value)));
        if high > low { (high - low).powi(2) } else { 0.0 }
    };
    (0..n).map(side).sum::<f64>().sqrt()
}
