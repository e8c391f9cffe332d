//! Promise: every bad mesh file has the outcome stated in `outcomes.txt`: refused with a certain
//! error, repaired with counted repairs, or accepted as it is. A file that is not refused becomes a
//! `.neph` file that verifies.
//!
//! The modules beside this one make the files in `files/`. After a change there, run `REGENERATE=1
//! cargo test --test bad_meshes stated_outcome`; it writes the files and the outcomes found for
//! them. Then read the difference.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small literal meshes")]

#[path = "../support/corpus.rs"]
mod corpus;
mod gltf;
mod obj;
mod off;
mod ply;
#[path = "../support/served.rs"]
mod served;
mod shapes;
mod stl;

use corpus::{Case, Cases, Corpus, told, variant};
use nephrite::{BuildError, BuildOptions};
use nephrite_formats::{MeshError, MeshFormat, read_mesh};
use serde_json::json;
use served::served;
use std::collections::BTreeSet;
use std::path::Path;

fn corpus() -> Corpus {
    let lists = [ply::cases(), obj::cases(), stl::cases(), off::cases(), gltf::cases(), shapes::cases()];
    Corpus::new("tests/bad_meshes", lists)
}

/// The outcome of a file: `refused: ERROR`, or its triangles and every count of what was dropped,
/// ignored or repaired.
fn outcome(path: &Path) -> String {
    let (mesh, report) = match read_mesh(path) {
        Ok(read) => read,
        Err(error) => {
            assert!(matches!(error, MeshError::InFile { .. }), "{error}");
            assert!(!error.to_string().contains('\n'), "{error}");
            return format!("refused: {}", variant(error.root()));
        }
    };
    mesh.check().unwrap();
    let build = match nephrite::build(&mesh, &BuildOptions::default()) {
        Ok(build) => build,
        Err(error @ BuildError::NoTriangles { .. }) => return format!("refused: {}", variant(&error)),
        Err(error) => panic!("{}: {error}", path.display()),
    };
    let lod = served(|stream, options| build.write_to(stream, options));
    let triangles = format!("{} triangles", lod.at_level(0).n_simplices());
    told(&triangles, [json!(report), json!(build.repairs())], report.notes().into_iter())
}

#[test]
fn every_file_has_its_stated_outcome() {
    let head =
        "# What becomes of each file in files/. Counts are those of the reports of reading and repair.";
    corpus().check_outcomes(head, outcome);
}

#[test]
fn every_file_is_made_here_and_has_an_outcome() {
    let there = corpus().check_files();
    assert!(there.len() >= 150, "{} files", there.len());
    for format in MeshFormat::ALL {
        let n_files =
            there.iter().filter(|name| MeshFormat::from_path(name.as_ref()) == Some(format)).count();
        assert!(n_files >= 12, "{n_files} files of {format}");
    }
}

/// Errors of reading are stated by some file each; the others cannot be met by reading.
#[test]
fn every_error_of_reading_has_a_file() {
    const OF_WRITING: [&str; 3] = ["UnknownExtension", "InconsistentMesh", "TooLargeForFormat"];
    // The system refuses a file only if it does not exist: `a_missing_file_is_refused`.
    const OF_THE_SYSTEM: [&str; 2] = ["InFile", "Io"];
    // Volumes have readers and tests of their own.
    const OF_VOLUMES: [&str; 2] = ["UnknownVolumeExtension", "NoTetrahedra"];
    let source = include_str!("../../formats/src/files/error.rs");
    let variants = corpus::variants(source, "MeshError");
    let stated: BTreeSet<String> = corpus().outcomes().into_values().collect();
    let mut n_variants = 0;
    let others = [&OF_WRITING[..], &OF_THE_SYSTEM, &OF_VOLUMES].concat();
    for variant in variants.into_iter().filter(|name| !others.contains(name)) {
        assert!(stated.contains(&format!("refused: {variant}")), "no file is refused for {variant}");
        n_variants += 1;
    }
    assert!(n_variants >= 13, "{n_variants}");
}

#[test]
fn a_missing_file_is_refused() {
    assert_eq!(outcome(&corpus().file("none.ply")), "refused: Io");
    assert_eq!(outcome(&corpus().file("")), "refused: Io");
}
