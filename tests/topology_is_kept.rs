//! Promise: a closed manifold stays a closed manifold of the same Euler characteristic at every
//! step, a bounded one keeps its boundary loops, step 0 is the input, and vertices die in prefix
//! order.

#![allow(clippy::unwrap_used, clippy::cast_possible_truncation, reason = "tests on small meshes")]

mod engine;

use engine::{
    alive_at, boundary_loops, build_all, edge_faces, euler_characteristic, every_bound, spread_steps,
};
use nephrite::{BuildOptions, TriangleMesh, generate};

fn closed_surfaces() -> Vec<(&'static str, TriangleMesh, i64)> {
    vec![
        ("sphere", generate::sphere(12), 2),
        ("torus", generate::torus(40, 20), 0),
        ("plate with holes", generate::plate(3, 2, 12), 2 - 2 * 6),
        ("cylinder", generate::cylinder(24, 6), 2),
        ("cuboid", generate::cuboid(6), 2),
    ]
}

#[test]
fn closed_manifolds_stay_closed_and_keep_their_euler_characteristic() {
    for (name, mesh, expected) in closed_surfaces() {
        for options in every_bound() {
            let (build, bound) = (build_all(&mesh, &options), options.bound());
            let n_steps = build.history().errors.len() - 1;
            assert!(
                n_steps > build.vertices().positions.len() / 2,
                "{name}, {bound:?}: only {n_steps} steps"
            );
            for step in spread_steps(build.history(), 40) {
                let triangles = alive_at(build.history(), step);
                let faces = edge_faces(&triangles);
                assert!(faces.values().all(|&n| n == 2), "{name}, {bound:?}, step {step}: not closed");
                assert_eq!(euler_characteristic(&triangles), expected, "{name}, {bound:?}, step {step}");
            }
        }
    }
}

#[test]
fn bounded_surfaces_keep_their_boundary_loops() {
    let open = [("cosine", generate::cosine(40), 1, 1), ("moebius", generate::moebius(60, 6), 1, 0)];
    for (name, mesh, loops, euler) in open {
        for options in every_bound() {
            let (build, bound) = (build_all(&mesh, &options), options.bound());
            for step in spread_steps(build.history(), 40) {
                let triangles = alive_at(build.history(), step);
                assert!(edge_faces(&triangles).values().all(|&n| n <= 2), "{name}, {bound:?}, step {step}");
                assert_eq!(boundary_loops(&triangles), loops, "{name}, {bound:?}, step {step}");
                assert_eq!(euler_characteristic(&triangles), euler, "{name}, {bound:?}, step {step}");
            }
        }
    }
}

#[test]
fn step_zero_is_the_input() {
    for (name, mesh, _) in closed_surfaces() {
        let build = build_all(&mesh, &BuildOptions::default());
        let mut found = alive_at(build.history(), 0);
        let mut expected = mesh.triangles.clone();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected, "{name}");
        assert_eq!(build.vertices().positions, mesh.positions, "{name}");
        assert_eq!(build.history().errors[0], 0.0);
    }
}

#[test]
fn triangles_use_vertices_that_are_alive_and_every_other_vertex_is_gone() {
    let build = build_all(&generate::torus(40, 20), &BuildOptions::default());
    for step in spread_steps(build.history(), 40) {
        let used: std::collections::BTreeSet<u32> =
            alive_at(build.history(), step).into_iter().flatten().collect();
        let alive =
            (0..).zip(&build.history().vertex_death).filter(|&(_, &death)| death > step).map(|(v, _)| v);
        assert!(alive.eq(used), "step {step}");
    }
}

#[test]
fn non_manifold_input_keeps_its_complex_vertices() {
    // Three pages on one spine: the spine's vertices have three fans' edges and must all stay.
    let mut mesh = TriangleMesh::default();
    let (rows, columns) = (12_u32, 8_u32);
    let vertex = |page: u32, row: u32, column: u32| {
        if column == 0 { row } else { rows + (page * rows + row) * (columns - 1) + column - 1 }
    };
    for row in 0..rows {
        mesh.positions.push([row as f32, 0.0, 0.0]);
    }
    for page in 0..3 {
        let angle = page as f32 * 2.0;
        for row in 0..rows {
            for column in 1..columns {
                let r = column as f32;
                mesh.positions.push([row as f32, r * angle.cos(), r * angle.sin()]);
            }
        }
        for row in 1..rows {
            for column in 1..columns {
                let [a, b] = [vertex(page, row - 1, column - 1), vertex(page, row - 1, column)];
                let [c, d] = [vertex(page, row, column - 1), vertex(page, row, column)];
                mesh.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }
    let build = build_all(&mesh, &BuildOptions::default());
    assert!(build.history().vertex_death[..rows as usize].iter().all(|&death| death == nephrite::NEVER));
    let last = (build.history().errors.len() - 1) as u32;
    assert!(alive_at(build.history(), last).len() < mesh.triangles.len() / 3);
    let three_faces = |triangles: &[[u32; 3]]| edge_faces(triangles).values().filter(|&&n| n == 3).count();
    assert_eq!(three_faces(&alive_at(build.history(), last)), rows as usize - 1);
}
