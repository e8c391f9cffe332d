//! A Moebius strip: one side, one boundary, no consistent orientation.

use std::f64::consts::TAU;

use nephrite_formats::TriangleMesh;

use super::{MAX_COUNT, lattice, mesh_of};

/// Half the width of the strip.
const HALF_WIDTH: f64 = 0.4;

/// A Moebius strip of width 0.8 around the unit circle, `segments` cells long and `rows` cells
/// wide.
///
/// `2 * segments * rows` triangles; `segments` in `5..=MAX_COUNT`, `rows` in `1..=MAX_COUNT - 1`.
/// Neighbouring triangles have the same orientation except across the edges at which the last
/// column meets the first.
pub fn moebius(segments: u32, rows: u32) -> TriangleMesh {
    let [segments, rows] = [segments.clamp(5, MAX_COUNT), rows.clamp(1, MAX_COUNT - 1)];
    let mut positions = Vec::with_capacity(segments as usize * (rows as usize + 1));
    for segment in 0..segments {
        let angle = lattice::step(0.0, TAU, segment, segments);
        let ((sin, cos), (half_sin, half_cos)) = (angle.sin_cos(), (0.5 * angle).sin_cos());
        for row in 0..=rows {
            let offset = lattice::step(-HALF_WIDTH, HALF_WIDTH, row, rows);
            let radius = 1.0 + offset * half_cos;
            positions.push([radius * cos, radius * sin, offset * half_sin]);
        }
    }
    let vertex = |segment: u32, row: u32| {
        // Half a turn later the strip meets its first column upside down.
        let (segment, row) = if segment == segments { (0, rows - row) } else { (segment, row) };
        segment * (rows + 1) + row
    };
    mesh_of(&positions, lattice::triangles(segments, rows, vertex))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn has_one_boundary_and_no_orientation() {
        for (segments, rows) in [(5, 1), (60, 8)] {
            let mesh = moebius(segments, rows);
            let topology = Topology::of(&mesh);
            assert_eq!(mesh.triangles.len(), 2 * (segments * rows) as usize);
            assert_eq!(topology.euler(), 0);
            assert_eq!(topology.n_boundary_edges, 2 * segments as usize);
            assert!(topology.is_manifold && !topology.is_oriented);
        }
    }
}
