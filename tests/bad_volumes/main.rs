//! Promise: every bad volume file has the outcome stated in `outcomes.txt`: refused with a certain
//! error, repaired with counted repairs, or accepted as it is. A file that is not refused becomes a
//! `.neph` file that verifies.
//!
//! The modules beside this one make the files in `files/`. After a change there, run `REGENERATE=1
//! cargo test --test bad_volumes stated_outcome`; it writes the files and the outcomes found for
//! them. Then read the difference.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small literal meshes")]

mod binary;
#[path = "../support/corpus.rs"]
mod corpus;
mod gmsh;
mod gmsh_binary;
mod medit;
mod meshb;
mod mfem;
mod plot3d;
mod references;
#[path = "../support/served.rs"]
mod served;
mod shapes;
mod tetgen;
mod vtk;
mod vtu;

use corpus::{Case, Cases, Corpus, told, variant, variants};
use nephrite::{BuildError, VolumeOptions, build_volume};
use nephrite_formats::{MeshError, VolumeFormat, read_volume};
use serde_json::json;
use served::served;
use std::collections::BTreeSet;
use std::path::Path;

fn corpus() -> Corpus {
    let lists = [
        vtk::cases(),
        vtu::cases(),
        gmsh::cases(),
        gmsh_binary::cases(),
        medit::cases(),
        meshb::cases(),
        mfem::cases(),
        tetgen::cases(),
        plot3d::cases(),
        references::cases(),
        shapes::cases(),
    ];
    Corpus::new("tests/bad_volumes", lists)
}

/// A text with the first occurrence of `from` replaced; there must be one.
fn edited(text: &str, from: &str, to: &str) -> Vec<u8> {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1).into_bytes()
}

/// Cases whose names get the extension of their format.
fn named(extension: &str, cases: impl IntoIterator<Item = (&'static str, Vec<u8>)>) -> Vec<Case> {
    cases.into_iter().map(|(name, bytes)| (format!("{name}.{extension}"), bytes)).collect()
}

/// The outcome of a file: `refused: ERROR`, or its tetrahedra and every count of what was dropped,
/// cut, ignored or repaired.
fn outcome(path: &Path) -> String {
    let (mesh, report) = match read_volume(path) {
        Ok(read) => read,
        Err(error) => {
            assert!(matches!(error, MeshError::InFile { .. }), "{error}");
            let message = error.root().to_string();
            assert!(!message.contains(char::is_control) && message.len() < 300, "{message}");
            return format!("refused: {}", variant(error.root()));
        }
    };
    mesh.check().unwrap();
    for note in report.notes() {
        assert!(!note.contains(char::is_control) && note.len() < 300, "{note}");
    }
    let build = match build_volume(&mesh, &VolumeOptions::default()) {
        Ok(build) => build,
        Err(error @ BuildError::NoTetrahedra { .. }) => return format!("refused: {}", variant(&error)),
        Err(error) => panic!("{}: {error}", path.display()),
    };
    let lod = served(|stream, options| build.write_to(stream, options));
    let tetrahedra = format!("{} tetrahedra", lod.at_level(0).n_simplices());
    told(&tetrahedra, [json!(report), json!(build.repairs())], report.notes().into_iter())
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
    for format in VolumeFormat::ALL {
        let n_files =
            there.iter().filter(|name| VolumeFormat::from_path(name.as_ref()) == Some(format)).count();
        assert!(n_files >= 12, "{n_files} files of {format}");
    }
}

/// Errors of reading are stated by some file each; the others cannot be met by reading a volume.
#[test]
fn every_error_of_reading_volumes_has_a_file() {
    const OF_WRITING: [&str; 4] =
        ["UnknownExtension", "UnknownVolumeExtension", "InconsistentMesh", "TooLargeForFormat"];
    const OF_SURFACES: [&str; 3] = ["NoFaces", "EndsEarly", "Json"];
    // A file that was refused for its partner's sake has the system's reason inside, and its own
    // name around.
    const AROUND: [&str; 1] = ["InFile"];
    let others = [&OF_WRITING[..], &OF_SURFACES, &AROUND].concat();
    let of_volumes: Vec<_> = variants(include_str!("../../formats/src/files/error.rs"), "MeshError")
        .into_iter()
        .filter(|name| !others.contains(name))
        .collect();
    let stated: BTreeSet<String> = corpus().outcomes().into_values().collect();
    for variant in &of_volumes {
        assert!(stated.contains(&format!("refused: {variant}")), "no file is refused for {variant}");
    }
    assert!(of_volumes.len() >= 10, "{of_volumes:?}");
}

#[test]
fn a_missing_file_is_refused() {
    let corpus = corpus();
    assert_eq!(outcome(&corpus.file("none.vtu")), "refused: Io");
    assert_eq!(outcome(&corpus.file("")), "refused: Io");
}
