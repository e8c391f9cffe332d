//! Fields carried along: their values at fusion points, and how far they have come from those of
//! the input.

use super::jumps::Jumps;
use super::neighbourhood::{Affected, Neighbourhood};
use crate::geometry::barycentric::{barycentric, interpolate, largest};
use crate::geometry::vector::{Vector, cross, dot, length_sq, sub};
use crate::mesh::Tetrahedra;
use nephrite_formats::{Attribute, ScalarType};
use std::ops::Range;

/// The fields of a mesh in `f64`.
#[derive(Clone, Debug, Default)]
pub(super) struct Fields {
    shapes: Vec<FieldShape>,
    /// Components of all fields together.
    n_values: usize,
    /// `n_values` per vertex.
    values: Vec<f64>,
    /// Estimated deviation of each field, per vertex.
    deviations: Vec<f64>,
    /// The components that the metric weighs.
    columns: Vec<Column>,
    /// Other components of numbers that are not whole, if they vary.
    interpolated: Vec<usize>,
    /// The largest deviation of each field anywhere so far.
    pub worst: Vec<f64>,
}

/// One field.
#[derive(Clone, Debug)]
struct FieldShape {
    name: String,
    scalar: ScalarType,
    /// Its components, among all `n_values`.
    places: Range<usize>,
}

impl FieldShape {
    /// Whether its values are labels or counts: a new vertex gets one of those that it replaces,
    /// and never a mean.
    fn is_whole(&self) -> bool {
        !matches!(self.scalar, ScalarType::F32 | ScalarType::F64)
    }
}

/// A component that varies, among all `n_values`.
#[derive(Clone, Copy, Debug)]
struct Column {
    place: usize,
    /// Makes the range of its field the length asked for.
    scale: f64,
    /// Least and largest finite value in the input.
    range: [f64; 2],
    /// Whether a new vertex gets the metric's best value: not in whole numbers, nor where values
    /// are not finite.
    is_fitted: bool,
}

impl Column {
    /// A value as the metric weighs it. One that is not finite counts as the middle of the range.
    fn scaled(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        self.scale * if value.is_finite() { value } else { low + 0.5 * (high - low) }
    }
}

