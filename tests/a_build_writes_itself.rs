//! Promise: a file states which decimator made it, what its errors mean and what the input was; and
//! it states no more than is true.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{
    Bound, BuildOptions, ErrorTable, EstimateKind, JadeBound, JadeOptions, Lod, Method, Placement,
    ProgressiveBound, ProgressiveOptions, ReproveError, StoreOptions, StreamError, TriangleMesh,
    VolumeOptions, WriteError, build, build_volume, generate,
};
use std::io::Cursor;
use support::served::served;

/// A sphere with a vertex that no triangle uses and a triangle that is there twice.
fn mesh() -> TriangleMesh {
    let mut mesh = generate::sphere(4);
    mesh.positions.push([9.0; 3]);
    mesh.triangles.push(mesh.triangles[0]);
    mesh
}

#[test]
fn of_every_kind() {
    let estimated =
        ProgressiveOptions { bound: ProgressiveBound::Accumulated, ..ProgressiveOptions::default() };
    let best = JadeOptions::certified(Placement::Best);
    let kinds = [
        (BuildOptions::default(), Method::Jade, Bound::Certified),
        (BuildOptions::with(best), Method::Jade, Bound::Certified),
        (BuildOptions::with(JadeOptions::estimate(EstimateKind::Joint)), Method::Jade, Bound::Joint),
        (BuildOptions::with(JadeOptions::estimate(EstimateKind::Removed)), Method::Jade, Bound::Removed),
        (
            BuildOptions::with(JadeOptions::estimate(EstimateKind::Accumulated)),
            Method::Jade,
            Bound::Accumulated,
        ),
        (BuildOptions::with(ProgressiveOptions::default()), Method::Progressive, Bound::Certified),
        (BuildOptions::with(estimated), Method::Progressive, Bound::Accumulated),
    ];
    for (options, method, bound) in kinds {
        let options = BuildOptions { max_error: Some(0.5), ..options };
        let built = build(mesh(), &options).unwrap();
        let lod = served(|stream, stored| built.write_to(stream, stored));
        let metadata = lod.metadata().unwrap();
        assert_eq!((metadata.method, metadata.bound, metadata.max_error), (method, bound, Some(0.5)));
        let counts = (metadata.n_vertices_in, metadata.n_simplices_in);
        assert_eq!(counts, (mesh().positions.len() as u64, mesh().triangles.len() as u64));
        assert_eq!(metadata.repairs["triangles_duplicate"], 1);
        assert!(metadata.options[method.to_string()].is_object());
        match (ErrorTable::new(&lod), bound) {
            (Ok(table), Bound::Certified) => {
                let last = table.last_certified();
                [last / 2, last].into_iter().for_each(|level| table.prove(level).unwrap());
            }
            (refused, _) => assert_eq!(refused.err(), Some(ReproveError::NotCertified { found: bound })),
        }
    }
}

#[test]
fn of_a_volume() {
    let volume = generate::box_volume([4; 3]);
    let built = build_volume(&volume, &VolumeOptions::default()).unwrap();
    let metadata = served(|stream, options| built.write_to(stream, options)).metadata().unwrap();
    assert_eq!((metadata.method, metadata.bound), (Method::Fusion, Bound::Boundary));
    assert_eq!(metadata.n_simplices_in, volume.tetrahedra.len() as u64);
}

#[test]
fn a_bare_history_states_nothing() {
    let built = build(mesh(), &BuildOptions::default()).unwrap();
    let lod = served(|stream, options| built.history().write_to(stream, built.vertices(), options));
    let metadata = lod.metadata().unwrap();
    assert_eq!((metadata.method, metadata.bound), (Method::Other, Bound::Unstated));
    let refused = ErrorTable::new(&lod).map(drop);
    assert_eq!(refused, Err(ReproveError::NotCertified { found: Bound::Unstated }));
    assert!(refused.unwrap_err().to_string().contains("of the kind none"));
}

#[test]
fn operations_are_written_where_there_are_some() {
    let options = StoreOptions { operations: true, ..StoreOptions::default() };
    let mut stream = Cursor::new(Vec::new());
    let progressive = BuildOptions::with(ProgressiveOptions::default());
    build(mesh(), &progressive).unwrap().write_to(&mut stream, &options).unwrap();
    let lod = Lod::from_bytes(stream.get_ref()).unwrap();
    assert!(!lod.operations().is_empty());
    let none = build(mesh(), &BuildOptions::default()).unwrap().write_to(&mut stream, &options);
    assert!(matches!(none, Err(WriteError::Operations(StreamError::NoOperations))));
    let volume = build_volume(&generate::box_volume([2; 3]), &VolumeOptions::default()).unwrap();
    let none = volume.write_to(&mut stream, &options);
    assert!(matches!(none, Err(WriteError::Operations(StreamError::NoOperations))));
}

#[test]
fn a_placement_has_its_constants_however_it_is_asked_for() {
    let named = JadeOptions::certified(Placement::Best);
    let put_in = JadeOptions { bound: JadeBound::Certified(Placement::Best), ..JadeOptions::default() };
    let [named, put_in] = [named, put_in].map(|jade| build(mesh(), &BuildOptions::with(jade)).unwrap());
    assert!(named == put_in);
}
