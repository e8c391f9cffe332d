//! Promise: the smallest meshes can be built with every decimator and option, into files that
//! verify and whose errors are proven again. They are small enough for `tests/miri`, which builds
//! them under an interpreter that checks each access to memory.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, reason = "small meshes")]

mod support;

use nephrite::decimate::jade::{JadeOptions, Placement};
use nephrite::decimate::progressive::ProgressiveOptions;
use nephrite::progressive_mesh::{ProgressiveMesh, encode};
use nephrite::reprove::ErrorTable;
use nephrite::store::Provenance;
use nephrite::{
    Attribute, Bound, BuildOptions, Method, ScalarType, TriangleMesh, VolumeOptions, build, build_volume,
    generate,
};
use std::ops::ControlFlow::Continue;
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
    let usual = BuildOptions::default();
    let collapses = |bound, pre_split| BuildOptions {
        method: Method::Progressive,
        bound,
        progressive: ProgressiveOptions { pre_split, ..ProgressiveOptions::default() },
        ..usual
    };
    let ways = [
        usual,
        BuildOptions { bound: Bound::Joint, ..usual },
        BuildOptions { jade: JadeOptions::of_placement(Placement::Best), ..usual },
        collapses(Bound::Certified, false),
        collapses(Bound::Accumulated, true),
    ];
    for options in &ways {
        let built = build(&crooked(), options, &|_| Continue(())).unwrap();
        let bound = format!("{:?}", options.bound).to_lowercase();
        let n_certified = built.n_certified_triangles().map(|n| n as u64);
        let provenance = Provenance { bound, certified_simplices: n_certified, ..Provenance::default() };
        let lod = served(&built.mesh, &built.history, &provenance);
        assert!(lod.n_levels() > 2, "{options:?}");
        if options.bound == Bound::Certified {
            let table = ErrorTable::new(&lod).unwrap();
            table.prove(table.last_certified()).unwrap();
        }
        if built.passage.is_some() {
            let mut played = ProgressiveMesh::new();
            played.append(&encode(&built).unwrap().bytes).unwrap();
            played.refine(usize::MAX);
            assert_eq!(played.triangles().len(), built.mesh.triangles.len());
        }
    }
}

#[test]
fn by_fusions() {
    let _pool = on_this_thread();
    let built =
        build_volume(&generate::box_volume([2; 3]), &VolumeOptions::default(), &|_| Continue(())).unwrap();
    let lod = served(&built.mesh, &built.history, &Provenance::default());
    assert!(lod.n_levels() > 1);
    for level in 0..lod.n_levels() {
        lod.at_level(level).to_volume().unwrap().check().unwrap();
    }
}
