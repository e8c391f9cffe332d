//! Promise: a level that has lost a part says how far that part is from the rest, one that has
//! lost everything says that it has no bound, rounding of text counts from level 0 on, percentages
//! mean one diagonal, and no budget is missed by much.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "a test"
)]

mod engine;

use engine::{alive_at, build_all, corners_of, one_sided};
use nephrite::{
    Build, BuildOptions, Lod, ProgressiveBound, ProgressiveOptions, StoreOptions, TriangleMesh,
    bounding_diagonal, generate,
};
use std::io::Cursor;

fn progressive(bound: ProgressiveBound) -> BuildOptions {
    BuildOptions::with(ProgressiveOptions { bound, ..ProgressiveOptions::default() })
}

fn lod_of(build: &Build) -> Lod {
    let mut bytes = Cursor::new(vec![]);
    build.write_to(&mut bytes, &StoreOptions::default()).unwrap();
    let lod = Lod::from_bytes(bytes.get_ref()).unwrap();
    lod.verify().unwrap();
    lod
}

/// A box, and a smaller one far away.
fn two_boxes() -> TriangleMesh {
    let mut mesh = generate::cuboid(4);
    let small = generate::cuboid(1);
    let n = mesh.positions.len() as u32;
    mesh.positions.extend(small.positions.iter().map(|p| [p[0] * 0.5 + 1000.0, p[1] * 0.5, p[2] * 0.5]));
    mesh.triangles.extend(small.triangles.iter().map(|t| t.map(|v| v + n)));
    mesh
}

#[test]
fn a_part_that_vanishes_counts_with_its_distance() {
    let mesh = two_boxes();
    for bound in [ProgressiveBound::Certified, ProgressiveBound::Accumulated] {
        let build = build_all(&mesh, &progressive(bound));
        let input = corners_of(build.vertices(), &alive_at(build.history(), 0));
        let (mut n_parts_gone, n_steps) = (0, build.history().errors.len());
        for step in (n_steps - 40)..n_steps - 1 {
            let level = corners_of(build.vertices(), &alive_at(build.history(), step as u32));
            let stated = build.history().errors[step];
            let measured = one_sided(&input, &level, 2).max(one_sided(&level, &input, 8));
            assert!(
                measured <= stated && stated <= 1.5 * measured + 3.0,
                "{bound:?} {step}: {measured} {stated}"
            );
            n_parts_gone += usize::from(measured > 900.0);
        }
        assert!((1..4).contains(&n_parts_gone), "{n_parts_gone} steps without the far part");
        let lod = lod_of(&build);
        let cut = lod.at_error(0.01 * lod.bounding_diagonal());
        let xs = cut.to_mesh().unwrap().positions.into_iter().map(|p| p[0]);
        assert!(xs.clone().any(|x| x > 990.0) && xs.clone().any(|x| x < 100.0), "{}", cut.level());
    }
}

#[test]
fn a_level_without_triangles_has_no_bound() {
    for mesh in [two_boxes(), generate::sphere(4), generate::cosine(6)] {
        let build = build_all(&mesh, &progressive(ProgressiveBound::Certified));
        let (last, before) = build.history().errors.split_last().unwrap();
        assert!(*last == f64::INFINITY && before.iter().all(|error| error.is_finite()));
        let lod = lod_of(&build);
        let coarsest = lod.at_level(u32::MAX);
        assert_eq!((coarsest.n_simplices(), coarsest.error()), (0, f64::INFINITY));
        assert_eq!(lod.errors().last(), Some(&f64::MAX));
        assert_eq!(lod.curve().last().map(|point| point.error), Some(f64::INFINITY));
        assert!(lod.at_error(1e300).n_simplices() > 0 && lod.at_error(f64::INFINITY).n_simplices() == 0);
    }
}

#[test]
fn a_diagonal_is_that_of_the_file() {
    let mut mesh = generate::torus(12, 6);
    let n = mesh.positions.len() as u32;
    mesh.positions.extend([[900.0, 0.0, 0.0], [0.0, -800.0, 5.0], [0.0, -800.0, 5.0]]);
    // One far vertex is in no triangle, one in a triangle that is a segment.
    mesh.triangles.extend([[0, n + 1, 0], [n + 1, n + 2, 0]]);
    let build = build_all(&mesh, &BuildOptions::default());
    let diagonal = bounding_diagonal(&generate::torus(12, 6));
    assert_eq!((bounding_diagonal(&mesh), lod_of(&build).bounding_diagonal()), (diagonal, diagonal));
}

#[test]
fn text_that_single_precision_does_not_hold_is_rounded_and_said_so() {
    let folder = std::env::temp_dir().join(format!("nephrite-text-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let texts = [
        ("t.obj", "v 0.1 0 0\nv 1.7 0 0\nv 0 0.3 0\nf 1 2 3\n"),
        ("t.off", "OFF\n3 1 0\n0.1 0 0\n1.7 0 0\n0 0.3 0\n3 0 1 2\n"),
        (
            "t.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n0.1 0 0\n1.7 0 0\n0 0.3 0\n3 0 1 2\n",
        ),
        (
            "t.stl",
            "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0.1 0 0\nvertex 1.7 0 0\nvertex 0 0.3 0\nendloop\nendfacet\nendsolid t\n",
        ),
    ];
    let off = [0.1, 1.7, 0.3].map(|x: f64| (x - f64::from(x as f32)).abs()).into_iter().fold(0.0, f64::max);
    for (name, text) in texts {
        std::fs::write(folder.join(name), text).unwrap();
        let (mesh, _) = nephrite_formats::read_mesh(folder.join(name)).unwrap();
        for options in [BuildOptions::default(), progressive(ProgressiveBound::Accumulated)] {
            let stated = build_all(&mesh, &options).history().errors[0];
            assert!(stated >= off && stated < 2.0 * off, "{name}: {stated} for {off}");
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn budgets_find_a_level_whatever_the_errors_do() {
    // Flat parts have steps of equal error by the thousand.
    for (mesh, options) in [
        (generate::cuboid(24), progressive(ProgressiveBound::Accumulated)),
        (generate::sphere(24), progressive(ProgressiveBound::Accumulated)),
        (generate::cuboid(24), BuildOptions::default()),
    ] {
        let lod = lod_of(&build_all(&mesh, &options));
        let coarsest = lod.at_level(u32::MAX).n_simplices().max(200);
        for n_triangles in coarsest..mesh.triangles.len() {
            let found = lod.at_count(n_triangles).n_simplices();
            assert!(found <= n_triangles && found * 33 >= n_triangles * 32 - 66, "{found} for {n_triangles}");
        }
    }
}
