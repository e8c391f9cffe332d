//! Promise: the smallest meshes can be built with every decimator and option, into files that
//! verify and whose errors are proven again. They are small enough for `tests/miri`, which builds
//! them under an interpreter that checks each access to memory.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, reason = "small meshes")]

mod support;

use nephrite::{
    Attribute, Bound, BuildOptions, ErrorTable, EstimateKind, JadeOptions, Placement, ProgressiveBound,
    ProgressiveMesh, ProgressiveOptions, ScalarType, TriangleMesh, VolumeOptions, build, build_volume,
    generate,
};
use support::on_this_thread;
use support::served::served;

/// A bumpy icosahedron with one face missing and one vertex of a second colour, a flap at an edge
/// that already has two faces, a triangle without area and a triangle that occurs twice.
fn crooked() -> TriangleMesh {
    let mut mesh = generate::sphere(1);
    for (i, p) in (0_u8..).zip(&mut mesh.positions) {
        *p = p.map(|x| x * (1.0 + f32::from(i % 3) * 0.1));
    }
    let n_vertices = mesh.positions.len() as u32;
    mesh.triangles.pop();
    let [a, b, c] = mesh.triangles[0];
    mesh.positions.push([2.0, 2.0, 2.0]);
    mesh.triangles.extend([[a, b, n_vertices], [a, a, b], [b, c, a]]);
    let colors = (0..=n_vertices).map(|v| u8::from(v == n_vertices / 2)).collect();
    mesh.attributes =
        vec![Attribute { name: "color".into(), scalar: ScalarType::U8, n_components: 1, bytes: colors }];
    mesh
}

#[test]
fn by_removals_and_by_collapses() {
    let _pool = on_this_thread();
    let collapses = |bound, pre_split| {
        BuildOptions::with(ProgressiveOptions { bound, pre_split, ..ProgressiveOptions::default() })
    };
    let ways = [
        BuildOptions::default(),
        BuildOptions::with(JadeOptions::estimate(EstimateKind::Joint)),
        BuildOptions::with(JadeOptions::certified(Placement::Best)),
        collapses(ProgressiveBound::Certified, false),
        collapses(ProgressiveBound::Accumulated, true),
    ];
    for options in &ways {
        let built = build(crooked(), options).unwrap();
        let lod = served(|stream, stored| built.write_to(stream, stored));
        assert!(lod.n_levels() > 2, "{options:?}");
        if options.bound() == Bound::Certified {
            let table = ErrorTable::new(&lod).unwrap();
            table.prove(table.last_certified()).unwrap();
        }
        if built.progressive().is_some() {
            let mut played = ProgressiveMesh::new();
            played.append(&built.operations().unwrap().bytes).unwrap();
            played.refine(usize::MAX);
            assert_eq!(played.triangles().len(), built.history().n_alive(0));
        }
    }
}

#[test]
fn by_fusions() {
    let _pool = on_this_thread();
    let built = build_volume(&generate::box_volume([2; 3]), &VolumeOptions::default()).unwrap();
    let lod = served(|stream, stored| built.write_to(stream, stored));
    assert!(lod.n_levels() > 1);
    for level in 0..lod.n_levels() {
        lod.at_level(level).to_volume().unwrap().check().unwrap();
    }
}
