//! Two tube sheets and the tubes between them.

use super::face::DrilledFace;
use super::{Drilling, HOLE_RADIUS, THICKNESS, band};
use crate::generate::mesh_of;
use nephrite_formats::TriangleMesh;

/// Inner radius of a tube.
const BORE_RADIUS: f64 = 2.4;
/// Distance between the outer faces of the two sheets.
const LENGTH: f64 = 120.0;

/// A closed heat exchanger: two plates of `columns * rows` squares of 10 x 10, 2 thick, with 120
/// between their outer faces. A tube of radii 2.4 and 3 joins each square of one plate to that of
/// the other.
///
/// Each tube has `segments` sides, rounded up to a multiple of four, and opens through both plates.
/// The surface has `2 * columns * rows - 1` handles and `4 * columns * rows * (2 * segments + 4) +
/// 8 * (columns + rows)` triangles. `columns` and `rows` in `1..=400`, `segments` in `4..=1024`.
pub fn heat_exchanger(columns: u32, rows: u32, segments: u32) -> TriangleMesh {
    let drilling = Drilling::of_every_square(columns, rows, segments).clamped();
    // An outer face shows the bores, an inner one the tubes.
    let [bores, tubes] = [BORE_RADIUS, HOLE_RADIUS].map(|radius| DrilledFace::new(drilling, radius));
    let layers = [(&bores, 0.0), (&tubes, THICKNESS), (&tubes, LENGTH - THICKNESS), (&bores, LENGTH)];
    let positions: Vec<[f64; 3]> = layers
        .iter()
        .flat_map(|&(face, height)| face.points.iter().map(move |&[x, y]| [x, y, height]))
        .collect();
    let n = bores.n_vertices();
    let in_layer =
        |vertices: &[u32], layer: u32| vertices.iter().map(|v| v + layer * n).collect::<Vec<u32>>();
    let mut triangles = Vec::new();
    for (layer, (face, _)) in (0..).zip(layers) {
        let looks_up = layer % 2 == 1;
        let turned = |[a, b, c]: [u32; 3]| if looks_up { [a, b, c] } else { [a, c, b] };
        triangles.extend(face.triangles().into_iter().map(|corners| turned(corners.map(|v| v + layer * n))));
    }
    let outline = bores.outline();
    for [low, high] in [[0, 1], [2, 3]] {
        triangles.extend(band(&[low, high].map(|layer| in_layer(&outline, layer))));
    }
    for mut rim in bores.rims() {
        triangles.extend(band(&[1, 2].map(|layer| in_layer(&rim, layer))));
        rim.reverse();
        triangles.extend(band(&[0, 3].map(|layer| in_layer(&rim, layer))));
    }
    mesh_of(&positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::super::PITCH;
    use super::*;
    use crate::generate::topology::Topology;
    use std::f64::consts::TAU;

    #[test]
    fn is_closed_with_two_handles_for_each_tube_but_one() {
        for (columns, rows, segments) in [(1, 1, 4), (3, 2, 12), (15, 5, 16)] {
            let mesh = heat_exchanger(columns, rows, segments);
            let n_tubes = columns * rows;
            let topology = Topology::of(&mesh);
            assert_eq!(topology.euler(), 2 - 2 * (2 * i64::from(n_tubes) - 1));
            assert!(topology.is_closed() && topology.is_oriented);
            let n = 4 * n_tubes * (2 * segments + 4) + 8 * (columns + rows);
            assert_eq!(mesh.triangles.len(), n as usize);
            let disk =
                |radius: f64| 0.5 * radius * radius * f64::from(segments) * (TAU / f64::from(segments)).sin();
            let sheets = 2.0 * THICKNESS * (PITCH * PITCH - disk(BORE_RADIUS));
            let tube = (LENGTH - 2.0 * THICKNESS) * (disk(HOLE_RADIUS) - disk(BORE_RADIUS));
            let exact = f64::from(n_tubes) * (sheets + tube);
            let volume = Topology::volume(&mesh);
            assert!((volume / exact - 1.0).abs() < 1e-5, "{volume} for {exact}");
        }
    }
}
