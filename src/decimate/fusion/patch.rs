//! The boundary under a fusion: which faces replace which, how far apart they are, and whether the
//! new ones are inside.
//!
//! Boundary vertices that are fused take their boundary faces with them, a disk `B` with the closed
//! rim `R`. The new faces are the cone `B'` from the fusion point over `R`. Both are projected
//! along one direction, in which both must be without folds. Then each vertical line that meets one
//! meets the other, once, so the largest vertical distance between them bounds the Hausdorff
//! distance both ways. That distance is linear between the places where an edge of one lies over a
//! vertex or an edge of the other, so only these few places are examined.
//!
//! `B'` may nowhere be above `B`: the new boundary is on the old one or inside it. So the mesh
//! never leaves its first boundary, and never pierces itself, because the inside of the old mesh
//! near `B` belongs to the tetrahedra of the fusion. `docs/proof.md` has the argument in full.

use super::neighbourhood::Neighbourhood;
use crate::geometry::vector::{Vector, add_scaled, cross, dot, length, scale, sub};
use crate::mesh::Tetrahedra;

/// Least cosine between a face of the boundary and the direction in which a patch is seen.
const MIN_COSINE: f64 = 0.05;

/// A boundary patch projected along its mean normal, in coordinates of the plane and a height.
#[derive(Clone, Debug, Default)]
pub(super) struct Patch {
    origin: Vector,
    axes: [Vector; 3],
    rim: Vec<u32>,
    rim_points: Vec<Vector>,
    /// Old faces.
    faces: Vec<[Vector; 3]>,
    /// Fused vertices.
    inner: Vec<Vector>,
    /// Old edges with an end among the fused vertices.
    edges: Vec<[Vector; 2]>,
    edge_ids: Vec<[u32; 2]>,
}

/// How a fusion point fits a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// Largest vertical distance between the old and the new patch, in mesh units.
    pub distance: f64,
    /// How far the new patch is above the old one at most.
    pub outside: f64,
}

impl Patch {
    /// Takes the boundary faces of a neighbourhood around the boundary vertices `members`. False if
    /// they are not a disk that can be projected without folds.
    pub(super) fn fill(&mut self, mesh: &Tetrahedra, neighbourhood: &Neighbourhood, members: &[u32]) -> bool {
        let faces = &neighbourhood.faces;
        if !self.find_rim(faces, members) || faces.len() + 2 != 2 * members.len() + self.rim.len() {
            return false;
        }
        let normal = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| mesh.position(v));
            cross(sub(b, a), sub(c, a))
        };
        let sum = faces.iter().map(normal).fold([0.0; 3], |sum, n| add_scaled(sum, 1.0, n));
        let size = length(sum);
        if size == 0.0 {
            return false;
        }
        let up = scale(sum, 1.0 / size);
        if !faces.iter().map(normal).all(|n| dot(n, up) > MIN_COSINE * length(n)) {
            return false;
        }
        self.origin = mesh.position(members[0]);
        self.axes = frame(up);
        self.project(mesh, faces, members);
        true
    }

    /// The closed rim of the faces, from the edges opposite to the only fused corner of a face.
    fn find_rim(&mut self, faces: &[[u32; 3]], members: &[u32]) -> bool {
        self.edge_ids.clear();
        for &[_, b, c] in faces {
            if !members.contains(&b) && !members.contains(&c) {
                self.edge_ids.push([b, c]);
            }
        }
        self.rim.clear();
        let Some(&[first, mut last]) = self.edge_ids.first() else { return false };
        self.rim.push(first);
        while last != first {
            let mut next = self.edge_ids.iter().filter(|edge| edge[0] == last);
            let (Some(edge), None) = (next.next(), next.next()) else { return false };
            if self.rim.len() >= self.edge_ids.len() {
                return false;
            }
            self.rim.push(last);
            last = edge[1];
        }
        self.rim.len() == self.edge_ids.len()
    }

    fn project(&mut self, mesh: &Tetrahedra, faces: &[[u32; 3]], members: &[u32]) {
        let local = |v: u32| local(mesh.position(v), self.origin, &self.axes);
        self.rim_points.clear();
        self.rim_points.extend(self.rim.iter().map(|&v| local(v)));
        self.inner.clear();
        self.inner.extend(members.iter().map(|&v| local(v)));
        self.faces.clear();
        self.faces.extend(faces.iter().map(|face| face.map(local)));
        self.edges.clear();
        for &[a, b, c] in faces {
            // Every edge between a fused vertex and another is in two faces, in either direction;
            // keep one.
            for [p, q] in [[a, b], [b, c], [c, a]] {
                let is_inner = [p, q].map(|v| members.contains(&v));
                if is_inner == [true, false] || (is_inner == [true, true] && p < q) {
                    self.edges.push([local(p), local(q)]);
                }
            }
        }
    }

    /// A point over the same place of the plane as `p`, as high as possible without the new patch
    /// rising above the old one anywhere.
    pub(super) fn highest_inside(&self, p: Vector) -> Vector {
        let p = local(p, self.origin, &self.axes);
        let mut height = f64::INFINITY;
        self.for_each_gap(p, |above_rim, weight| {
            if weight > 1e-9 {
                height = height.min(above_rim / weight);
            }
        });
        let height = if height.is_finite() { height } else { p[2] };
        let [u, v, up] = self.axes;
        add_scaled(add_scaled(add_scaled(self.origin, p[0], u), p[1], v), height, up)
    }

    /// How well the cone from `p` replaces the patch; `None` if the cone has folds or too steep
    /// slopes.
    pub(super) fn fit(&self, p: Vector) -> Option<Fit> {
        let p = local(p, self.origin, &self.axes);
        let mut n_turns = 0;
        for (i, &q) in self.rim_points.iter().enumerate() {
            let r = self.rim_points[(i + 1) % self.rim_points.len()];
            let normal = cross(sub(q, p), sub(r, p));
            if normal[2] <= MIN_COSINE * length(normal) {
                return None;
            }
            n_turns += u32::from(q[1] <= p[1] && r[1] > p[1]);
        }
        if n_turns != 1 {
            return None;
        }
        let mut fit = Fit { distance: 0.0, outside: 0.0 };
        self.for_each_gap(p, |above_rim, weight| {
            let gap = above_rim - weight * p[2];
            fit.distance = fit.distance.max(gap.abs());
            fit.outside = fit.outside.max(-gap);
        });
        Some(fit)
    }

    /// The places where the distance between the patches can be largest. For each: the height of
    /// the old patch above the part of the new height that the rim determines, and the weight of
    /// the height of `p` in the new height.
    fn for_each_gap(&self, p: Vector, mut gap: impl FnMut(f64, f64)) {
        let n = self.rim_points.len();
        for &inner in &self.inner {
            let cones = (0..n).map(|i| [p, self.rim_points[i], self.rim_points[(i + 1) % n]]);
            if let Some((weights, [_, q, r])) = most_inside(inner, cones) {
                gap(inner[2] - weights[1] * q[2] - weights[2] * r[2], weights[0]);
            }
        }
        if let Some((weights, face)) = most_inside(p, self.faces.iter().copied()) {
            gap((0..3).map(|i| weights[i] * face[i][2]).sum(), 1.0);
        }
        for &[a, b] in &self.edges {
            for &rim in &self.rim_points {
                if let Some([along_old, along_new]) = crossing([a, b], [p, rim]) {
                    let height = a[2] + along_old * (b[2] - a[2]);
                    gap(height - along_new * rim[2], 1.0 - along_new);
                }
            }
        }
    }
}

