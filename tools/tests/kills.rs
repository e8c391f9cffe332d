//! A build that is killed at any moment leaves the old file or the new one under its name, and what
//! it leaves beside it is gone after the next build.
#![cfg(unix)]
#![allow(clippy::expect_used, clippy::cast_possible_truncation, reason = "a panic is how a test fails")]

mod support;

use std::collections::BTreeSet;
use std::collections::hash_map::RandomState;
use std::ffi::OsString;
use std::hash::BuildHasher;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use support::Workplace;

/// Kills in the usual run; `NEPHRITE_KILLS=1000` for a long one.
const N_KILLS: usize = 40;

/// Starts the program and kills it after so many microseconds.
fn kill_after(place: &Workplace, line: &str, microseconds: u64) {
    let mut build = place
        .command(line.split_whitespace())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    thread::sleep(Duration::from_micros(microseconds));
    build.kill().expect("a process of our own");
    build.wait().expect("it ends");
}

#[test]
fn killed_builds_leave_the_old_file_or_the_new_one() {
    let n_kills = n_kills(N_KILLS);
    let place = Workplace::new();
    place.done("generate sphere --triangles 3000 -o in.ply");
    let options = ["--levels 5", "--levels 50"];
    let start = Instant::now();
    let whole = options.map(|options| {
        place.done(&format!("build in.ply -o out.neph {options}"));
        place.read("out.neph")
    });
    let duration_us = start.elapsed().as_micros() as u64 / 2;
    let (mut holds, mut n_published, mut n_left) = (1, 0, 0);
    for kill in 0..n_kills {
        let next = 1 - holds;
        let line = format!("build in.ply -o out.neph {}", options[next]);
        // Half of the kills meet the last fifth, in which the file is written.
        let random = RandomState::new().hash_one(kill);
        let (earliest, length) =
            if kill % 2 == 0 { (0, duration_us) } else { (duration_us * 4 / 5, duration_us / 4) };
        kill_after(&place, &line, earliest + random % length);
        let found = place.read("out.neph");
        let held = whole.iter().position(|whole| *whole == found);
        assert!(held.is_some(), "kill {kill}: {} bytes are neither file", found.len());
        n_published += usize::from(held == Some(next));
        n_left += usize::from(place.files().len() > 2);
        holds = held.unwrap_or(holds);
    }
    println!(
        "{n_kills} kills: {n_published} after the new file was in place, {n_left} left something beside it"
    );
    place.done("build in.ply -o out.neph");
    assert_eq!(place.files(), ["in.ply", "out.neph"]);
    place.done("verify out.neph");
}

/// A database of parts is a folder of files, each whole; the next run makes what is missing.
#[test]
fn killed_databases_hold_whole_files_only() {
    const PARTS: [&str; 5] = ["a", "b", "c", "d", "e"];
    let n_kills = n_kills(N_KILLS / 4);
    let place = Workplace::new();
    for (i, part) in PARTS.into_iter().enumerate() {
        place.done(&format!("generate sphere --triangles {} -o {part}.ply", 600 + 100 * i));
    }
    let parts: String = PARTS.iter().map(|part| format!(" {part}.ply")).collect();
    let start = Instant::now();
    place.done(&format!("build{parts} --output-dir whole"));
    let duration_us = start.elapsed().as_micros() as u64;
    let mut n_whole = 0;
    for kill in 0..n_kills {
        let line = format!("build{parts} --output-dir db");
        kill_after(&place, &line, RandomState::new().hash_one(kill) % duration_us);
        let there =
            PARTS.map(|part| format!("{part}.neph")).map(|file| (place.path(format!("db/{file}")), file));
        let there: Vec<_> = there.into_iter().filter(|(path, _)| path.exists()).collect();
        for (_, file) in &there {
            let same = place.read(&format!("db/{file}")) == place.read(&format!("whole/{file}"));
            assert!(same, "kill {kill}: {file} is not whole");
        }
        // Once all parts are there a new database begins.
        if there.len() == PARTS.len() {
            n_whole += 1;
            place.done(&line);
            std::fs::remove_dir_all(place.path("db")).expect("a folder of our own");
        }
    }
    println!("{n_kills} kills: {n_whole} databases were finished in spite of them");
    place.done(&format!("build{parts} --output-dir db"));
    for part in PARTS {
        assert_eq!(place.read(&format!("db/{part}.neph")), place.read(&format!("whole/{part}.neph")));
    }
    assert_eq!(names(&place.path("db")), names(&place.path("whole")), "nothing is left beside them");
}

fn names(folder: &Path) -> BTreeSet<OsString> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    entries.map(|entry| entry.expect("an entry").file_name()).collect()
}

/// Kills of a usual run, or as many as the environment asks for.
fn n_kills(usual: usize) -> usize {
    std::env::var("NEPHRITE_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(usual)
}
