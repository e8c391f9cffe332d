//! A drilled plate as a CAD system would export it: large flat faces in long thin triangles, round holes through them.

use std::f64::consts::TAU;

use nephrite_formats::TriangleMesh;

use super::{lattice, mesh_of};

/// Distance between the axes of neighbouring holes, and length of the square that surrounds each.
const PITCH: f64 = 10.0;
/// Radius of a hole.
const HOLE_RADIUS: f64 = 3.0;
/// Thickness of the plate.
const THICKNESS: f64 = 2.0;
/// Largest number of holes along one side.
const MAX_HOLES: u32 = 400;
/// Largest number of segments around a hole.
const MAX_SEGMENTS: u32 = 1024;

/// A closed plate with `columns * rows` through-holes of radius 3, one per 10 x 10 square, 2 thick.
///
/// Each hole has `segments` sides, rounded up to a multiple of four. The surface has one handle for every hole and
/// `columns * rows * (4 * segments + 8) + 4 * (columns + rows)` triangles. `columns` and `rows` in `1..=400`, `segments`
/// in `4..=1024`.
pub fn plate(columns: u32, rows: u32, segments: u32) -> TriangleMesh {
    let plate = Plate {
        columns: columns.clamp(1, MAX_HOLES),
        rows: rows.clamp(1, MAX_HOLES),
        segments: segments.clamp(4, MAX_SEGMENTS).next_multiple_of(4),
    };
    let mut triangles = Vec::new();
    for row in 0..plate.rows {
        for column in 0..plate.columns {
            plate.push_faces(column, row, &mut triangles);
            plate.push_hole(column, row, &mut triangles);
        }
    }
    plate.push_sides(&mut triangles);
    mesh_of(&plate.positions(), triangles)
}

/// Bottom and top layer.
const LAYERS: [u32; 2] = [0, 1];

/// The plate's counts, which name all its vertices: first the corners of the squares, then the rims of the holes.
struct Plate {
    columns: u32,
    rows: u32,
    segments: u32,
}

impl Plate {
    /// The corner of a square, `column` in `0..=columns` and `row` in `0..=rows`.
    fn corner(&self, column: u32, row: u32, layer: u32) -> u32 {
        (layer * (self.rows + 1) + row) * (self.columns + 1) + column
    }

    /// The point `segment` of a hole's rim, counted counter-clockwise from the x direction and modulo `segments`.
    fn rim(&self, [column, row]: [u32; 2], segment: u32, layer: u32) -> u32 {
        let hole = row * self.columns + column;
        2 * (self.columns + 1) * (self.rows + 1)
            + (2 * hole + layer) * self.segments
            + segment % self.segments
    }

    fn positions(&self) -> Vec<[f64; 3]> {
        let mut positions = Vec::new();
        let height = |layer: u32| f64::from(layer) * THICKNESS;
        for layer in LAYERS {
            for row in 0..=self.rows {
                for column in 0..=self.columns {
                    positions.push([f64::from(column) * PITCH, f64::from(row) * PITCH, height(layer)]);
                }
            }
        }
        for row in 0..self.rows {
            for column in 0..self.columns {
                let [x, y] = [column, row].map(|index| (f64::from(index) + 0.5) * PITCH);
                for layer in LAYERS {
                    for segment in 0..self.segments {
                        let (sin, cos) = lattice::step(0.0, TAU, segment, self.segments).sin_cos();
                        positions.push([x + HOLE_RADIUS * cos, y + HOLE_RADIUS * sin, height(layer)]);
                    }
                }
            }
        }
        positions
    }

    /// Top and bottom of one square around its hole: each corner sees a quarter of the rim.
    fn push_faces(&self, column: u32, row: u32, triangles: &mut Vec<[u32; 3]>) {
        let corners = [[column + 1, row + 1], [column, row + 1], [column, row], [column + 1, row]];
        let per_quarter = self.segments / 4;
        for layer in LAYERS {
            let mut push =
                |[a, b, c]: [u32; 3]| triangles.push(if layer == 1 { [a, b, c] } else { [a, c, b] });
            for (quarter, segment) in (0..4).zip((0..).step_by(per_quarter as usize)) {
                let [corner, next_corner] = [quarter, (quarter + 1) % 4]
                    .map(|q: usize| self.corner(corners[q][0], corners[q][1], layer));
                for segment in segment..segment + per_quarter {
                    let [start, end] = [segment, segment + 1].map(|s| self.rim([column, row], s, layer));
                    push([corner, end, start]);
                }
                push([corner, next_corner, self.rim([column, row], segment + per_quarter, layer)]);
            }
        }
    }

    /// The wall of one hole, which looks towards the hole's axis.
    fn push_hole(&self, column: u32, row: u32, triangles: &mut Vec<[u32; 3]>) {
        let vertex = |segment: u32, layer: u32| self.rim([column, row], self.segments - segment, layer);
        triangles.extend(lattice::triangles(self.segments, 1, vertex));
    }

    /// The four sides of the plate.
    fn push_sides(&self, triangles: &mut Vec<[u32; 3]>) {
        let (columns, rows) = (self.columns, self.rows);
        triangles.extend(lattice::triangles(columns, 1, |step, layer| self.corner(step, 0, layer)));
        triangles.extend(lattice::triangles(rows, 1, |step, layer| self.corner(columns, step, layer)));
        triangles
            .extend(lattice::triangles(columns, 1, |step, layer| self.corner(columns - step, rows, layer)));
        triangles.extend(lattice::triangles(rows, 1, |step, layer| self.corner(0, rows - step, layer)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn has_a_handle_for_every_hole() {
        for (columns, rows, segments) in [(1, 1, 4), (3, 2, 32), (5, 4, 12)] {
            let mesh = plate(columns, rows, segments);
            let topology = Topology::of(&mesh);
            let n_holes = columns * rows;
            assert_eq!(topology.euler(), 2 - 2 * i64::from(n_holes));
            assert!(topology.is_closed() && topology.is_oriented);
            assert_eq!(
                mesh.triangles.len(),
                (n_holes * (4 * segments + 8) + 4 * (columns + rows)) as usize,
                "{columns} x {rows} holes of {segments} segments"
            );
            let hole =
                0.5 * HOLE_RADIUS * HOLE_RADIUS * f64::from(segments) * (TAU / f64::from(segments)).sin();
            let exact = f64::from(n_holes) * THICKNESS * (PITCH * PITCH - hole);
            let volume = Topology::volume(&mesh);
            assert!((volume / exact - 1.0).abs() < 1e-5, "{volume} for {exact}");
        }
    }

    #[test]
    fn segments_are_rounded_up_to_quarters() {
        assert_eq!(plate(1, 1, 5), plate(1, 1, 8));
    }
}
