//! Promise: the progressive decimator reaches every triangle count from that of the input down to
//! 0, on any input. Every mesh on the way is valid: no index out of range, no triangle twice, no
//! corner twice, and nothing that the history did not have before.

#![allow(
    clippy::unwrap_used,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::panic,
    reason = "a test"
)]

use nephrite::generate::Drilling;
use nephrite::{
    Build, BuildOptions, EventKind, NEVER, ProgressiveBound, ProgressiveOptions, TriangleMesh, build,
    generate,
};
use std::path::{Path, PathBuf};

#[path = "support/every_step.rs"]
#[allow(unreachable_pub, reason = "shared")]
mod every_step;

fn decimate(mesh: &TriangleMesh, change: impl FnOnce(&mut ProgressiveOptions)) -> Build {
    let mut options =
        ProgressiveOptions { bound: ProgressiveBound::Accumulated, ..ProgressiveOptions::default() };
    change(&mut options);
    build(mesh, &BuildOptions::with(options)).unwrap()
}

fn check(name: &str, build: &Build) {
    every_step::check(build, |what| panic!("{name}: {what}"));
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
            check(name, &decimate(&mesh, |options| options.pre_split = pre_split));
        }
        check(name, &decimate(&mesh, |options| options.bound = ProgressiveBound::Certified));
    }
}

#[test]
fn no_star_grows_over_a_flat_part() {
    const N: u32 = 1500;
    // Two rows of vertices with slivers between them: all errors are 0 until only the corners are
    // left.
    let row = |y: f32| (0..N).map(move |i| [i as f32, y, 0.0]);
    let slivers = (1..N).flat_map(|i| [[i - 1, i, N + i - 1], [i, N + i, N + i - 1]]);
    let mesh = TriangleMesh {
        positions: row(0.0).chain(row(3.0)).collect(),
        triangles: slivers.collect(),
        ..TriangleMesh::default()
    };
    let history = decimate(&mesh, |_| {});
    let history = history.history();
    for percent in (5..100).step_by(5) {
        let step = (history.errors.len() * percent / 100) as u32;
        let lives = history.birth.iter().zip(&history.death);
        let alive = lives.map(|(&birth, &death)| birth <= step && step < death);
        let mut valence = vec![0; mesh.positions.len()];
        let simplices = history.simplices.iter().zip(alive).filter(|&(_, is_alive)| is_alive);
        simplices.flat_map(|(simplex, _)| simplex).for_each(|&v| valence[v as usize] += 1);
        let largest = valence.into_iter().max().unwrap();
        assert!(largest <= 8, "{largest} triangles at one vertex after step {step}");
    }
}

#[test]
fn vertices_judged_many_at_once_leave_the_same_on_any_number_of_threads() {
    for mesh in [generate::sphere(32), generate::terrain(100, 1)] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| decimate(&mesh, |_| {}))
        };
        let alone = on(1);
        check("large", &alone);
        assert!(alone.history() == on(3).history() && alone.progressive() == on(5).progressive());
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
        let build = decimate(&mesh, |options| options.reduction = Some(reduction));
        let left = build.history().death.iter().filter(|&&death| death == NEVER).count() as f64;
        let wished = (n * (1.0 - reduction)).floor();
        assert!(left <= wished && left + 2.0 > wished, "{left} for {wished}");
    }
}

/// Triangles of the first step with at most `n` of them.
fn first_with_at_most(build: &Build, n: usize) -> Vec<[u32; 3]> {
    let history = build.history();
    let alive = |step: u32| {
        let lifetimes = history.birth.iter().zip(&history.death).zip(&history.simplices);
        let alive = lifetimes.filter(move |((birth, death), _)| **birth <= step && step < **death);
        alive.map(|(_, &simplex)| simplex).collect::<Vec<[u32; 3]>>()
    };
    // Counts never rise.
    let (mut low, mut high) = (0, history.errors.len() as u32 - 1);
    while low < high {
        let middle = low + (high - low) / 2;
        if alive(middle).len() <= n { high = middle } else { low = middle + 1 }
    }
    alive(low)
}

/// Triangles of a flat part by face: the upper one (above height 1), the lower one, and those of
/// neither.
fn by_face(build: &Build, triangles: &[[u32; 3]]) -> [usize; 3] {
    let mut counts = [0; 3];
    for triangle in triangles {
        let heights = triangle.map(|v| build.vertices().positions[v as usize][2]);
        let face = if heights[0] != heights[1] || heights[1] != heights[2] {
            2
        } else {
            usize::from(heights[0] < 1.0)
        };
        counts[face] += 1;
    }
    counts
}

#[test]
fn the_papers_plate_and_shell_reach_its_reductions() {
    for (name, mesh) in [
        ("plate", generate::drilled_plate(&Drilling::PLATE)),
        ("shell", generate::shell(&Drilling::SHELL)),
        ("heat exchanger", generate::heat_exchanger(15, 5, 16)),
    ] {
        for pre_split in [false, true] {
            for reduction in [0.5, 0.75, 0.9, 1.0] {
                let build = decimate(&mesh, |options| {
                    options.reduction = Some(reduction);
                    options.pre_split = pre_split;
                });
                let left = build.history().death.iter().filter(|&&death| death == NEVER).count() as f64;
                let wished = (mesh.triangles.len() as f64 * (1.0 - reduction)).floor();
                assert!(left <= wished && left + 2.0 > wished, "{name}: {left} for {wished}");
            }
        }
    }
}

#[test]
fn both_faces_of_a_split_plate_outlive_its_holes() {
    for drilling in [Drilling::PLATE, Drilling::WASHER, Drilling::of_every_square(3, 2, 16)] {
        let mesh = generate::drilled_plate(&drilling);
        let build = decimate(&mesh, |options| options.pre_split = true);
        let report = build.progressive().unwrap();
        let n_rims = 2 * drilling.holes as usize;
        assert!(report.events.count(EventKind::HoleClosed) >= n_rims, "{:?}", report.counts);
        let last = first_with_at_most(&build, 4);
        assert_eq!(by_face(&build, &last), [2, 2, 0], "{drilling:?}");
        // Each face is a square again, with its corners at the corners of the plate.
        let size = [drilling.columns, drilling.rows].map(|n| 10.0 * n as f32);
        for triangle in last {
            for [x, y, _] in triangle.map(|v| build.vertices().positions[v as usize]) {
                assert!(
                    [0.0, size[0]].contains(&x) && [0.0, size[1]].contains(&y),
                    "{x} {y} of {drilling:?}"
                );
            }
        }
    }
}

#[test]
fn certified_levels_come_first_and_end_where_the_topology_changes() {
    let sphere = decimate(&generate::sphere(8), |options| options.bound = ProgressiveBound::Certified);
    let report = sphere.progressive().unwrap();
    let n_steps = sphere.history().errors.len() as u32;
    assert!(report.n_certified_steps > n_steps / 2, "{} of {n_steps}", report.n_certified_steps);
    let first_event = report.events.events.first().unwrap();
    assert!(report.n_certified_steps <= first_event.step);
    let estimated = decimate(&generate::sphere(8), |_| {});
    assert_eq!(estimated.progressive().unwrap().n_certified_steps, 0);
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
