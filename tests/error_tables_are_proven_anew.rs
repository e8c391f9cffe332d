//! Promise: `ErrorTable` proves the certified errors of a file without the builder, finds a table
//! that states too little, and refuses a table that claims no proof.

#![allow(clippy::unwrap_used, reason = "tests on small meshes")]

mod engine;

use engine::build_all;
use nephrite::reprove::{ErrorTable, ReproveError};
use nephrite::store::{Provenance, StoreOptions, write_to};
use nephrite::{Bound, BuildOptions, History, Lod, Method, TriangleMesh, generate};
use std::io::Cursor;

fn file(mesh: &TriangleMesh, history: &History, bound: &str) -> Lod {
    file_certified_to(mesh, history, bound, None)
}

fn file_certified_to(
    mesh: &TriangleMesh,
    history: &History,
    bound: &str,
    certified_simplices: Option<u64>,
) -> Lod {
    let provenance = Provenance {
        method: "jade".into(),
        bound: bound.into(),
        max_error: None,
        n_vertices_in: mesh.positions.len() as u64,
        n_simplices_in: mesh.triangles.len() as u64,
        options: serde_json::Value::Null,
        repairs: serde_json::Value::Null,
        certified_simplices,
        ..Provenance::default()
    };
    let mut bytes = Cursor::new(vec![]);
    write_to(
        &mut bytes,
        mesh,
        history,
        &provenance,
        &StoreOptions { levels: Some(40), ..StoreOptions::default() },
    )
    .unwrap();
    Lod::from_bytes(bytes.get_ref()).unwrap()
}

/// Levels of the file whose error is not proven.
fn failures(lod: &Lod) -> Vec<ReproveError> {
    let table = ErrorTable::new(lod).unwrap();
    (0..lod.n_levels()).filter_map(|level| table.prove(level).err()).collect()
}

#[test]
fn what_the_builder_states_is_proven_again() {
    for mesh in
        [generate::cosine(40), generate::torus(40, 20), generate::plate(2, 2, 12), generate::moebius(48, 5)]
    {
        let build = build_all(&mesh, &BuildOptions::default());
        let lod = file(&build.mesh, &build.history, "certified");
        assert!(lod.n_levels() > 8);
        assert_eq!(failures(&lod), []);
    }
}

#[test]
fn a_table_that_states_too_little_is_found_out() {
    let build = build_all(&generate::cosine(40), &BuildOptions::default());
    let mut forged = build.history.clone();
    forged.errors.iter_mut().for_each(|error| *error *= 0.8);
    let failures = failures(&file(&build.mesh, &forged, "certified"));
    let exceeded = failures.iter().filter(|failure| matches!(failure, ReproveError::Exceeded { .. })).count();
    assert!(exceeded > 8, "{failures:?}");
}

#[test]
fn estimates_are_not_up_for_proof() {
    let mesh = generate::cosine(20);
    let build = build_all(&mesh, &BuildOptions { bound: Bound::Joint, ..BuildOptions::default() });
    let lod = file(&build.mesh, &build.history, "joint");
    let refused = ErrorTable::new(&lod).map(|_| ()).unwrap_err();
    assert_eq!(refused, ReproveError::NotCertified { found: "joint".into() });
}

#[test]
fn levels_behind_a_change_of_topology_are_not_up_for_proof() {
    let options = BuildOptions { method: Method::Progressive, ..BuildOptions::default() };
    let build = build_all(&generate::torus(24, 12), &options);
    let least = build.n_certified_triangles().unwrap();
    let lod = file_certified_to(&build.mesh, &build.history, "certified", Some(least as u64));
    let table = ErrorTable::new(&lod).unwrap();
    let last_certified = table.last_certified();
    assert!(last_certified > 8 && last_certified + 1 < lod.n_levels(), "{last_certified}");
    (1..=last_certified).for_each(|level| table.prove(level).unwrap());
    let level = last_certified + 1;
    assert_eq!(table.prove(level), Err(ReproveError::Estimate { level, last_certified }));
}
