//! Promise: no shape of a mesh makes its build take time out of proportion: a million components.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_precision_loss, reason = "coordinates below 2^24")]

use nephrite::{BuildOptions, TriangleMesh, build};
use std::ops::ControlFlow::Continue;
use std::time::{Duration, Instant};

/// Some seconds where nobody else works; quadratic time would be hours.
const LONGEST: Duration = Duration::from_secs(120);

#[test]
fn of_a_million_components() {
    const N: u32 = 1_000_000;
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
    let at = |i: u32| {
        corners.map(|[x, y, z]: [f32; 3]| [x + (2 * (i % 1000)) as f32, y + (2 * (i / 1000)) as f32, z])
    };
    let mesh = TriangleMesh {
        positions: (0..N).flat_map(at).collect(),
        triangles: (0..N).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..TriangleMesh::default()
    };
    let start = Instant::now();
    let built = build(&mesh, &BuildOptions::default(), &|_| Continue(())).unwrap();
    let elapsed = start.elapsed();
    assert!(elapsed < LONGEST, "{elapsed:?}");
    assert_eq!(built.mesh.triangles.len(), mesh.triangles.len());
}