/// Coordinates in a frame.
#[inline(always)]
fn local(point: Vector, origin: Vector, axes: &[Vector; 3]) -> Vector {
    let from_origin = sub(point, origin);
    axes.map(|axis| dot(from_origin, axis))
}

/// Two axes beside a unit vector, right-handed.
fn frame(up: Vector) -> [Vector; 3] {
    let least = (0..3).min_by(|&i, &j| up[i].abs().total_cmp(&up[j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let u = cross(other, up);
    let u = scale(u, 1.0 / length(u));
    [u, cross(up, u), up]
}

/// Barycentric coordinates in the plane with respect to the triangle that contains a point best.
fn most_inside(
    point: Vector,
    triangles: impl Iterator<Item = [Vector; 3]>,
) -> Option<([f64; 3], [Vector; 3])> {
    let mut best = None;
    let mut best_inside = f64::NEG_INFINITY;
    for [a, b, c] in triangles {
        let area = turn(a, b, c);
        if area <= 0.0 {
            continue;
        }
        let weights = [turn(point, b, c) / area, turn(a, point, c) / area, turn(a, b, point) / area];
        let inside = weights[0].min(weights[1]).min(weights[2]);
        if inside > best_inside {
            best_inside = inside;
            best = Some((weights, [a, b, c]));
        }
        if inside >= 0.0 {
            break;
        }
    }
    best
}

/// Twice the area of a triangle in the plane.
#[inline(always)]
fn turn(a: Vector, b: Vector, c: Vector) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Where two segments cross in the plane, as parts of their lengths; `None` if they do not cross,
/// or only at an end.
fn crossing([a, b]: [Vector; 2], [p, q]: [Vector; 2]) -> Option<[f64; 2]> {
    let (from_p, from_q) = (turn(a, b, p), turn(a, b, q));
    if (from_p > 0.0) == (from_q > 0.0) {
        return None;
    }
    let (from_a, from_b) = (turn(p, q, a), turn(p, q, b));
    if (from_a > 0.0) == (from_b > 0.0) {
        return None;
    }
    let (across_old, across_new) = (from_a - from_b, from_p - from_q);
    (across_old != 0.0 && across_new != 0.0).then(|| [from_a / across_old, from_p / across_new])
}
