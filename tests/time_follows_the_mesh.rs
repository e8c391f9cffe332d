//! Promise: no shape of a mesh makes its build take time out of proportion: a million components,
//! stars of 100,000 triangles.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_precision_loss, reason = "coordinates below 2^24")]

use nephrite::{
    BuildOptions, EstimateKind, JadeOptions, ProgressiveBound, ProgressiveOptions, TriangleMesh, build,
};
use watchdog::Watchdog;

#[path = "support/watchdog.rs"]
mod watchdog;

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
    let _watchdog = Watchdog::over("a million components");
    let built = build(&mesh, &BuildOptions::default()).unwrap();
    assert_eq!(built.history().n_alive(0), mesh.triangles.len());
}

/// The triangles from a hub to a ring of `n` vertices, which `place` positions by their angle and
/// number.
fn fan(n: u32, place: impl Fn(f32, u32) -> [f32; 3]) -> TriangleMesh {
    let angle = |i: u32| i as f32 / n as f32 * std::f32::consts::TAU;
    TriangleMesh {
        positions: std::iter::once([0.0; 3]).chain((0..n).map(|i| place(angle(i), i))).collect(),
        triangles: (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect(),
        ..TriangleMesh::default()
    }
}

#[test]
fn of_a_star_of_a_hundred_thousand_triangles() {
    const N: u32 = 100_000;
    // Numbers without a pattern, from 0 to 1.
    let noise = |i: u32| (i.wrapping_mul(2_654_435_761) >> 16) as f32 / 65_536.0;
    let disk = fan(N, |angle, _| [angle.cos(), angle.sin(), 0.0]);
    let cone = fan(N, |angle, _| [angle.cos(), angle.sin(), 1.0]);
    let rugged = fan(N, |angle, i| {
        let radius = 1.0 + 0.3 * noise(i);
        [radius * angle.cos(), radius * angle.sin(), 1.0 + 0.2 * noise(i + 7)]
    });
    let progressive = |pre_split| {
        let bound = ProgressiveBound::Accumulated;
        BuildOptions::with(ProgressiveOptions { bound, pre_split, ..ProgressiveOptions::default() })
    };
    let ways = [BuildOptions::default(), progressive(false), progressive(true)];
    for (shape, mesh) in [("disk", disk), ("cone", cone), ("rugged cone", rugged)] {
        for options in &ways {
            let _watchdog = Watchdog::over(format_args!("{shape}, {:?}", options.method()));
            build(&mesh, options).unwrap();
        }
    }
}

#[test]
fn of_the_largest_coordinates() {
    const N_VERTICES: u32 = 12;
    let mut random = 1_u32;
    let mut next = |below: u32| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 8) % below
    };
    let estimate = |kind| BuildOptions::with(JadeOptions::estimate(kind));
    let [joint, removed, accumulated] =
        [EstimateKind::Joint, EstimateKind::Removed, EstimateKind::Accumulated].map(estimate);
    let ways = [BuildOptions::default(), joint, removed, accumulated];
    for i in 0..400 {
        let mesh = TriangleMesh {
            positions: (0..N_VERTICES)
                .map(|_| [(); 3].map(|()| (next(256) as f32 - 128.0) * 2.5e36))
                .collect(),
            triangles: (0..20).map(|_| [(); 3].map(|()| next(N_VERTICES))).collect(),
            ..TriangleMesh::default()
        };
        let _watchdog = Watchdog::over(format_args!("soup {i} of the largest coordinates"));
        ways.iter().for_each(|options| _ = build(&mesh, options).unwrap());
    }
}
