//! Fields carried along: their values at fusion points, and how far they have come from those of the input.

use super::neighbourhood::Neighbourhood;
use crate::geometry::vector::{Vector, cross, dot, sub};
use crate::mesh::Tetrahedra;
use nephrite_formats::{Attribute, ScalarType};

/// The fields of a mesh in `f64`.
#[derive(Clone, Debug, Default)]
pub(super) struct Fields {
    shapes: Vec<Shape>,
    /// Components of all fields together.
    n_values: usize,
    /// `n_values` per vertex.
    values: Vec<f64>,
    /// Estimated deviation of each field, per vertex.
    deviations: Vec<f64>,
    /// The components that the metric weighs.
    columns: Vec<Column>,
    /// Whether other components vary.
    is_interpolated: bool,
    /// The largest deviation of each field anywhere so far.
    pub worst: Vec<f64>,
    scratch: Vec<f64>,
}

/// One field.
#[derive(Clone, Debug)]
struct Shape {
    name: String,
    scalar: ScalarType,
    n_components: usize,
}

/// A component that varies, among all `n_values`.
#[derive(Clone, Copy, Debug)]
struct Column {
    place: usize,
    /// Makes the range of its field the length asked for.
    scale: f64,
    /// Least and largest value in the input.
    range: [f64; 2],
}

impl Fields {
    /// The fields of a mesh of `n_vertices` vertices; to the metric, the range of each is worth `length`, and with a length of zero
    /// nothing. Fields that do not vary, or have values that are not finite, are left out there.
    pub(super) fn new(attributes: &[Attribute], n_vertices: usize, length: f64) -> Self {
        let shapes: Vec<Shape> = attributes
            .iter()
            .map(|a| Shape { name: a.name.clone(), scalar: a.scalar, n_components: a.n_components as usize })
            .collect();
        let n_values = shapes.iter().map(|shape| shape.n_components).sum();
        let mut values = vec![0.0; n_values * n_vertices];
        let mut first = 0;
        for (attribute, shape) in attributes.iter().zip(&shapes) {
            for (i, value) in attribute.values().enumerate() {
                let (vertex, component) = (i / shape.n_components, i % shape.n_components);
                values[vertex * n_values + first + component] = value;
            }
            first += shape.n_components;
        }
        let n_fields = shapes.len();
        let columns = columns(&shapes, n_values, &values, length);
        let n_varying = (0..n_values).filter(|&place| is_varying(range(&values, n_values, place))).count();
        Self {
            is_interpolated: n_varying > columns.len(),
            columns,
            shapes,
            n_values,
            values,
            deviations: vec![0.0; n_fields * n_vertices],
            worst: vec![0.0; n_fields],
            scratch: Vec::new(),
        }
    }

    /// Number of fields.
    pub(super) fn len(&self) -> usize {
        self.shapes.len()
    }

