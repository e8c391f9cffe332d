//! The promise: the progressive decimator reaches every triangle count from the input's down to none, on any input, and every
//! mesh on the way is one: no index out of range, no triangle twice, no corner twice, nothing that was not in the history before.

#![allow(
    clippy::unwrap_used,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::panic,
    reason = "a test"
)]

use nephrite::decimate::progressive::events::EventKind;
use nephrite::history::NEVER;
use nephrite::{Bound, Build, BuildOptions, Method, TriangleMesh, build, generate};
use std::collections::HashSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

fn decimate(mesh: &TriangleMesh, change: impl FnOnce(&mut BuildOptions)) -> Build {
    let mut options =
        BuildOptions { method: Method::Progressive, bound: Bound::Accumulated, ..BuildOptions::default() };
    change(&mut options);
    build(mesh, &options, &|_| ControlFlow::Continue(())).unwrap()
}

/// Goes through the history step by step.
fn check(name: &str, build: &Build) {
    build.history.check().unwrap_or_else(|error| panic!("{name}: {error}"));
    let history = &build.history;
    let n_vertices = build.mesh.positions.len();
    assert_eq!(history.vertex_death.len(), n_vertices, "{name}");
    assert!(build.mesh.positions.as_flattened().iter().all(|x| x.is_finite()), "{name}");
    let n_steps = history.errors.len();
    let (mut births, mut deaths) = (vec![vec![]; n_steps], vec![vec![]; n_steps]);
    for (simplex, (&birth, &death)) in history.birth.iter().zip(&history.death).enumerate() {
        births[birth as usize].push(simplex);
        if death != NEVER {
            deaths[death as usize].push(simplex);
        }
    }
    let mut alive = HashSet::new();
    let mut n_before = usize::MAX;
    for step in 0..n_steps {
        for &simplex in &deaths[step] {
            assert!(alive.remove(&key(history.simplices[simplex])), "{name}: step {step}");
        }
        for &simplex in &births[step] {
            let triangle = history.simplices[simplex];
            let [a, b, c] = triangle;
            assert!(a != b && b != c && c != a, "{name}: {triangle:?} at step {step}");
            assert!(alive.insert(key(triangle)), "{name}: {triangle:?} is there twice at step {step}");
        }
        let slack = n_before.saturating_sub(alive.len());
        assert!(n_before == usize::MAX || (alive.len() <= n_before && slack <= 2), "{name}: step {step}");
        n_before = alive.len();
    }
    assert!(alive.is_empty(), "{name}: {} triangles are left", alive.len());
}