impl Fields {
    /// The fields of a mesh of `n_vertices` vertices; to the metric, the range of each is worth
    /// `length`, and with a length of zero nothing. Fields that do not vary are left out there.
    pub(super) fn new(attributes: &[Attribute], n_vertices: usize, length: f64) -> Self {
        let mut n_values = 0;
        let shapes = attributes.iter().map(|a| {
            let first = n_values;
            n_values += a.n_components as usize;
            FieldShape { name: a.name.clone(), scalar: a.scalar, places: first..n_values }
        });
        let shapes: Vec<FieldShape> = shapes.collect();
        let mut values = vec![0.0; n_values * n_vertices];
        for (attribute, shape) in attributes.iter().zip(&shapes) {
            let mut attribute = attribute.values();
            for row in values.chunks_exact_mut(n_values) {
                row[shape.places.clone()]
                    .iter_mut()
                    .zip(&mut attribute)
                    .for_each(|(place, value)| *place = value);
            }
        }
        let n_fields = shapes.len();
        let columns = columns(&shapes, n_values, &values, length);
        let is_fitted =
            |place| columns.iter().any(|column: &Column| column.is_fitted && column.place == place);
        let floats = shapes.iter().filter(|shape| !shape.is_whole()).flat_map(|shape| shape.places.clone());
        let interpolated = floats.filter(|&place| !is_fitted(place) && !is_same(&values, n_values, place));
        Self {
            interpolated: interpolated.collect(),
            columns,
            shapes,
            n_values,
            values,
            deviations: vec![0.0; n_fields * n_vertices],
            worst: vec![0.0; n_fields],
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

    /// The values that the metric weighs, scaled: their number per vertex, and those of all
    /// vertices.
    pub(super) fn scaled(&self) -> (usize, Vec<f64>) {
        let rows = self.values.chunks_exact(self.n_values.max(1));
        let scaled = rows.flat_map(|row| self.columns.iter().map(|column| column.scaled(row[column.place])));
        (self.columns.len(), scaled.collect())
    }

    /// A value that the metric weighs, scaled.
    pub(super) fn scaled_value(&self, v: u32, i: usize) -> f64 {
        let column = &self.columns[i];
        column.scaled(self.values[v as usize * self.n_values + column.place])
    }

    /// Values at `p` for a vertex that takes the place of `fused`. At the place of one of them they
    /// are its own, so that what holds at a boundary goes on to hold there. Elsewhere whole numbers
    /// are those of the nearest of `fused`; other numbers that the metric weighs are its best ones,
    /// within the range of the input: values of single vertices stand for ever fewer of the
    /// input's. The rest is interpolated in the tetrahedron that holds `p`.
    pub(super) fn add_vertex(
        &mut self,
        surroundings: Surroundings<'_>,
        fused: &[u32],
        p: [f32; 3],
        best_value: impl Fn(usize) -> Option<f64>,
    ) {
        let Surroundings { mesh, .. } = surroundings;
        let place = p.map(f64::from);
        let distance_sq = |v: u32| length_sq(sub(mesh.position(v), place));
        let nearest = fused.iter().copied().min_by(|&v, &w| distance_sq(v).total_cmp(&distance_sq(w)));
        let Some(nearest) = nearest.filter(|_| self.n_values > 0) else { return };
        let start = self.values.len();
        let row = nearest as usize * self.n_values;
        self.values.extend_from_within(row..row + self.n_values);
        if mesh.positions()[nearest as usize] == p {
            return;
        }
        let has_best = best_value(0).is_some();
        let is_interpolated = !self.interpolated.is_empty() || !has_best;
        let found = if is_interpolated { surroundings.tetrahedron_at(place) } else { None };
        if let Some((corners, weights)) = found {
            let unfitted = self.columns.iter().filter(|column| column.is_fitted && !has_best);
            for place in self.interpolated.iter().copied().chain(unfitted.map(|column| column.place)) {
                self.values[start + place] = self.interpolated(corners, weights, place);
            }
        }
        for (i, column) in self.columns.iter().enumerate().filter(|(_, column)| column.is_fitted) {
            if let Some(value) = best_value(i) {
                let [low, high] = column.range;
                self.values[start + column.place] = (value / column.scale).clamp(low, high);
            }
        }
    }

    /// A component inside a tetrahedron.
    fn interpolated(&self, corners: [u32; 4], weights: [f64; 4], place: usize) -> f64 {
        interpolate(corners.map(|v| self.values[v as usize * self.n_values + place]), weights)
    }

    /// Estimates the deviation at the newest vertex: what the fused ones had, and how far their
    /// values are from those that the new tetrahedra have at their places. The affected tetrahedra
    /// have their new corner, `new` at `p`.
    pub(super) fn deviate(&mut self, surroundings: Surroundings<'_>, fused: &[u32], new: u32) {
        let n_fields = self.len();
        if n_fields == 0 {
            return;
        }
        let start = self.deviations.len();
        self.deviations.resize(start + n_fields, 0.0);
        let p = surroundings.mesh.position(new);
        for &v in fused {
            let x = surroundings.mesh.position(v);
            let there =
                if x == p { Some(([new; 4], [1.0, 0.0, 0.0, 0.0])) } else { surroundings.cone_at(p, x, new) };
            let Some((corners, weights)) = there else { continue };
            for field in 0..n_fields {
                let before = self.deviations[v as usize * n_fields + field];
                let deviation = self.deviation(field, before, v, (corners, weights));
                let own = &mut self.deviations[start + field];
                *own = own.max(deviation);
                self.worst[field] = self.worst[field].max(deviation);
            }
        }
    }

    /// The deviation of a field at a vertex that had `before` and now is inside a tetrahedron. In
    /// whole numbers it is 1 where the value is not that of the nearest corner; in others the
    /// difference is added, without components that are not finite.
    fn deviation(&self, field: usize, before: f64, v: u32, (corners, weights): ([u32; 4], [f64; 4])) -> f64 {
        let shape = &self.shapes[field];
        let row = |v: u32| &self.values[v as usize * self.n_values..][..self.n_values];
        if shape.is_whole() {
            let nearest = corners[largest(weights)];
            let differs = row(v)[shape.places.clone()] != row(nearest)[shape.places.clone()];
            return before.max(f64::from(u8::from(differs)));
        }
        let pairs =
            shape.places.clone().map(|place| [row(v)[place], self.interpolated(corners, weights, place)]);
        let finite = pairs.filter(|pair| pair.iter().all(|value| value.is_finite()));
        let difference_sq: f64 = finite.map(|[a, b]| (a - b) * (a - b)).sum();
        // Values may be so far apart that no number tells how far.
        (before + difference_sq.sqrt()).min(f64::MAX)
    }

    /// The fields of all vertices as attributes, rounded to the types they came in.
    pub(super) fn into_attributes(self) -> Vec<Attribute> {
        let rows = || self.values.chunks_exact(self.n_values.max(1));
        let attribute = |FieldShape { name, scalar, places }: &FieldShape| {
            let values = rows().flat_map(|row| row[places.clone()].iter().copied());
            let n_components = u32::try_from(places.len()).unwrap_or(u32::MAX);
            Attribute::from_values(name.clone(), *scalar, n_components, values)
        };
        self.shapes.iter().map(attribute).collect()
    }
}

/// The components that the metric weighs, the widest of each field scaled to a range of `length`.
fn columns(shapes: &[FieldShape], n_values: usize, values: &[f64], length: f64) -> Vec<Column> {
    let mut columns = Vec::new();
    for shape in shapes {
        let places = shape.places.clone();
        let ranges: Vec<[f64; 2]> = places.clone().map(|place| range(values, n_values, place)).collect();
        let widest = ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let scale = length / widest;
        if widest > 0.0 && widest.is_finite() && scale > 0.0 && scale.is_finite() {
            let varying = places.zip(ranges).filter(|(_, [low, high])| high > low);
            columns.extend(varying.map(|(place, range)| {
                let is_fitted = !shape.is_whole() && component(values, n_values, place).all(f64::is_finite);
                Column { place, scale, range, is_fitted }
            }));
        }
    }
    columns
}

/// One component of all vertices.
fn component(values: &[f64], n_values: usize, place: usize) -> impl Iterator<Item = f64> {
    values.iter().skip(place).step_by(n_values).copied()
}

/// Least and largest finite value of a component; infinity and minus infinity if there is none.
fn range(values: &[f64], n_values: usize, place: usize) -> [f64; 2] {
    let finite = component(values, n_values, place).filter(|value| value.is_finite());
    finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

/// Whether a component has the same bits at all vertices.
fn is_same(values: &[f64], n_values: usize, place: usize) -> bool {
    let mut bits = component(values, n_values, place).map(f64::to_bits);
    bits.next().is_none_or(|first| bits.all(|other| other == first))
}

/// How far outside a tetrahedron, in its coordinates, its field is taken to go on.
const MAX_OUTSIDE: f64 = 0.1;

/// What is around a fusion.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a> {
    pub mesh: &'a Tetrahedra,
    pub jumps: &'a Jumps,
    pub around: &'a Neighbourhood,
}

impl Surroundings<'_> {
    /// The vertices of the tetrahedron before a fusion that holds `p`, or that it is least outside
    /// of, with its coordinates there.
    fn tetrahedron_at(&self, p: Vector) -> Option<([u32; 4], [f64; 4])> {
        let affected = self.around.affected.iter().map(|affected| affected.slot);
        let slots = self.around.deleted.iter().copied().chain(affected);
        let mut best = None;
        let mut best_inside = f64::NEG_INFINITY;
        for slot in slots {
            let Some(corners) = self.mesh.get(slot) else { continue };
            let Some(weights) = barycentric(p, corners.map(|v| self.mesh.position(v))) else { continue };
            let inside = weights.iter().copied().fold(f64::INFINITY, f64::min);
            if inside > best_inside {
                (best_inside, best) = (inside, Some((self.jumps.vertices(slot, corners), weights)));
            }
            if inside >= 0.0 {
                break;
            }
        }
        best
    }

    /// The vertices of the new tetrahedron that `x` lies in, or that it is least outside of, with
    /// its coordinates there, made positive where that is far. The fusion point at `p` has the
    /// vertex `new`; tetrahedra beyond a jump have another one there.
    fn cone_at(&self, p: Vector, x: Vector, new: u32) -> Option<([u32; 4], [f64; 4])> {
        let ray = sub(x, p);
        let mut best = None;
        let mut best_inside = f64::NEG_INFINITY;
        for affected in &self.around.affected {
            let [a, b, c] = affected.base.map(|v| sub(self.mesh.position(v), p));
            let across = cross(b, c);
            let volume = dot(a, across);
            let u = dot(ray, across) / volume;
            // Most are refused by the first of three coordinates; a base seen edge-on gives no
            // number.
            if u.is_nan() || u <= best_inside {
                continue;
            }
            let [v, w] = [dot(ray, cross(c, a)) / volume, dot(ray, cross(a, b)) / volume];
            let inside = u.min(v).min(w).min(1.0 - u - v - w);
            if inside > best_inside
                && let Some(corners) = self.vertices_of(affected, new)
            {
                (best_inside, best) = (inside, Some((corners, [1.0 - u - v - w, u, v, w])));
                if inside >= 0.0 {
                    break;
                }
            }
        }
        // A little outside, by rounding or where the boundary has moved inwards, the field goes on
        // as it is.
        let (corners, weights) = best?;
        if best_inside > -MAX_OUTSIDE {
            return Some((corners, weights));
        }
        let positive = weights.map(|weight: f64| weight.max(0.0));
        let sum: f64 = positive.iter().sum();
        Some((corners, positive.map(|weight| weight / sum)))
    }

    /// The vertex `new` and those of the base of an affected tetrahedron; `None` if it has another
    /// vertex at the fusion point.
    fn vertices_of(&self, affected: &Affected, new: u32) -> Option<[u32; 4]> {
        let [a, b, c] = affected.base;
        if self.jumps.is_empty() {
            return Some([new, a, b, c]);
        }
        let corners = self.mesh.get(affected.slot)?;
        let vertices = self.jumps.vertices(affected.slot, corners);
        let vertex = |point: u32| corners.iter().position(|&corner| corner == point).map(|at| vertices[at]);
        (vertices[affected.corner] == new).then_some([new, vertex(a)?, vertex(b)?, vertex(c)?])
    }
}
