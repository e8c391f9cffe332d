//! The planar quadric error metric (equations 1 to 5 of the paper), generalised to fields.
//!
//! A vertex carries the sum of `a^2 p p^T` over the planes `p` of the triangles around it, `a`
//! their areas. With `n` the cross product of two sides, the plane with weight is `(n, -n v) / 2`:
//! no root and no division. Every tetrahedron contributes its own faces, so that those inside the
//! mesh count twice; those on the boundary count [`BOUNDARY_WEIGHT`] times.
//!
//! A field is linear in a tetrahedron, `f(x) = g x + d`. Carried by the vertices as well, the sum
//! of `w (g x + d - f)^2` over the tetrahedra measures how far a value `f` at `x` departs from
//! them, in the same unit when the field is scaled to lengths and `w` is a sum of squared areas. It
//! is the mean one of all tetrahedra, not the own one: where a simulation has much to tell its
//! cells are small, and with their own areas all that they resolve would be fused first. The least
//! value over `f` is a quadric in `x` alone, which is added to the planes': the point that is best
//! for the shape and all fields solves one system of three equations.
//!
//! References: P. Chopra, J. Meyer: "Topology sensitive volume mesh simplification with planar
//! quadric error metrics" (IASTED VIIP, 2003); H. Hoppe: "New quadric metric for simplifying meshes
//! with appearance attributes" (IEEE Visualization, 1999).

use super::jumps::Jumps;
use crate::geometry::vector::{Vector, add_scaled, cross, dot, sub};
use crate::mesh::{FACES, Tetrahedra};

/// Weight of a boundary face beside one inside the mesh.
const BOUNDARY_WEIGHT: f64 = 100.0;

/// A quadric in space: `x^T A x + 2 b x + c`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Quadric {
    /// `A` by rows from the diagonal on: xx, xy, xz, yy, yz, zz.
    pub a: [f64; 6],
    pub b: Vector,
    pub c: f64,
}

impl Quadric {
    /// `weight (n x + d)^2`.
    fn plane(n: Vector, d: f64, weight: f64) -> Self {
        let [x, y, z] = n;
        let a = [x * x, x * y, x * z, y * y, y * z, z * z].map(|value| weight * value);
        Self { a, b: n.map(|value| weight * d * value), c: weight * d * d }
    }

    fn add(&mut self, other: &Self) {
        self.a.iter_mut().zip(other.a).for_each(|(sum, value)| *sum += value);
        self.b.iter_mut().zip(other.b).for_each(|(sum, value)| *sum += value);
        self.c += other.c;
    }

    /// Its value at a point; rounding may make it negative where it is zero.
    pub(super) fn at(&self, [x, y, z]: Vector) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let square = x * (xx * x + 2.0 * (xy * y + xz * z)) + y * (yy * y + 2.0 * yz * z) + zz * z * z;
        square + 2.0 * dot(self.b, [x, y, z]) + self.c
    }
}

/// Quadrics of all vertices, and of what the fields add.
#[derive(Clone, Debug)]
pub(super) struct Metric {
    /// Numbers per vertex: 10 of the quadric, then, where there are fields, the sum of the weights
    /// and for each field those of `w g` and `w d`.
    stride: usize,
    n_fields: usize,
    numbers: Vec<f64>,
    /// The row of each vertex in `numbers`. A fusion point has that of a fused vertex, whose
    /// numbers nobody asks for again.
    rows: Vec<u32>,
    /// `w` of every tetrahedron that has a volume.
    field_weight: f64,
    /// Subtracted from every position, against cancellation.
    centre: Vector,
}

