//! Promise: every test, script and file that the pages on security name exists.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::{Path, PathBuf};

const PAGES: [&str; 2] = ["SECURITY.md", "docs/how-to-corrupt-a-neph-file.md"];

/// Where tests are.
const FOLDERS: [&str; 6] = ["formats/src", "formats/tests", "fuzz/src", "src", "tests", "tools"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The text of every file with Rust code below a folder.
fn code(folder: PathBuf, all: &mut String) {
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && !path.ends_with("node_modules") {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                all.push_str(&std::fs::read_to_string(path).unwrap());
            }
        }
    }
}

/// The parts of a text between backquotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

#[test]
fn tests_scripts_and_files() {
    let mut all = String::new();
    FOLDERS.iter().for_each(|folder| code(root().join(folder), &mut all));
    let mut n_names = 0;
    let mut missing = vec![];
    for page in PAGES {
        let text = std::fs::read_to_string(root().join(page)).unwrap();
        for name in quoted(&text) {
            let is_of = |letter: char, more: &str| letter.is_ascii_lowercase() || more.contains(letter);
            let is_there = if name.contains('/') {
                root().join(name).exists()
            } else if name.contains('_') && name.chars().all(|letter| is_of(letter, "_")) {
                all.contains(&format!("fn {name}("))
            } else if name.contains('-') && name.chars().all(|letter| is_of(letter, "-0123456789")) {
                root().join("tests/bad_neph/files").join(name).with_extension("neph").exists()
            } else {
                continue;
            };
            n_names += 1;
            if !is_there {
                missing.push(format!("{page}: {name}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:?}");
    assert!(n_names > 80, "{n_names}");
}
