//! Promise: two meshes that share a border fit at any levels, if both were built with a locked
//! boundary: every vertex of the boundary is at every step where it was, and the boundary edges
//! stay.

#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test")]

mod engine;

use engine::{alive_at, build_all, edge_faces, spread_steps};
use nephrite::{
    BuildOptions, Decimator, EstimateKind, JadeOptions, Placement, ProgressiveBound, ProgressiveOptions,
    TriangleMesh, generate,
};
use std::collections::BTreeSet;
use std::path::Path;

type Edges = BTreeSet<[[u32; 3]; 2]>;

/// Boundary edges by the bits of their ends.
fn boundary(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Edges {
    let faces = edge_faces(triangles);
    let of_one = faces.into_iter().filter(|&(_, n)| n == 1).map(|(edge, _)| edge);
    of_one
        .map(|edge| {
            let mut ends = edge.map(|v| positions[v as usize].map(|x| (x + 0.0).to_bits()));
            ends.sort_unstable();
            ends
        })
        .collect()
}

/// Edges that both ends are on the boundary of, but that are no boundary edges.
fn n_chords(positions: &[[f32; 3]], triangles: &[[u32; 3]], boundary: &Edges) -> usize {
    let bits = |v: u32| positions[v as usize].map(|x| (x + 0.0).to_bits());
    let ends: BTreeSet<[u32; 3]> = boundary.iter().flatten().copied().collect();
    let inner = edge_faces(triangles).into_iter().filter(|&(_, n)| n > 1).map(|(edge, _)| edge);
    inner.filter(|edge| edge.iter().all(|&v| ends.contains(&bits(v)))).count()
}

fn ways() -> Vec<BuildOptions> {
    let accumulated =
        ProgressiveOptions { bound: ProgressiveBound::Accumulated, ..ProgressiveOptions::default() };
    let decimators: [Decimator; 5] = [
        JadeOptions::default().into(),
        JadeOptions::estimate(EstimateKind::Joint).into(),
        JadeOptions::certified(Placement::Best).into(),
        ProgressiveOptions::default().into(),
        accumulated.into(),
    ];
    let locked = |decimator| BuildOptions { lock_boundary: true, ..BuildOptions::with(decimator) };
    decimators.map(locked).to_vec()
}

/// Checks steps of the history of `mesh`; the triangles of the last.
fn check(name: &str, mesh: &TriangleMesh, options: &BuildOptions) -> usize {
    let build = build_all(mesh, options);
    let input = alive_at(build.history(), 0);
    let expected = boundary(build.vertices().positions, &input);
    let n_chords_in = n_chords(build.vertices().positions, &input, &expected);
    assert!(!expected.is_empty());
    let mut n_left = 0;
    for step in spread_steps(build.history(), 60) {
        let level = alive_at(build.history(), step);
        let what = || format!("{name}, {options:?}, step {step}");
        let found = boundary(build.vertices().positions, &level);
        // Splits open new borders inside.
        assert!(found.is_superset(&expected), "{}", what());
        assert!(found == expected || matches!(options.decimator, Decimator::Progressive(_)), "{}", what());
        let n_chords = n_chords(build.vertices().positions, &level, &expected);
        assert!(n_chords <= n_chords_in, "{}: {n_chords} edges across, {n_chords_in} before", what());
        n_left = level.len();
    }
    n_left
}

/// Columns from `from` to `to` of a terrain of 41.
fn tile(from: usize, to: usize) -> TriangleMesh {
    const SIDE: usize = 41;
    let whole = generate::terrain(41, 5);
    let is_inside = |t: &&[u32; 3]| t.iter().all(|&v| (from..=to).contains(&(v as usize % SIDE)));
    let triangles = whole.triangles.iter().filter(is_inside).copied().collect();
    TriangleMesh { triangles, ..whole }
}

#[test]
fn tiles_of_a_terrain_keep_their_borders() {
    for options in ways() {
        for (from, to) in [(0, 20), (20, 40)] {
            let mesh = tile(from, to);
            let n_left = check("terrain", &mesh, &options);
            assert!(4 * n_left < mesh.triangles.len(), "{n_left} of {}", mesh.triangles.len());
        }
    }
}

#[test]
fn holes_and_loose_parts_keep_their_borders() {
    let mut parts = generate::plate(2, 2, 12);
    let n = u32::try_from(parts.positions.len()).unwrap();
    parts.positions.extend([[50.0, 0.0, 0.0], [51.0, 0.0, 0.0], [50.0, 1.0, 0.5]]);
    parts.triangles.push([n, n + 1, n + 2]);
    for options in ways() {
        check("plate", &parts, &options);
        check("moebius", &generate::moebius(48, 6), &options);
    }
}

#[test]
fn tiles_from_files_keep_their_borders() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases/surfaces");
    for name in ["tile_w.obj", "tile_e.obj"] {
        let Ok((mesh, _)) = nephrite_formats::read_mesh(folder.join(name)) else {
            eprintln!("{name}: skipped, it is not there");
            continue;
        };
        for options in [ways()[0], ways()[3]] {
            let n_left = check(name, &mesh, &options);
            assert!(4 * n_left < mesh.triangles.len(), "{n_left} of {}", mesh.triangles.len());
        }
    }
}
