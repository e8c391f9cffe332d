//! Promise: `ErrorTable` proves the certified errors of a file without the builder, finds a table
//! that states too little, and refuses a table that claims no proof.

#![allow(clippy::unwrap_used, reason = "tests on small meshes")]

#[path = "support/damage.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with other tests")]
#[allow(clippy::cast_possible_truncation, reason = "small files")]
mod damage;
mod engine;

use damage::with_section;
use engine::build_all;
use nephrite::{
    Bound, Build, BuildOptions, ErrorTable, EstimateKind, JadeOptions, Lod, ProgressiveOptions, ReproveError,
    StoreOptions, generate,
};
use nephrite_formats::neph::SectionKind;
use std::io::Cursor;

fn file_bytes(build: &Build) -> Vec<u8> {
    let mut bytes = Cursor::new(vec![]);
    build.write_to(&mut bytes, &StoreOptions { levels: Some(40), ..StoreOptions::default() }).unwrap();
    bytes.into_inner()
}

fn file(build: &Build) -> Lod {
    Lod::from_bytes(&file_bytes(build)).unwrap()
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
        let lod = file(&build);
        assert!(lod.n_levels() > 8);
        assert_eq!(failures(&lod), []);
    }
}

#[test]
fn a_table_that_states_too_little_is_found_out() {
    let build = build_all(&generate::cosine(40), &BuildOptions::default());
    let bytes = file_bytes(&build);
    let errors: Vec<u8> =
        file(&build).errors().iter().flat_map(|error| (error * 0.8).to_le_bytes()).collect();
    let forged = Lod::from_bytes(&with_section(&bytes, SectionKind::Errors, &errors)).unwrap();
    let failures = failures(&forged);
    let exceeded = failures.iter().filter(|failure| matches!(failure, ReproveError::Exceeded { .. })).count();
    assert!(exceeded > 8, "{failures:?}");
}

#[test]
fn estimates_are_not_up_for_proof() {
    let mesh = generate::cosine(20);
    let build = build_all(&mesh, &BuildOptions::with(JadeOptions::estimate(EstimateKind::Joint)));
    let lod = file(&build);
    let refused = ErrorTable::new(&lod).map(|_| ()).unwrap_err();
    assert_eq!(refused, ReproveError::NotCertified { found: Bound::Joint });
}

#[test]
fn levels_behind_a_change_of_topology_are_not_up_for_proof() {
    let options = BuildOptions::with(ProgressiveOptions::default());
    let build = build_all(&generate::torus(24, 12), &options);
    let lod = file(&build);
    let table = ErrorTable::new(&lod).unwrap();
    let last_certified = table.last_certified();
    assert!(last_certified > 8 && last_certified + 1 < lod.n_levels(), "{last_certified}");
    (1..=last_certified).for_each(|level| table.prove(level).unwrap());
    let level = last_certified + 1;
    assert_eq!(table.prove(level), Err(ReproveError::Estimate { level, last_certified }));
}