impl Metric {
    /// The metric of a mesh. `fields` has `n_fields` values per vertex, scaled to lengths. O(n).
    pub(super) fn new(
        mesh: &Tetrahedra,
        jumps: &Jumps,
        centre: Vector,
        (n_fields, fields): (usize, &[f64]),
    ) -> Self {
        let stride = if n_fields == 0 { 10 } else { 11 + 4 * n_fields };
        let numbers = vec![0.0; stride * mesh.n_vertices()];
        #[expect(clippy::cast_possible_truncation, reason = "vertices are counted in u32")]
        let rows = (0..mesh.n_vertices() as u32).collect();
        let squared_areas: f64 = mesh.iter().map(|(_, corners)| squared_areas(mesh, corners)).sum();
        let field_weight = squared_areas / mesh.n_alive().max(1) as f64;
        let mut metric = Self { stride, n_fields, numbers, rows, field_weight, centre };
        for (slot, corners) in mesh.iter() {
            metric.add_tetrahedron(mesh, slot, jumps.vertices(slot, corners), fields);
        }
        metric
    }

    fn add_tetrahedron(&mut self, mesh: &Tetrahedra, slot: u32, corners: [u32; 4], fields: &[f64]) {
        let points = corners.map(|v| sub(mesh.position(v), self.centre));
        let normals = FACES.map(|[i, j, k]| {
            let (p, q, r) = (points[i], points[j], points[k]);
            cross(sub(q, p), sub(r, p))
        });
        let bits = mesh.boundary_bits(slot);
        let mut planes = [Quadric::default(); 4];
        let mut sum = Quadric::default();
        for (i, plane) in planes.iter_mut().enumerate() {
            let weight = if bits >> i & 1 == 1 { 2.0 * BOUNDARY_WEIGHT } else { 1.0 };
            *plane = Quadric::plane(normals[i], -dot(normals[i], points[FACES[i][0]]), 0.25 * weight);
            sum.add(plane);
        }
        // Normals point outwards; the one opposite a corner is -6V times the gradient of its
        // coordinate.
        let six_volumes = -dot(normals[0], sub(points[0], points[1]));
        let gradients = normals.map(|normal| normal.map(|x| -x / six_volumes));
        let weight = if six_volumes.abs() > 0.0 { self.field_weight } else { 0.0 };
        for (i, &v) in corners.iter().enumerate() {
            let has_fields = self.n_fields > 0;
            let numbers = self.row_mut(v);
            for (number, (all, own)) in numbers.iter_mut().zip(sum.numbers().zip(planes[i].numbers())) {
                *number += all - own;
            }
            if has_fields && weight > 0.0 {
                numbers[10] += weight;
            }
        }
        if weight > 0.0 {
            self.add_fields(corners, &points, &gradients, weight, fields);
        }
    }

    fn add_fields(
        &mut self,
        corners: [u32; 4],
        points: &[Vector; 4],
        gradients: &[Vector; 4],
        weight: f64,
        fields: &[f64],
    ) {
        let n = self.n_fields;
        for field in 0..n {
            let values = corners.map(|v| fields[v as usize * n + field]);
            // Differences from one corner: a constant field has no gradient at all.
            let gradient =
                (1..4).fold([0.0; 3], |sum, i| add_scaled(sum, values[i] - values[0], gradients[i]));
            let offset = values[0] - dot(gradient, points[0]);
            let quadric = Quadric::plane(gradient, offset, weight);
            for &v in &corners {
                let numbers = self.row_mut(v);
                numbers.iter_mut().zip(quadric.numbers()).for_each(|(number, value)| *number += value);
                let sums = &mut numbers[11 + 4 * field..][..4];
                (0..3).for_each(|axis| sums[axis] += weight * gradient[axis]);
                sums[3] += weight * offset;
            }
        }
    }

    /// Components of fields that it weighs.
    pub(super) fn n_fields(&self) -> usize {
        self.n_fields
    }

    /// The quadric of a fusion of these vertices, best values of the fields taken for granted.
    pub(super) fn of(&self, vertices: &[u32]) -> Quadric {
        let rows = |v: &u32| self.row(*v);
        let mut sum = [0.0; 11];
        let n_shared = self.stride.min(11);
        for row in vertices.iter().map(rows) {
            sum[..n_shared].iter_mut().zip(row).for_each(|(sum, value)| *sum += value);
        }
        let mut quadric = Quadric::from_numbers(&sum);
        if self.n_fields > 0 && sum[10] > 0.0 {
            for field in 0..self.n_fields {
                let mut sums = [0.0; 4];
                for row in vertices.iter().map(rows) {
                    (0..4).for_each(|i| sums[i] += row[11 + 4 * field + i]);
                }
                let [x, y, z, d] = sums;
                quadric.add(&Quadric::plane([x, y, z], d, -1.0 / sum[10]));
            }
        }
        quadric
    }