    /// Names of the fields.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.shapes.iter().map(|shape| shape.name.as_str())
    }

    /// The values that the metric weighs, scaled: their number per vertex, and those of all vertices.
    pub(super) fn scaled(&self) -> (usize, Vec<f64>) {
        let rows = self.values.chunks_exact(self.n_values.max(1));
        let scaled = rows.flat_map(|row| self.columns.iter().map(|column| column.scale * row[column.place]));
        (self.columns.len(), scaled.collect())
    }

    /// A value that the metric weighs, scaled.
    pub(super) fn scaled_value(&self, v: u32, i: usize) -> f64 {
        let column = &self.columns[i];
        column.scale * self.values[v as usize * self.n_values + column.place]
    }

    /// Values at `p` for a vertex that takes the place of `fused`. At the place of one of them they are its own, so that what holds at a
    /// boundary goes on to hold there. Elsewhere they are interpolated in the tetrahedron that holds `p`, and those that the metric
    /// weighs are its best ones, within the range of the input: values of single vertices stand for ever fewer of the input's.
    pub(super) fn add_vertex(
        &mut self,
        mesh: &Tetrahedra,
        neighbourhood: &Neighbourhood,
        fused: &[u32],
        p: [f32; 3],
        best_value: impl Fn(usize) -> Option<f64>,
    ) {
        let Some(&first) = fused.first().filter(|_| self.n_values > 0) else { return };
        let start = self.values.len();
        if let Some(&same) = fused.iter().find(|&&v| mesh.positions()[v as usize] == p) {
            let row = same as usize * self.n_values;
            self.values.extend_from_within(row..row + self.n_values);
            return;
        }
        // Components that do not vary have the same value everywhere.
        let row = first as usize * self.n_values;
        self.values.extend_from_within(row..row + self.n_values);
        if self.is_interpolated || best_value(0).is_none() {
            self.interpolate_last(mesh, neighbourhood, p.map(f64::from));
        }
        let new = &mut self.values[start..];
        for (i, column) in self.columns.iter().enumerate() {
            if let Some(value) = best_value(i) {
                let [low, high] = column.range;
                new[column.place] = (value / column.scale).clamp(low, high);
            }
        }
    }

    /// Gives the last vertex the values that the mesh before the fusion has at `p`.
    fn interpolate_last(&mut self, mesh: &Tetrahedra, neighbourhood: &Neighbourhood, p: Vector) {
        let affected = neighbourhood.affected.iter().map(|affected| affected.slot);
        let slots = neighbourhood.deleted.iter().copied().chain(affected);
        let mut best = None;
        let mut best_inside = f64::NEG_INFINITY;
        for corners in slots.filter_map(|slot| mesh.get(slot)) {
            let Some(weights) = barycentric(p, corners.map(|v| mesh.position(v))) else { continue };
            let inside = weights.iter().copied().fold(f64::INFINITY, f64::min);
            if inside > best_inside {
                (best_inside, best) = (inside, Some((corners, weights)));
            }
            if inside >= 0.0 {
                break;
            }
        }
        let Some((corners, weights)) = best else { return };
        let last = self.values.len() - self.n_values;
        let (old, new) = self.values.split_at_mut(last);
        interpolate(old, self.n_values, corners, weights, new);
    }

    /// Estimates the deviation at the newest vertex: what the fused ones had, and how far their values are from those that the
    /// new tetrahedra have at their places. The affected tetrahedra have their new corner, `new` at `p`.
    pub(super) fn deviate(
        &mut self,
        mesh: &Tetrahedra,
        neighbourhood: &Neighbourhood,
        fused: &[u32],
        new: u32,
    ) {
        let n_fields = self.len();
        if n_fields == 0 {
            return;
        }
        let start = self.deviations.len();
        self.deviations.resize(start + n_fields, 0.0);
        let p = mesh.position(new);
        for &v in fused {
            let x = mesh.position(v);
            self.scratch.clear();
            self.scratch.resize(self.n_values, 0.0);
            if x == p {
                self.scratch.copy_from_slice(&self.values[new as usize * self.n_values..][..self.n_values]);
            } else if let Some((corners, weights)) = cone_at(mesh, neighbourhood, p, x, new) {
                interpolate(&self.values, self.n_values, corners, weights, &mut self.scratch);
            } else {
                continue;
            }
            let mut first = 0;
            for (field, shape) in self.shapes.iter().enumerate() {
                let there = &self.values[v as usize * self.n_values + first..][..shape.n_components];
                let here = &self.scratch[first..][..shape.n_components];
                first += shape.n_components;
                let difference_sq: f64 = there.iter().zip(here).map(|(a, b)| (a - b) * (a - b)).sum();
                // Values may be so far apart that no number tells how far.
                let deviation =
                    (self.deviations[v as usize * n_fields + field] + difference_sq.sqrt()).min(f64::MAX);
                let own = &mut self.deviations[start + field];
                *own = own.max(deviation);
                self.worst[field] = self.worst[field].max(deviation);
            }
        }
    }

    /// The fields of all vertices as attributes, rounded to the types they came in.
    pub(super) fn into_attributes(self) -> Vec<Attribute> {
        let n_values = self.n_values.max(1);
        let mut first = 0;
        let mut attributes = Vec::new();
        for shape in &self.shapes {
            let range = first..first + shape.n_components;
            first = range.end;
            let values =
                self.values.chunks_exact(n_values).flat_map(|row| row[range.clone()].iter().copied());
            attributes.push(Attribute::from_values(
                shape.name.clone(),
                shape.scalar,
                u32::try_from(shape.n_components).unwrap_or(u32::MAX),
                values,
            ));
        }
        attributes
    }
}

