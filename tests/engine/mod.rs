//! Shared by the tests of the engine: a step of a history, and facts about it found the naive way.

#![allow(dead_code, reason = "each test takes what it needs")]
#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small meshes")]

use nephrite::{Build, BuildOptions, EstimateKind, History, JadeOptions, TriangleMesh, Vertices, build};
use space::{Vector, add_scaled, point_triangle_distance_sq, sub};
use std::collections::{BTreeMap, BTreeSet};

#[path = "../support/space.rs"]
pub(crate) mod space;

/// Builds without watching.
pub(crate) fn build_all(mesh: &TriangleMesh, options: &BuildOptions) -> Build {
    build(mesh, options).unwrap()
}

/// What JADE can be asked for: a proof, and each of the estimates.
pub(crate) fn every_bound() -> [BuildOptions; 4] {
    let estimate = |kind| BuildOptions::with(JadeOptions::estimate(kind));
    let [joint, removed, accumulated] =
        [EstimateKind::Joint, EstimateKind::Removed, EstimateKind::Accumulated].map(estimate);
    [BuildOptions::default(), joint, removed, accumulated]
}

/// Triangles alive at `step`, by linear scan.
pub(crate) fn alive_at(history: &History, step: u32) -> Vec<[u32; 3]> {
    let lifetimes = history.birth.iter().zip(&history.death).zip(&history.simplices);
    lifetimes.filter(|&((&birth, &death), _)| birth <= step && step < death).map(|(_, &t)| t).collect()
}

/// About `n` steps over the whole history, first and last among them, closer together towards the
/// end.
pub(crate) fn spread_steps(history: &History, n: u32) -> Vec<u32> {
    let last = history.errors.len() as u32 - 1;
    let back = |i: u32| (f64::from(last + 1).powf(f64::from(i) / f64::from(n)) - 1.0) as u32;
    (0..=n).map(|i| last - back(i).min(last)).collect::<BTreeSet<u32>>().into_iter().collect()
}

/// How many triangles each edge has.
pub(crate) fn edge_faces(triangles: &[[u32; 3]]) -> BTreeMap<[u32; 2], usize> {
    let mut faces = BTreeMap::new();
    for &[a, b, c] in triangles {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            *faces.entry([p.min(q), p.max(q)]).or_insert(0) += 1;
        }
    }
    faces
}

/// Vertices - edges + triangles.
pub(crate) fn euler_characteristic(triangles: &[[u32; 3]]) -> i64 {
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let count = |n: usize| i64::try_from(n).unwrap();
    count(vertices.len()) - count(edge_faces(triangles).len()) + count(triangles.len())
}

/// Closed chains of edges that have one triangle.
pub(crate) fn boundary_loops(triangles: &[[u32; 3]]) -> usize {
    let mut parent: BTreeMap<u32, u32> = BTreeMap::new();
    fn root(parent: &BTreeMap<u32, u32>, mut v: u32) -> u32 {
        while parent[&v] != v {
            v = parent[&v];
        }
        v
    }
    for (&[a, b], _) in edge_faces(triangles).iter().filter(|&(_, &n)| n == 1) {
        parent.entry(a).or_insert(a);
        parent.entry(b).or_insert(b);
        let (a, b) = (root(&parent, a), root(&parent, b));
        parent.insert(a, b);
    }
    parent.iter().filter(|&(v, p)| v == p).count()
}

/// The corners of triangles over the vertices of `mesh`.
pub(crate) fn corners_of(vertices: Vertices<'_>, triangles: &[[u32; 3]]) -> Vec<[Vector; 3]> {
    let point = |v: u32| vertices.positions[v as usize].map(f64::from);
    triangles.iter().map(|t| t.map(point)).collect()
}

/// Largest distance from samples on every triangle of `from` to the surface `to`.
pub(crate) fn one_sided(from: &[[Vector; 3]], to: &[[Vector; 3]], per_side: u32) -> f64 {
    let mut largest = 0.0_f64;
    for &[a, b, c] in from {
        for i in 0..=per_side {
            for j in 0..=per_side - i {
                let [s, t] = [i, j].map(|k| f64::from(k) / f64::from(per_side));
                let p = add_scaled(add_scaled(a, s, sub(b, a)), t, sub(c, a));
                let squares = to.iter().map(|t| point_triangle_distance_sq(p, t));
                largest = largest.max(squares.fold(f64::INFINITY, f64::min).sqrt());
            }
        }
    }
    largest
}
