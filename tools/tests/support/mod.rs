//! The program, run as a user runs it.
#![allow(dead_code, reason = "every test file takes what it needs")]
#![allow(clippy::expect_used, clippy::panic, reason = "a panic is how a test fails")]

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// What a run of the program left behind.
pub(crate) struct Run {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    pub(crate) fn of(output: Output) -> Self {
        Self {
            status: output.status.code().expect("the program was killed"),
            stdout: String::from_utf8(output.stdout).expect("stdout is text"),
            stderr: String::from_utf8(output.stderr).expect("stderr is text"),
        }
    }
}

/// A folder of its own for one test, in which the program runs.
pub(crate) struct Workplace {
    folder: tempfile::TempDir,
}

impl Workplace {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    pub(crate) fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The program with these arguments, not yet started.
    pub(crate) fn command<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_nephrite"));
        command.args(arguments).current_dir(self.folder.path()).env("RUST_BACKTRACE", "0");
        command
    }

    /// Runs the program with the words of `line`.
    pub(crate) fn run(&self, line: &str) -> Run {
        Run::of(self.command(line.split_whitespace()).output().expect("the program starts"))
    }

    /// Runs the program, which must succeed without a word on stderr.
    pub(crate) fn done(&self, line: &str) -> String {
        let run = self.run(line);
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "nephrite {line}");
        run.stdout
    }

    /// Runs the program with `--json`, which must succeed with one object on stdout.
    pub(crate) fn json(&self, line: &str) -> Value {
        let stdout = self.done(&format!("{line} --json"));
        assert_eq!(stdout.lines().count(), 1, "nephrite {line} --json: {stdout}");
        let value: Value = serde_json::from_str(&stdout).expect("JSON");
        assert!(value.is_object(), "{value}");
        value
    }

    /// Runs the program, which must fail with status 1 and one line on stderr; returns the line.
    pub(crate) fn failure(&self, line: &str) -> String {
        let run = self.run(line);
        assert_eq!(run.status, 1, "nephrite {line}: {}", run.stderr);
        assert_eq!(run.stdout, "", "nephrite {line}");
        assert_eq!(run.stderr.lines().count(), 1, "nephrite {line}: {}", run.stderr);
        run.stderr.trim_end().to_owned()
    }

    /// Names of all files in the folder, sorted, hidden ones too.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("the folder is there");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("a name"))
            .collect();
        names.sort();
        names
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), contents).expect("the file can be written");
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).expect("the file can be read")
    }
}

/// The number under a key.
pub(crate) fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} of {value} is not a number"))
}

/// The whole number under a key.
pub(crate) fn index(value: &Value, key: &str) -> usize {
    let number = value[key].as_u64().and_then(|number| usize::try_from(number).ok());
    number.unwrap_or_else(|| panic!("{key} of {value} is no index"))
}
