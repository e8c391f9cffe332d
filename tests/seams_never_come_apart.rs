//! Promise: where attributes differ along a seam, both sides keep their own vertices and the
//! surface stays closed. No crack opens, and no triangle takes a vertex from the other side.
//! Normals alone make no seam.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tests on small meshes")]

mod engine;

use engine::{alive_at, build_all, edge_faces, spread_steps};
use nephrite::{Attribute, BuildOptions, ScalarType, TriangleMesh};

const COLUMNS: u32 = 48;
const ROWS: u32 = 24;

/// A tube with a texture around it: the first and the last column of vertices have the same
/// positions.
fn textured_tube() -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let mut coordinates = vec![];
    for row in 0..=ROWS {
        for column in 0..=COLUMNS {
            let angle = (column % COLUMNS) as f32 / COLUMNS as f32 * std::f32::consts::TAU;
            let bulge = 1.0 + 0.2 * (row as f32 * 0.3).sin();
            mesh.positions.push([bulge * angle.cos(), bulge * angle.sin(), row as f32 * 0.1]);
            coordinates.extend([column as f32 / COLUMNS as f32, row as f32 / ROWS as f32]);
        }
    }
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let [a, b] = [row * (COLUMNS + 1) + column, row * (COLUMNS + 1) + column + 1];
            let [c, d] = [a + COLUMNS + 1, b + COLUMNS + 1];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    mesh.attributes.push(attribute("texcoord", 2, &coordinates));
    mesh
}

fn attribute(name: &str, n_components: u32, values: &[f32]) -> Attribute {
    let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    Attribute { name: name.into(), scalar: ScalarType::F32, n_components, bytes }
}

fn is_on_seam(v: u32) -> bool {
    (v % (COLUMNS + 1)).is_multiple_of(COLUMNS)
}

/// The vertex at the position of `v` with texture coordinate 0.
fn place(v: u32) -> u32 {
    if v % (COLUMNS + 1) == COLUMNS { v - COLUMNS } else { v }
}

#[test]
fn a_texture_seam_stays_closed_and_each_side_keeps_its_vertices() {
    let build = build_all(&textured_tube(), &BuildOptions::default());
    let last = build.history().errors.len() as u32 - 1;
    assert!(alive_at(build.history(), last).len() < 60, "stuck at {}", alive_at(build.history(), last).len());
    for step in spread_steps(build.history(), 40) {
        let triangles = alive_at(build.history(), step);
        let places: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(place)).collect();
        let rim = |v: u32| (v / (COLUMNS + 1)).is_multiple_of(ROWS);
        for ([a, b], n_faces) in edge_faces(&places) {
            assert!(
                n_faces == 2 || (n_faces == 1 && rim(a) && rim(b)),
                "step {step}: edge {a} {b} has {n_faces}"
            );
        }
        for triangle in &triangles {
            let column = |v: u32| v % (COLUMNS + 1);
            let inner: Vec<u32> = triangle.iter().copied().filter(|&v| !is_on_seam(v)).map(column).collect();
            let is_first_half = inner.iter().all(|&c| c < COLUMNS / 2);
            if inner.is_empty() || !(is_first_half || inner.iter().all(|&c| c > COLUMNS / 2)) {
                continue;
            }
            for v in triangle.iter().copied().filter(|&v| is_on_seam(v)) {
                assert_eq!(column(v) == 0, is_first_half, "step {step}: {triangle:?} reaches over the seam");
            }
        }
    }
}

#[test]
fn normals_of_flat_shading_do_not_stop_the_simplification() {
    let smooth = textured_tube();
    let mut flat = TriangleMesh::default();
    let mut normals = vec![];
    for (t, triangle) in smooth.triangles.iter().enumerate() {
        for &v in triangle {
            flat.positions.push(smooth.positions[v as usize]);
            normals.extend([t as f32, 0.0, 1.0]);
        }
        let first = 3 * t as u32;
        flat.triangles.push([first, first + 1, first + 2]);
    }
    flat.attributes.push(attribute("normal", 3, &normals));
    let build = build_all(&flat, &BuildOptions::default());
    let coarsest = alive_at(build.history(), build.history().errors.len() as u32 - 1);
    assert!(coarsest.len() < 60, "stuck at {}", coarsest.len());
}
