//! A plate with holes through it.

use super::face::DrilledFace;
use super::{Drilling, HOLE_RADIUS, THICKNESS, band, lattice};
use crate::generate::mesh_of;
use nephrite_formats::TriangleMesh;

/// A closed plate with a through-hole of radius 3 in each of `columns * rows` squares of 10 x 10, 2
/// thick.
///
/// Each hole has `segments` sides, rounded up to a multiple of four. The surface has one handle for
/// every hole and `columns * rows * (4 * segments + 8) + 4 * (columns + rows)` triangles. `columns`
/// and `rows` in `1..=400`, `segments` in `4..=1024`.
pub fn plate(columns: u32, rows: u32, segments: u32) -> TriangleMesh {
    drilled_plate(&Drilling::of_every_square(columns, rows, segments))
}

/// A closed plate of 10 x 10 squares, 2 thick, with through-holes of radius 3 in some of them: one
/// handle for every hole.
pub fn drilled_plate(drilling: &Drilling) -> TriangleMesh {
    let drilling = drilling.clamped();
    let face = DrilledFace::new(drilling, HOLE_RADIUS);
    let n = face.n_vertices();
    let lifted = |v: u32| v + n;
    let at = |height: f64| face.points.iter().map(move |&[x, y]| [x, y, height]);
    let mut positions: Vec<[f64; 3]> = at(0.0).chain(at(THICKNESS)).collect();
    let faces = face.triangles();
    let mut triangles: Vec<[u32; 3]> = faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    triangles.extend(faces.iter().map(|corners| corners.map(lifted)));
    let outline = face.outline();
    let above = outline.iter().copied().map(lifted).collect();
    triangles.extend(band(&[outline, above]));
    for mut rim in face.rims() {
        // The wall faces the axis.
        rim.reverse();
        let mut loops = vec![rim.clone()];
        for ring in 1..drilling.wall_rings {
            let first = u32::try_from(positions.len()).unwrap_or(u32::MAX);
            let height = lattice::step(0.0, THICKNESS, ring, drilling.wall_rings);
            let ends = rim.iter().map(|&v| face.points[v as usize]);
            positions.extend(ends.map(|[x, y]| [x, y, height]));
            loops.push((first..first + drilling.segments).collect());
        }
        loops.push(rim.into_iter().map(lifted).collect());
        triangles.extend(band(&loops));
    }
    mesh_of(&positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::super::PITCH;
    use super::*;
    use crate::generate::topology::Topology;
    use std::f64::consts::TAU;

    fn check(drilling: &Drilling) -> TriangleMesh {
        let mesh = drilled_plate(drilling);
        let topology = Topology::of(&mesh);
        assert_eq!(topology.euler(), 2 - 2 * i64::from(drilling.holes));
        assert!(topology.is_closed() && topology.is_oriented);
        let Drilling { segments, holes, columns, rows, .. } = *drilling;
        let hole = 0.5 * HOLE_RADIUS * HOLE_RADIUS * f64::from(segments) * (TAU / f64::from(segments)).sin();
        let exact = THICKNESS * (PITCH * PITCH * f64::from(columns * rows) - f64::from(holes) * hole);
        let volume = Topology::volume(&mesh);
        assert!((volume / exact - 1.0).abs() < 1e-5, "{volume} for {exact}");
        mesh
    }

    #[test]
    fn has_a_handle_for_every_hole() {
        for (columns, rows, segments) in [(1, 1, 4), (3, 2, 32), (5, 4, 12)] {
            let mesh = check(&Drilling::of_every_square(columns, rows, segments));
            let n_holes = columns * rows;
            let n = n_holes * (4 * segments + 8) + 4 * (columns + rows);
            assert_eq!(mesh.triangles.len(), n as usize, "{columns} x {rows} holes of {segments} segments");
        }
    }

    #[test]
    fn has_as_many_triangles_as_the_papers() {
        assert_eq!(check(&Drilling::PLATE).triangles.len(), 2624);
        assert_eq!(check(&Drilling::WASHER).triangles.len(), 1000);
    }

    #[test]
    fn no_triangle_of_a_face_is_turned_over() {
        for (segments, pieces, face_rings) in [(4, 1, 1), (4, 24, 1), (64, 1, 6), (28, 7, 2), (12, 5, 3)] {
            let drilling = Drilling { segments, pieces, face_rings, ..Drilling::PLATE };
            let mesh = check(&drilling);
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
                let twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                let is_flat = a[2].to_bits() == b[2].to_bits() && b[2].to_bits() == c[2].to_bits();
                assert!(!is_flat || twice_area * (a[2] - 1.0) > 0.0, "{triangle:?} of {drilling:?}");
            }
        }
    }

    #[test]
    fn segments_are_rounded_up_to_quarters() {
        assert_eq!(plate(1, 1, 5), plate(1, 1, 8));
    }
}
