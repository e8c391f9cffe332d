//! Promise: every test, script, file and link that a page names exists.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::{Path, PathBuf};

/// Pages that name tests and files of the corpus of bad files.
const SECURITY_PAGES: [&str; 2] = ["SECURITY.md", "docs/how-to-corrupt-a-neph-file.md"];

/// Folders with tests.
const FOLDERS: [&str; 6] = ["formats/src", "formats/tests", "fuzz/src", "src", "tests", "tools"];

/// Folders that a path in a page may begin with.
const TOPS: [&str; 9] =
    ["compare/", "docs/", "formats/", "fuzz/", "renderer/", "src/", "tests/", "tools/", "benches/"];

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

/// Every page, as its path from the root.
fn pages() -> Vec<PathBuf> {
    let in_folder = |folder: &str| {
        let entries = std::fs::read_dir(root().join(folder)).unwrap();
        let paths = entries.map(|entry| Path::new(folder).join(entry.unwrap().file_name()));
        paths.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect::<Vec<_>>()
    };
    ["", "docs", "formats"].into_iter().flat_map(in_folder).collect()
}

/// The parts of a text between backquotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// The paths that a name stands for: `a/{b,c}` stands for `a/b` and `a/c`.
fn alternatives(name: &str) -> Vec<String> {
    match (name.split_once('{'), name.split_once('}')) {
        (Some((before, _)), Some((inside, after))) => {
            inside[before.len() + 1..].split(',').map(|part| format!("{before}{part}{after}")).collect()
        }
        _ => vec![name.to_owned()],
    }
}

#[test]
fn tests_scripts_and_files() {
    let mut all = String::new();
    FOLDERS.iter().for_each(|folder| code(root().join(folder), &mut all));
    let mut n_names = 0;
    let mut missing = vec![];
    for page in SECURITY_PAGES {
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

#[test]
fn paths_and_links_of_all_pages() {
    let mut n_names = 0;
    let mut missing = vec![];
    for page in pages() {
        let text = std::fs::read_to_string(root().join(&page)).unwrap();
        let is_path = |name: &&str| {
            TOPS.iter().any(|top| name.starts_with(top)) && !name.contains([' ', '*', '<', '\n'])
        };
        let folder = root().join(page.parent().unwrap());
        // A page beside a crate names files of the crate.
        let from_root = |path: String| {
            let beside = folder.join(&path);
            if beside.exists() { beside } else { root().join(path) }
        };
        let paths = quoted(&text).filter(is_path).flat_map(alternatives).map(from_root);
        let links = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
        let links = links.map(|(link, _)| link.split('#').next().unwrap_or_default());
        let inside = links.filter(|link| !link.is_empty() && !link.contains("://"));
        for path in paths.chain(inside.map(|link| folder.join(link))) {
            n_names += 1;
            if !path.exists() {
                missing.push(format!("{}: {}", page.display(), path.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
    assert!(n_names > 80, "{n_names}");
}