/// The components that the metric weighs, the widest of each field scaled to a range of `length`.
fn columns(shapes: &[Shape], n_values: usize, values: &[f64], length: f64) -> Vec<Column> {
    let mut columns = Vec::new();
    let mut first = 0;
    for shape in shapes {
        let components = first..first + shape.n_components;
        first = components.end;
        let ranges: Vec<[f64; 2]> = components.clone().map(|place| range(values, n_values, place)).collect();
        let widest = ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        if widest > 0.0 && widest.is_finite() && length > 0.0 {
            let varying = components.zip(ranges).filter(|&(_, range)| is_varying(range));
            columns.extend(varying.map(|(place, range)| Column { place, scale: length / widest, range }));
        }
    }
    columns
}

/// Least and largest value of a component; of infinite distance where one is not finite.
fn range(values: &[f64], n_values: usize, place: usize) -> [f64; 2] {
    let values = values.iter().skip(place).step_by(n_values);
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
        if value.is_finite() { [low.min(value), high.max(value)] } else { [f64::NEG_INFINITY, f64::INFINITY] }
    })
}

fn is_varying([low, high]: [f64; 2]) -> bool {
    high > low
}

fn interpolate(values: &[f64], n_values: usize, corners: [u32; 4], weights: [f64; 4], into: &mut [f64]) {
    into.fill(0.0);
    // About one corner: a field that is constant there stays so to the last bit.
    let base = &values[corners[0] as usize * n_values..][..n_values];
    for (&v, weight) in corners.iter().zip(weights).skip(1) {
        let row = &values[v as usize * n_values..][..n_values];
        for ((sum, value), base) in into.iter_mut().zip(row).zip(base) {
            *sum += weight * (value - base);
        }
    }
    into.iter_mut().zip(base).for_each(|(sum, base)| *sum += base);
}

/// How far outside a tetrahedron, in its coordinates, its field is taken to go on.
const MAX_OUTSIDE: f64 = 0.1;

/// The new tetrahedron that `x` lies in, or that it is least outside of, with its coordinates there, made positive where that is far.
fn cone_at(
    mesh: &Tetrahedra,
    neighbourhood: &Neighbourhood,
    p: Vector,
    x: Vector,
    new: u32,
) -> Option<([u32; 4], [f64; 4])> {
    let ray = sub(x, p);
    let mut best = None;
    let mut best_inside = f64::NEG_INFINITY;
    for affected in &neighbourhood.affected {
        let [a, b, c] = affected.base.map(|v| sub(mesh.position(v), p));
        let across = cross(b, c);
        let volume = dot(a, across);
        let u = dot(ray, across) / volume;
        // Most are refused by the first of three coordinates; a base seen edge-on gives no number.
        if u.is_nan() || u <= best_inside {
            continue;
        }
        let [v, w] = [dot(ray, cross(c, a)) / volume, dot(ray, cross(a, b)) / volume];
        let inside = u.min(v).min(w).min(1.0 - u - v - w);
        if inside > best_inside {
            let [a, b, c] = affected.base;
            (best_inside, best) = (inside, Some(([new, a, b, c], [1.0 - u - v - w, u, v, w])));
        }
        if inside >= 0.0 {
            break;
        }
    }
    // A little outside, by rounding or where the boundary has moved inwards, the field goes on as it is.
    let (corners, weights) = best?;
    if best_inside > -MAX_OUTSIDE {
        return Some((corners, weights));
    }
    let positive = weights.map(|weight: f64| weight.max(0.0));
    let sum: f64 = positive.iter().sum();
    Some((corners, positive.map(|weight| weight / sum)))
}

/// Barycentric coordinates of a point in a tetrahedron; `None` for one without volume.
pub(crate) fn barycentric(point: Vector, [a, b, c, d]: [Vector; 4]) -> Option<[f64; 4]> {
    let (b, c, d, p) = (sub(b, a), sub(c, a), sub(d, a), sub(point, a));
    let volume = dot(b, cross(c, d));
    if volume == 0.0 {
        return None;
    }
    let [u, v, w] = [dot(p, cross(c, d)), dot(p, cross(d, b)), dot(p, cross(b, c))].map(|part| part / volume);
    Some([1.0 - u - v - w, u, v, w])
}
