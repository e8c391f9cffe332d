//! Promise: a change to the file of an open `Lod` has the documented outcome and no other. A `Lod`
//! that was read does not notice. A mapped `Lod` keeps a file that is replaced or deleted, ends
//! with SIGBUS if it is truncated, and gives answers in range if it is overwritten. The reader is a
//! separate process.
#![expect(unsafe_code, reason = "files are mapped here, and breaking the contract is the point")]
#![cfg(unix)]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test that cannot go on has failed"
)]

mod support;

use nephrite::Lod;
use std::fs::{self, OpenOptions};
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use support::synthetic::{decimate, grid};

const SIGBUS: i32 = 7;

/// Several hundred kilobytes, so that most pages are not read when the file is opened.
fn bytes() -> Vec<u8> {
    let mesh = grid(60);
    support::file_bytes(&mesh, &decimate(&mesh, usize::MAX, 3), None)
}

/// The reader: opens the file, says so, waits for a line, and uses everything.
#[test]
#[ignore = "the process that other tests start"]
fn reader() {
    let (path, way) = (std::env::var("NEPHRITE_FILE").unwrap(), std::env::var("NEPHRITE_WAY").unwrap());
    let lod = match way.as_str() {
        "open" => Lod::open(&path).unwrap(),
        // SAFETY: broken on purpose, in a process that may end by it; the parent checks what
        // happens.
        _ => unsafe { Lod::map(&path) }.unwrap(),
    };
    println!("\nopened");
    std::io::stdin().read_line(&mut String::new()).unwrap();
    let n_slots = lod.indices().len() / 3;
    for level in 0..lod.n_levels() {
        let cut = lod.at_level(level);
        assert!(cut.runs().all(|run| run.range().end <= n_slots));
        let mut indices = vec![0; cut.n_indices()];
        cut.extract_into(&mut indices).unwrap();
        let _ = cut.to_mesh();
    }
    println!("\n{}", if lod.verify().is_ok() { "same" } else { "damaged" });
}

/// What a reader prints and how it ends when `change` is applied to its file.
fn outcome(way: &str, change: impl FnOnce(&Path)) -> (String, ExitStatus) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file.neph");
    fs::write(&path, bytes()).unwrap();
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "reader", "--ignored", "--nocapture"])
        .env("NEPHRITE_FILE", &path)
        .env("NEPHRITE_WAY", way)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut stdout = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    while line.trim() != "opened" {
        line.clear();
        assert_ne!(stdout.read_line(&mut line).unwrap(), 0, "the reader did not open the file");
    }
    change(&path);
    child.stdin.take().unwrap().write_all(b"\n").unwrap();
    let mut said = String::new();
    stdout.read_to_string(&mut said).unwrap();
    let word = said.lines().find(|line| ["same", "damaged"].contains(line)).unwrap_or("nothing");
    (word.to_owned(), child.wait().unwrap())
}

fn replace(path: &Path) {
    let other = path.with_extension("new");
    fs::write(&other, b"another file").unwrap();
    fs::rename(other, path).unwrap();
}

fn delete(path: &Path) {
    fs::remove_file(path).unwrap();
}

fn truncate(path: &Path) {
    OpenOptions::new().write(true).open(path).unwrap().set_len(20_000).unwrap();
}

fn write_over(path: &Path) {
    OpenOptions::new().write(true).open(path).unwrap().write_all(&vec![0xa5; bytes().len()]).unwrap();
}

#[test]
fn a_file_that_was_read_is_kept_whatever_happens() {
    for change in [replace, delete, truncate, write_over] {
        let (word, status) = outcome("open", change);
        assert!(word == "same" && status.success(), "{word}, {status}");
    }
}

#[test]
fn a_mapped_file_is_kept_when_it_is_replaced_or_deleted() {
    for change in [replace, delete] {
        let (word, status) = outcome("map", change);
        assert!(word == "same" && status.success(), "{word}, {status}");
    }
}

#[test]
fn a_mapped_file_that_is_truncated_ends_the_process() {
    let (word, status) = outcome("map", truncate);
    assert_eq!((word.as_str(), status.signal()), ("nothing", Some(SIGBUS)));
}

#[test]
fn a_mapped_file_that_is_written_over_gives_answers_in_range() {
    let (word, status) = outcome("map", write_over);
    assert!(word == "damaged" && status.success(), "{word}, {status}");
}