    /// The scaled value of a field that is best for a fusion of these vertices at a point of the
    /// quadrics' coordinates: the mean of what the field's pieces around them say there. `None`
    /// where none of them has a volume, and for a field that is not weighed.
    pub(super) fn best_value(&self, vertices: &[u32], field: usize, p: Vector) -> Option<f64> {
        if field >= self.n_fields {
            return None;
        }
        let mut weight = 0.0;
        let mut sum = 0.0;
        for &v in vertices {
            let row = self.row(v);
            let [x, y, z, d] = std::array::from_fn(|i| row[11 + 4 * field + i]);
            weight += self.weight(v);
            sum += dot([x, y, z], p) + d;
        }
        (weight > 0.0).then(|| sum / weight)
    }

    /// What a fusion of these vertices at `p` costs beyond its quadric where the fields do not take
    /// their best values there, but the given ones, scaled.
    pub(super) fn departure(&self, vertices: &[u32], p: Vector, value: impl Fn(usize) -> f64) -> f64 {
        let weight: f64 = vertices.iter().map(|&v| self.weight(v)).sum();
        let departure = |field| self.best_value(vertices, field, p).map_or(0.0, |best| value(field) - best);
        (0..self.n_fields).map(|field| weight * departure(field).powi(2)).sum()
    }

    /// Sum of the weights of the tetrahedra that a vertex stands for.
    fn weight(&self, v: u32) -> f64 {
        if self.n_fields == 0 { 0.0 } else { self.row(v)[10] }
    }

    /// Adds a vertex that takes the place of others: the sum of theirs, in the row of the first.
    pub(super) fn add_vertex(&mut self, replaced: &[u32]) {
        let Some((&first, others)) = replaced.split_first() else { return };
        let stride = self.stride;
        let sum = self.rows[first as usize];
        let start = sum as usize * stride;
        for &v in others {
            let row = self.rows[v as usize] as usize * stride;
            for i in 0..stride {
                self.numbers[start + i] += self.numbers[row + i];
            }
        }
        self.rows.push(sum);
    }

    #[inline(always)]
    fn row(&self, v: u32) -> &[f64] {
        &self.numbers[self.rows[v as usize] as usize * self.stride..][..self.stride]
    }

    fn row_mut(&mut self, v: u32) -> &mut [f64] {
        &mut self.numbers[self.rows[v as usize] as usize * self.stride..][..self.stride]
    }

    /// A point in the coordinates of the quadrics.
    pub(super) fn local(&self, point: Vector) -> Vector {
        sub(point, self.centre)
    }

    /// A point of the quadrics' coordinates in those of the mesh.
    pub(super) fn global(&self, point: Vector) -> Vector {
        add_scaled(point, 1.0, self.centre)
    }
}

impl Quadric {
    fn numbers(&self) -> impl Iterator<Item = f64> {
        self.a.into_iter().chain(self.b).chain([self.c])
    }

    fn from_numbers(numbers: &[f64; 11]) -> Self {
        let [xx, xy, xz, yy, yz, zz, x, y, z, c, _] = *numbers;
        Self { a: [xx, xy, xz, yy, yz, zz], b: [x, y, z], c }
    }
}

/// Sum of the squared areas of a tetrahedron's faces.
fn squared_areas(mesh: &Tetrahedra, corners: [u32; 4]) -> f64 {
    let points = corners.map(|v| mesh.position(v));
    let squared = FACES.map(|[i, j, k]| {
        let normal = cross(sub(points[j], points[i]), sub(points[k], points[i]));
        0.25 * dot(normal, normal)
    });
    squared.into_iter().sum()
}