/// The triangle from its least corner on, in its orientation.
fn key(triangle: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = triangle;
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[test]
fn surfaces_of_every_topology_go_down_to_nothing() {
    let meshes = [
        ("cosine", generate::cosine(20)),
        ("sphere", generate::sphere(6)),
        ("torus", generate::torus(20, 12)),
        ("plate", generate::plate(3, 2, 16)),
        ("cube", generate::cuboid(6)),
        ("cylinder", generate::cylinder(24, 4)),
        ("moebius", generate::moebius(30, 4)),
    ];
    for (name, mesh) in meshes {
        for pre_split in [false, true] {
            check(name, &decimate(&mesh, |options| options.progressive.pre_split = pre_split));
        }
        check(name, &decimate(&mesh, |options| options.bound = Bound::Certified));
    }
}

#[test]
fn soups_and_odd_stars_go_down_to_nothing() {
    let grid = |n: u32| (0..n).map(|i| [(i * 7 % 13) as f32, (i * 5 % 11) as f32, (i * 3 % 7) as f32]);
    let soup = TriangleMesh {
        positions: grid(60).collect(),
        triangles: (0..400).map(|i| [i * 17 % 60, i * 23 % 59, i * 31 % 53]).collect(),
        ..TriangleMesh::default()
    };
    check("soup", &decimate(&soup, |_| {}));
    let pages = TriangleMesh {
        positions: grid(60).collect(),
        triangles: (2..60).map(|i| [0, 1, i]).collect(),
        ..TriangleMesh::default()
    };
    check("pages", &decimate(&pages, |_| {}));
    let flat = TriangleMesh {
        positions: (0..30).map(|i| [i as f32, 0.0, 0.0]).collect(),
        triangles: (0..28).map(|i| [i, i + 1, i + 2]).collect(),
        ..TriangleMesh::default()
    };
    check("line", &decimate(&flat, |_| {}));
    let n = 5000_u32;
    let wheel = TriangleMesh {
        positions: std::iter::once([0.0, 0.0, 1.0])
            .chain((0..n).map(|i| {
                let (sin, cos) = (std::f32::consts::TAU * i as f32 / n as f32).sin_cos();
                [cos, sin, 0.0]
            }))
            .collect(),
        triangles: (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect(),
        ..TriangleMesh::default()
    };
    check("wheel", &decimate(&wheel, |_| {}));
}

#[test]
fn a_reduction_is_met_within_one_operation() {
    let mesh = generate::plate(3, 2, 16);
    let n = mesh.triangles.len() as f64;
    for percent in 0..=100 {
        let reduction = f64::from(percent) / 100.0;
        let build = decimate(&mesh, |options| options.progressive.reduction = Some(reduction));
        let left = build.history.death.iter().filter(|&&death| death == NEVER).count() as f64;
        let wished = (n * (1.0 - reduction)).floor();
        assert!(left <= wished && left + 2.0 > wished, "{left} for {wished}");
    }
}

#[test]
fn both_faces_of_a_split_plate_outlive_its_holes() {
    let mesh = generate::plate(3, 2, 16);
    let build = decimate(&mesh, |options| options.progressive.pre_split = true);
    let passage = build.passage.as_ref().unwrap();
    assert!(passage.events.count(EventKind::HoleClosed) >= 12, "{:?}", passage.counts);
    let history = &build.history;
    let four = (0..history.errors.len() as u32)
        .map(|step| {
            let lifetimes = history.birth.iter().zip(&history.death);
            let at = |(i, (&birth, &death))| (birth <= step && step < death).then_some(i);
            lifetimes.enumerate().filter_map(at).collect::<Vec<usize>>()
        })
        .find(|alive| alive.len() <= 4)
        .unwrap();
    let height = |simplex: &usize| {
        let heights = history.simplices[*simplex].map(|v| build.mesh.positions[v as usize][2]);
        assert_eq!((heights[0], heights[1]), (heights[1], heights[2]), "a triangle of a side is left");
        heights[0] > 1.0
    };
    let on_top = four.iter().filter(|simplex| height(simplex)).count();
    assert_eq!((four.len(), on_top), (4, 2));
}

#[test]
fn certified_levels_come_first_and_end_where_the_topology_changes() {
    let sphere = decimate(&generate::sphere(8), |options| options.bound = Bound::Certified);
    let passage = sphere.passage.unwrap();
    let n_steps = sphere.history.errors.len() as u32;
    assert!(passage.n_certified_steps > n_steps / 2, "{} of {n_steps}", passage.n_certified_steps);
    let first_event = passage.events.events.first().unwrap();
    assert!(passage.n_certified_steps <= first_event.step);
    let estimated = decimate(&generate::sphere(8), |_| {});
    assert_eq!(estimated.passage.unwrap().n_certified_steps, 0);
}

#[test]
fn real_meshes_go_down_to_nothing() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let mut paths: Vec<PathBuf> = ["hard/nonmanifold", "hard/cad", "hard/boundary", "gltf"]
        .iter()
        .filter_map(|folder| std::fs::read_dir(data.join(folder)).ok())
        .flat_map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())))
        .filter(|path| path.metadata().is_ok_and(|metadata| metadata.is_file() && metadata.len() < 1_500_000))
        .collect();
    paths.sort();
    for path in paths {
        if let Ok((mesh, _)) = nephrite_formats::read_mesh(&path) {
            check(&path.display().to_string(), &decimate(&mesh, |_| {}));
        }
    }
}
