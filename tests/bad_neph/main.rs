//! Promise: every bad `.neph` file ends as `outcomes.txt` says: refused when it is opened, opened and refused when it is
//! verified, or accepted; and whatever opens gives bounded answers in range to everything that is asked.
//!
//! The files in `files/` are made by `cases.rs`. After a change there, `REGENERATE=1 cargo test --test bad_neph
//! stated_outcome` writes them anew, and the outcomes found with them: read the difference.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, reason = "small files")]
#![allow(clippy::semicolon_if_nothing_returned, reason = "an edit in a list is one expression")]

mod cases;
#[path = "../support/mod.rs"]
mod support;

use nephrite::store::{OpenError, VerifyError};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use support::damage::{Outcome, open_and_use};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_neph")
}

/// The stated outcome of each file.
fn outcomes() -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(folder().join("outcomes.txt")).unwrap_or_default();
    let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let split =
        |line: &str| line.split_once(": ").map(|(name, outcome)| (name.to_owned(), outcome.to_owned()));
    lines.map(|line| split(line).unwrap_or_else(|| panic!("no outcome in {line:?}"))).collect()
}

/// The name of an error's variant.
fn variant(error: &impl std::fmt::Debug) -> String {
    format!("{error:?}").split(|c: char| !c.is_alphanumeric()).next().unwrap().to_owned()
}

fn outcome(bytes: &[u8]) -> String {
    match open_and_use(bytes) {
        Outcome::Refused(OpenError::Format(error)) => format!("refused: {}", variant(&error)),
        Outcome::Refused(error) => panic!("{error}"),
        Outcome::Used(Ok(())) => "accepted".to_owned(),
        Outcome::Used(Err(VerifyError::Tree(fault))) => {
            format!("opens, fails verify: Tree {}", variant(&fault))
        }
        Outcome::Used(Err(VerifyError::Compact(fault))) => {
            format!("opens, fails verify: Compact {}", variant(&fault))
        }
        Outcome::Used(Err(error)) => format!("opens, fails verify: {}", variant(&error)),
    }
}

#[test]
fn every_file_has_its_stated_outcome() {
    let files = folder().join("files");
    let cases = cases::all();
    let found =
        || cases.keys().map(|name| (name.clone(), outcome(&std::fs::read(files.join(name)).unwrap())));
    if std::env::var_os("REGENERATE").is_some() {
        std::fs::remove_dir_all(&files).unwrap();
        std::fs::create_dir(&files).unwrap();
        cases.iter().for_each(|(name, bytes)| std::fs::write(files.join(name), bytes).unwrap());
        let lines: String = found().map(|(name, outcome)| format!("{name}: {outcome}\n")).collect();
        let head = "# What becomes of each file in files/, named by the error.\n\n";
        std::fs::write(folder().join("outcomes.txt"), format!("{head}{lines}")).unwrap();
    }
    let stated = outcomes();
    let wrong: Vec<_> = found().filter(|(name, outcome)| stated.get(name) != Some(outcome)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_file_is_made_here_and_has_an_outcome() {
    let cases = cases::all();
    let stated: BTreeSet<String> = outcomes().into_keys().collect();
    let generated: BTreeSet<String> = cases.keys().cloned().collect();
    let entries = std::fs::read_dir(folder().join("files")).unwrap();
    let there: BTreeSet<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    for (what, names) in [("an outcome", &stated), ("bytes made here", &generated)] {
        let difference: Vec<_> = there.symmetric_difference(names).collect();
        assert!(difference.is_empty(), "files without {what}, or the other way round: {difference:?}");
    }
    for (name, bytes) in &cases {
        assert!(std::fs::read(folder().join("files").join(name)).unwrap() == *bytes, "{name} has changed");
    }
}

/// Names of the variants of an enum in a source file.
fn variants(source: &'static str, name: &str) -> Vec<&'static str> {
    let body = source.split_once(&format!("pub enum {name} {{")).unwrap().1.split_once("\n}\n").unwrap().0;
    let lines = body.lines().filter_map(|line| {
        let name = line.strip_prefix("    ")?.split(|c: char| !c.is_alphanumeric()).next()?;
        name.starts_with(|c: char| c.is_ascii_uppercase()).then_some(name)
    });
    lines.collect()
}

#[test]
fn every_error_of_opening_and_verifying_has_a_file() {
    // What a file in memory cannot meet: a disk that does not read, and a head that changed after it was checked.
    const OF_THE_SYSTEM: [&str; 2] = ["Read", "Head"];
    let of_head = variants(include_str!("../../formats/src/neph/error.rs"), "NephError");
    let of_contents = variants(include_str!("../../src/store/error.rs"), "VerifyError");
    let of_tree = variants(include_str!("../../src/tree/check.rs"), "TreeFault");
    let of_compact = variants(include_str!("../../src/store/compact.rs"), "CompactFault");
    let mut expected: Vec<String> = of_head.iter().map(|name| format!("refused: {name}")).collect();
    let of_contents = of_contents.iter().filter(|name| !OF_THE_SYSTEM.contains(name));
    let plain = of_contents.filter(|name| !["Tree", "Compact"].contains(name));
    expected.extend(plain.map(|name| format!("opens, fails verify: {name}")));
    expected.extend(of_tree.iter().map(|name| format!("opens, fails verify: Tree {name}")));
    expected.extend(of_compact.iter().map(|name| format!("opens, fails verify: Compact {name}")));
    let stated: BTreeSet<String> = outcomes().into_values().collect();
    let missing: Vec<_> = expected.iter().filter(|outcome| !stated.contains(*outcome)).collect();
    assert!(missing.is_empty(), "no file for {missing:?}");
    assert!(expected.len() >= 38, "{}", expected.len());
}
