//! A flat face: squares in columns and rows, some of them with a round hole.

use std::f64::consts::TAU;

use super::{Drilling, PITCH, lattice};
use crate::flat::NO_INDEX;

/// Largest radius of the rings around a hole: they end inside the square.
const OUTERMOST_RADIUS: f64 = 4.5;

/// Vertices of a face and their positions: first those on the borders of squares, then those
/// inside, square by square.
pub(super) struct DrilledFace {
    drilling: Drilling,
    /// Position of every vertex.
    pub(super) points: Vec<[f64; 2]>,
    /// Vertex at each lattice point, `columns * pieces + 1` in a row.
    lattice: Vec<u32>,
    /// First vertex inside each square: of the innermost ring around its hole, or its centre.
    inside: Vec<u32>,
}

impl DrilledFace {
    /// The face of a drilling, whose counts are in their ranges, with holes of radius
    /// `hole_radius`.
    pub(super) fn new(drilling: Drilling, hole_radius: f64) -> Self {
        let mut face = Self { drilling, points: Vec::new(), lattice: Vec::new(), inside: Vec::new() };
        let Drilling { columns, rows, pieces, segments, face_rings, .. } = drilling;
        for y in 0..=rows * pieces {
            for x in 0..=columns * pieces {
                let is_border = x.is_multiple_of(pieces) || y.is_multiple_of(pieces);
                let vertex = if is_border { face.n_vertices() } else { NO_INDEX };
                face.lattice.push(vertex);
                if is_border {
                    face.points.push([x, y].map(|at| f64::from(at) * PITCH / f64::from(pieces)));
                }
            }
        }
        for square in 0..drilling.n_squares() {
            face.inside.push(face.n_vertices());
            let [x, y] = [square % columns, square / columns].map(|at| (f64::from(at) + 0.5) * PITCH);
            if !drilling.is_drilled(square) {
                face.points.push([x, y]);
                continue;
            }
            for ring in 0..face_rings {
                let radius = lattice::step(hole_radius, OUTERMOST_RADIUS, ring, face_rings);
                for segment in 0..segments {
                    // The first vertex is towards the lower left corner, like the first vertex on
                    // the border of the square.
                    let (sin, cos) = lattice::step(-0.375 * TAU, 0.625 * TAU, segment, segments).sin_cos();
                    face.points.push([x + radius * cos, y + radius * sin]);
                }
            }
        }
        face
    }

    /// Number of vertices.
    pub(super) fn n_vertices(&self) -> u32 {
        u32::try_from(self.points.len()).unwrap_or(u32::MAX)
    }

    /// Triangles, counter-clockwise.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for square in 0..self.drilling.n_squares() {
            let border = self.border(square);
            if !self.drilling.is_drilled(square) {
                let center = self.inside[square as usize];
                let n = border.len();
                triangles.extend((0..n).map(|i| [center, border[i], border[(i + 1) % n]]));
                continue;
            }
            let rings: Vec<Vec<u32>> =
                (0..self.drilling.face_rings).map(|ring| self.ring(square, ring)).collect();
            // Seen from above, a ring runs to the right if one looks outwards: outer rings are the
            // lower ones.
            let inwards: Vec<Vec<u32>> = rings.iter().rev().cloned().collect();
            triangles.extend(super::band(&inwards));
            rings.last().into_iter().for_each(|ring| stitch(ring, &border, &mut triangles));
        }
        triangles
    }

    /// Rims of all holes, counter-clockwise.
    pub(super) fn rims(&self) -> impl Iterator<Item = Vec<u32>> + '_ {
        let squares = (0..self.drilling.n_squares()).filter(|&square| self.drilling.is_drilled(square));
        squares.map(|square| self.ring(square, 0))
    }

    /// The outer border, counter-clockwise.
    pub(super) fn outline(&self) -> Vec<u32> {
        let Drilling { columns, rows, pieces, .. } = self.drilling;
        self.rectangle([0, 0], [columns * pieces, rows * pieces])
    }

    /// A ring around the hole of `square`, counter-clockwise; ring 0 is its rim.
    fn ring(&self, square: u32, ring: u32) -> Vec<u32> {
        let start = self.inside[square as usize] + ring * self.drilling.segments;
        (start..start + self.drilling.segments).collect()
    }

    /// Vertices around `square`, counter-clockwise from the lower left corner.
    fn border(&self, square: u32) -> Vec<u32> {
        let Drilling { columns, pieces, .. } = self.drilling;
        self.rectangle([square % columns * pieces, square / columns * pieces], [pieces; 2])
    }

    /// Vertices around a rectangle of the lattice, counter-clockwise from its lower left corner.
    fn rectangle(&self, [left, low]: [u32; 2], [width, height]: [u32; 2]) -> Vec<u32> {
        let at = |x: u32, y: u32| {
            let in_row = self.drilling.columns * self.drilling.pieces + 1;
            self.lattice[(y * in_row + x) as usize]
        };
        let (right, high) = (left + width, low + height);
        let along = (left..right).map(|x| at(x, low)).chain((low..high).map(|y| at(right, y)));
        let back = (0..width).map(|i| at(right - i, high)).chain((0..height).map(|i| at(left, high - i)));
        along.chain(back).collect()
    }
}

/// Fills the gap between two closed loops of different counts that begin at the same corner, in
/// their order.
fn stitch(inner: &[u32], outer: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let [n_inner, n_outer] = [inner, outer].map(<[u32]>::len);
    let (mut i, mut o) = (0, 0);
    while i < n_inner || o < n_outer {
        let (here, there) = (inner[i % n_inner], outer[o % n_outer]);
        // The loop that has covered the smaller part of its length advances; comparing half a step
        // ahead keeps the triangles upright.
        if o == n_outer || (i < n_inner && (2 * i + 1) * n_outer <= (2 * o + 1) * n_inner) {
            triangles.push([here, there, inner[(i + 1) % n_inner]]);
            i += 1;
        } else {
            triangles.push([here, there, outer[(o + 1) % n_outer]]);
            o += 1;
        }
    }
}
