//! What the engine's tests share: a step of a history, and naive facts about it.

#![allow(dead_code, reason = "each test takes what it needs")]
#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small meshes")]

use nephrite::{Build, BuildOptions, History, TriangleMesh, build};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

/// Builds without watching.
pub(crate) fn build_all(mesh: &TriangleMesh, options: &BuildOptions) -> Build {
    build(mesh, options, &|_| ControlFlow::Continue(())).unwrap()
}

/// Triangles alive at `step`, by linear scan.
pub(crate) fn alive_at(history: &History, step: u32) -> Vec<[u32; 3]> {
    let lifetimes = history.birth.iter().zip(&history.death).zip(&history.simplices);
    lifetimes.filter(|&((&birth, &death), _)| birth <= step && step < death).map(|(_, &t)| t).collect()
}

/// About `n` steps over the whole history, first and last among them, closer together towards the end.
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
