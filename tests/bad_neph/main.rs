//! Promise: every bad `.neph` file has the outcome stated in `outcomes.txt`: refused when it is
//! opened, opened and refused when it is verified, or accepted. Whatever opens gives bounded
//! answers in range to every query.
//!
//! The modules beside this one make the files in `files/`. After a change there, run `REGENERATE=1
//! cargo test --test bad_neph stated_outcome`; it writes the files and the outcomes found for them.
//! Then read the difference.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, reason = "small files")]
#![allow(clippy::semicolon_if_nothing_returned, reason = "an edit in a list is one expression")]

mod contents;
#[path = "../support/corpus.rs"]
mod corpus;
mod heads;
mod operations;
#[path = "../support/mod.rs"]
mod support;
mod trees;
mod valid;

use corpus::{Cases, Corpus, variant, variants};
use nephrite::{OpenError, VerifyError};
use std::collections::BTreeSet;
use support::damage::{Outcome, open_and_use};

/// Small valid files with one fault; all checksums are correct unless the fault is in them.
fn corpus() -> Corpus {
    let lists = [heads::cases(), contents::cases(), operations::cases(), trees::cases()];
    let named = |(name, bytes): (&str, Vec<u8>)| (format!("{name}.neph"), bytes);
    Corpus::new("tests/bad_neph", lists.map(|list| list.into_iter().map(named).collect()))
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
    let head = "# What becomes of each file in files/, named by the error.";
    corpus().check_outcomes(head, |path| outcome(&std::fs::read(path).unwrap()));
}

#[test]
fn every_file_is_made_here_and_has_an_outcome() {
    corpus().check_files();
}

#[test]
fn every_error_of_opening_and_verifying_has_a_file() {
    // Errors that a file in memory cannot have: a disk that does not read, and a head that changed
    // after it was checked.
    const OF_THE_SYSTEM: [&str; 2] = ["Read", "Head"];
    let of_head = variants(include_str!("../../formats/src/neph/error.rs"), "NephError");
    let of_contents = variants(include_str!("../../src/store/error.rs"), "VerifyError");
    let of_tree = variants(include_str!("../../src/tree/check.rs"), "TreeFault");
    let of_compact = variants(include_str!("../../src/store/error.rs"), "CompactFault");
    let mut expected: Vec<String> = of_head.iter().map(|name| format!("refused: {name}")).collect();
    let of_contents = of_contents.iter().filter(|name| !OF_THE_SYSTEM.contains(name));
    let plain = of_contents.filter(|name| !["Tree", "Compact"].contains(name));
    expected.extend(plain.map(|name| format!("opens, fails verify: {name}")));
    expected.extend(of_tree.iter().map(|name| format!("opens, fails verify: Tree {name}")));
    expected.extend(of_compact.iter().map(|name| format!("opens, fails verify: Compact {name}")));
    let stated: BTreeSet<String> = corpus().outcomes().into_values().collect();
    let missing: Vec<_> = expected.iter().filter(|outcome| !stated.contains(*outcome)).collect();
    assert!(missing.is_empty(), "no file for {missing:?}");
    assert!(expected.len() >= 38, "{}", expected.len());
}
