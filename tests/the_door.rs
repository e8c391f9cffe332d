//! Promise: the root of the library stays small, and whatever it offers is used by an example, a
//! test or the program.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Most names at the root.
const MOST: usize = 120;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Names that `lib.rs` exports: those of its `pub use` and its public modules, but for what is
/// hidden.
fn names() -> BTreeSet<String> {
    let source = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    let (_, public) = source.split_once("\n}\n").unwrap();
    let mut names = BTreeSet::new();
    for statement in public.split("pub use ").skip(1) {
        let (path, _) = statement.split_once(';').unwrap();
        let list = path.rsplit_once("::").unwrap().1;
        let list = path.split_once('{').map_or(list, |(_, list)| list.trim_end_matches('}'));
        names.extend(list.split(',').map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()));
    }
    names.extend(["generate", "measure"].map(str::to_owned));
    names
}

/// All Rust and Markdown files in a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "md") {
            found.push(path);
        }
    }
}

/// Whether a text has this name as a word of its own.
fn has_word(text: &str, name: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(name)
        .any(|(at, _)| !text[..at].ends_with(is_part) && !text[at + name.len()..].starts_with(is_part))
}

#[test]
fn is_narrow() {
    let names = names();
    assert!(names.len() > 40, "the names are not found: {names:?}");
    assert!(names.len() <= MOST, "{} names at the root", names.len());
    for name in ["Lod", "build", "BuildOptions", "Cut", "StoreOptions", "History"] {
        assert!(names.contains(name), "{name}");
    }
}

#[test]
fn offers_nothing_that_nobody_uses() {
    let mut users = Vec::new();
    for folder in ["tests", "benches", "tools/src", "docs", "fuzz/src"] {
        files(&root().join(folder), &mut users);
    }
    let mut texts: Vec<String> = users
        .iter()
        .filter(|path| !path.ends_with("tests/the_door.rs"))
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    // Examples stand in the comments of the library.
    let mut sources = Vec::new();
    files(&root().join("src"), &mut sources);
    for path in sources {
        let source = fs::read_to_string(path).unwrap();
        let comments = source.lines().filter(|line| line.trim_start().starts_with("///"));
        texts.push(comments.collect::<Vec<_>>().join("\n"));
    }
    let unused: Vec<String> =
        names().into_iter().filter(|name| !texts.iter().any(|text| has_word(text, name))).collect();
    assert!(unused.is_empty(), "{unused:?}");
}
