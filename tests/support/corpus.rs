//! A folder of files that the tests make, each with an outcome stated in `outcomes.txt` beside
//! them.

#![allow(unreachable_pub, reason = "a test file is no library")]
#![allow(dead_code, reason = "each test takes what it needs")]

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The name of a file and its bytes.
pub type Case = (String, Vec<u8>);

/// Files under names that are literals in the tests.
pub type Cases = Vec<(&'static str, Vec<u8>)>;

/// Files by name, and where they are kept.
pub struct Corpus {
    /// Folder of `files/` and `outcomes.txt`, from the root of the package.
    pub folder: &'static str,
    /// Bytes of each file.
    pub cases: BTreeMap<String, Vec<u8>>,
}

impl Corpus {
    /// The files of several lists; names must differ.
    pub fn new(folder: &'static str, lists: impl IntoIterator<Item = Vec<Case>>) -> Self {
        let files: Vec<Case> = lists.into_iter().flatten().collect();
        let n_files = files.len();
        let cases: BTreeMap<_, _> = files.into_iter().collect();
        assert_eq!(cases.len(), n_files, "two files of one name");
        Self { folder, cases }
    }

    fn path(&self, name: &str) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join(self.folder).join(name)
    }

    /// Where the file of a name is kept.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path("files").join(name)
    }

    /// The stated outcome of each file.
    pub fn outcomes(&self) -> BTreeMap<String, String> {
        let text = std::fs::read_to_string(self.path("outcomes.txt")).unwrap_or_default();
        let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        let split =
            |line: &str| line.split_once(": ").map(|(name, outcome)| (name.to_owned(), outcome.to_owned()));
        lines.map(|line| split(line).unwrap_or_else(|| panic!("no outcome in {line:?}"))).collect()
    }

    /// Checks that every file ends as stated. With `REGENERATE` in the environment, files and
    /// outcomes are written first, below the line `head`.
    pub fn check_outcomes(&self, head: &str, outcome: impl Fn(&Path) -> String) {
        let found = || self.cases.keys().map(|name| (name.clone(), outcome(&self.file(name))));
        if std::env::var_os("REGENERATE").is_some() {
            let files = self.path("files");
            std::fs::remove_dir_all(&files).unwrap();
            std::fs::create_dir(&files).unwrap();
            self.cases.iter().for_each(|(name, bytes)| std::fs::write(files.join(name), bytes).unwrap());
            let lines: String = found().map(|(name, outcome)| format!("{name}: {outcome}\n")).collect();
            std::fs::write(self.path("outcomes.txt"), format!("{head}\n\n{lines}")).unwrap();
        }
        let stated = self.outcomes();
        let wrong: Vec<_> = found().filter(|(name, outcome)| stated.get(name) != Some(outcome)).collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
    }

    /// Checks that every file has an outcome and the bytes that are made here, and that there is no
    /// other file. Returns their names.
    pub fn check_files(&self) -> BTreeSet<String> {
        let stated: BTreeSet<String> = self.outcomes().into_keys().collect();
        let generated: BTreeSet<String> = self.cases.keys().cloned().collect();
        let entries = std::fs::read_dir(self.path("files")).unwrap();
        let there: BTreeSet<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        for (what, names) in [("an outcome", &stated), ("bytes made here", &generated)] {
            let difference: Vec<_> = there.symmetric_difference(names).collect();
            assert!(difference.is_empty(), "files without {what}, or the other way round: {difference:?}");
        }
        for (name, bytes) in &self.cases {
            assert!(std::fs::read(self.file(name)).unwrap() == *bytes, "{name} has changed");
        }
        there
    }
}

/// The outcome of a file that was not refused: what is served of it, every count of the reports
/// that is not 0, and the notes.
pub fn told(served: &str, reports: [Value; 2], notes: impl Iterator<Item = String>) -> String {
    let mut counts = Vec::new();
    for report in reports {
        let of_number =
            |(key, value): (&String, &Value)| value.as_u64().filter(|&n| n > 0).map(|n| format!("{key} {n}"));
        counts.extend(report.as_object().unwrap().iter().filter_map(of_number));
    }
    counts.extend(notes);
    if counts.is_empty() {
        format!("accepted: {served}")
    } else {
        format!("repaired: {served}, {}", counts.join(", "))
    }
}

/// The name of an error's variant.
pub fn variant(error: &impl std::fmt::Debug) -> String {
    format!("{error:?}").split(|c: char| !c.is_alphanumeric()).next().unwrap().to_owned()
}

/// Names of the variants of an enum in a source file.
pub fn variants(source: &'static str, name: &str) -> Vec<&'static str> {
    let body = source.split_once(&format!("pub enum {name} {{")).unwrap().1.split_once("\n}\n").unwrap().0;
    let lines = body.lines().filter_map(|line| {
        let name = line.strip_prefix("    ")?.split(|c: char| !c.is_alphanumeric()).next()?;
        name.starts_with(|c: char| c.is_ascii_uppercase()).then_some(name)
    });
    lines.collect()
}
