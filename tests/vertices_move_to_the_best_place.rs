//! Promise: with the best placement a level needs fewer triangles for its error. The topology,
//! seams, boundary and bounding box stay, and the file serves every level like any other file.

#![allow(clippy::unwrap_used, clippy::cast_possible_truncation, reason = "tests on small meshes")]

mod engine;

use engine::{alive_at, boundary_loops, build_all, edge_faces, euler_characteristic, spread_steps};
use nephrite::{
    Attribute, Build, BuildOptions, JadeOptions, Lod, Placement, ScalarType, StoreOptions, TriangleMesh,
    bounding_diagonal, generate,
};
use std::collections::BTreeSet;

fn best() -> BuildOptions {
    BuildOptions::with(JadeOptions::certified(Placement::Best))
}

/// Triangles of the last step whose error is at most `error`.
fn n_triangles_at(build: &Build, error: f64) -> usize {
    let step = build.history().errors.partition_point(|&e| e <= error) - 1;
    alive_at(build.history(), step as u32).len()
}

#[test]
fn round_surfaces_need_fewer_triangles_for_an_error() {
    for (name, mesh) in [("sphere", generate::sphere(24)), ("torus", generate::torus(80, 40))] {
        let (original, best) = (build_all(&mesh, &BuildOptions::default()), build_all(&mesh, &best()));
        for percent in [0.5, 1.0, 2.0] {
            let error = percent / 100.0 * bounding_diagonal(&mesh);
            let [kept, moved] = [&original, &best].map(|build| n_triangles_at(build, error));
            assert!(
                moved < kept,
                "{name} at {percent} %: {moved} triangles where vertices move, {kept} where not"
            );
        }
    }
}

#[test]
fn topology_and_bounding_box_are_kept() {
    let surfaces = [
        ("sphere", generate::sphere(12)),
        ("torus", generate::torus(40, 20)),
        ("plate with holes", generate::plate(3, 2, 12)),
        ("cosine", generate::cosine(40)),
        ("moebius", generate::moebius(60, 6)),
    ];
    for (name, mesh) in surfaces {
        let build = build_all(&mesh, &best());
        assert!(build.vertices().positions.len() > mesh.positions.len(), "{name}: nothing moved");
        assert_eq!(build.vertices().positions[..mesh.positions.len()], mesh.positions, "{name}");
        assert_eq!(bounding_diagonal(build.vertices()), bounding_diagonal(&mesh), "{name}");
        let (loops, euler) = (boundary_loops(&mesh.triangles), euler_characteristic(&mesh.triangles));
        for step in spread_steps(build.history(), 40) {
            let triangles = alive_at(build.history(), step);
            assert!(edge_faces(&triangles).values().all(|&n| n <= 2), "{name}, step {step}");
            assert_eq!(boundary_loops(&triangles), loops, "{name}, step {step}");
            assert_eq!(euler_characteristic(&triangles), euler, "{name}, step {step}");
        }
    }
}

/// A torus whose texture coordinate jumps where the ring closes: two vertices at each point there.
fn textured_torus() -> TriangleMesh {
    const COLUMNS: u32 = 48;
    const ROWS: u32 = 24;
    let turn = |i: u32, n: u32| f64::from(i % n) / f64::from(n) * std::f64::consts::TAU;
    let mut mesh = TriangleMesh::default();
    let mut values: Vec<f32> = vec![];
    for column in 0..=COLUMNS {
        for row in 0..ROWS {
            let (a, b) = (turn(column, COLUMNS), turn(row, ROWS));
            let radius = 3.0 + b.cos();
            mesh.positions.push([radius * a.cos(), radius * a.sin(), b.sin()].map(|x| x as f32));
            values.push(column as f32 / COLUMNS as f32);
        }
    }
    for column in 0..COLUMNS {
        for row in 0..ROWS {
            let next = (row + 1) % ROWS;
            let [a, b] = [column * ROWS + row, (column + 1) * ROWS + row];
            let [c, d] = [column * ROWS + next, (column + 1) * ROWS + next];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    mesh.attributes.push(Attribute {
        name: "texcoord".into(),
        scalar: ScalarType::F32,
        n_components: 1,
        bytes,
    });
    mesh
}

#[test]
fn vertices_of_a_seam_stay_and_the_others_keep_their_attributes() {
    let mesh = textured_torus();
    let build = build_all(&mesh, &best());
    let values: Vec<f64> = build.vertices().attributes[0].values().collect();
    let n_before = mesh.positions.len();
    assert!(build.vertices().positions.len() > n_before, "nothing moved");
    assert_eq!(values.len(), build.vertices().positions.len());
    assert!(values[n_before..].iter().all(|&value| value > 0.0 && value < 1.0), "a vertex of the seam moved");
    for step in spread_steps(build.history(), 40) {
        // By position, both sides of the seam are one, so the surface is closed.
        let place = |v: u32| build.vertices().positions[v as usize].map(f32::to_bits);
        let triangles = alive_at(build.history(), step);
        let places: Vec<_> = triangles.iter().flatten().map(|&v| place(v)).collect();
        let distinct: Vec<_> = places.iter().collect::<BTreeSet<_>>().into_iter().collect();
        let index = |v: u32| distinct.binary_search(&&place(v)).unwrap() as u32;
        let closed: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(index)).collect();
        assert!(edge_faces(&closed).values().all(|&n| n == 2), "step {step}");
    }
}

#[test]
fn a_file_serves_every_level() {
    let mesh = generate::torus(40, 20);
    let built = build_all(&mesh, &best());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("torus.neph");
    let store = StoreOptions { levels: Some(u32::MAX), ..StoreOptions::default() };
    built.write(&path, &store).unwrap();
    let lod = Lod::open(&path).unwrap();
    lod.verify().unwrap();
    for level in 0..lod.n_levels() {
        let cut = lod.at_level(level);
        let found = cut.to_mesh().unwrap();
        let sorted = |positions: &[[f32; 3]], triangles: &[[u32; 3]]| {
            let place = |t: &[u32; 3]| t.map(|v| positions[v as usize].map(f32::to_bits));
            let mut places: Vec<_> = triangles.iter().map(place).collect();
            places.iter_mut().for_each(|t| t.sort_unstable());
            places.sort_unstable();
            places
        };
        let found = sorted(&found.positions, &found.triangles);
        // Several levels may have one error, each at a step of its own.
        let errors = &built.history().errors;
        let first = errors.partition_point(|&error| error < cut.error());
        let end = errors.partition_point(|&error| error <= cut.error());
        let is_found = |step: usize| {
            let alive = alive_at(built.history(), step as u32);
            alive.len() == found.len() && sorted(built.vertices().positions, &alive) == found
        };
        assert!((first..end).rev().any(is_found), "level {level}");
    }
}
