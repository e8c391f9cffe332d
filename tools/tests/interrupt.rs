//! An interrupt ends a build with status 130 and leaves the folder as it was.
//!
//! No test guesses how fast the machine is: the program reads its mesh from standard input, so a
//! test knows what the program has read before it sends the signal.
#![cfg(unix)]
#![allow(clippy::expect_used, reason = "a panic is how a test fails")]

mod support;

use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread;
use std::time::Duration;

use support::Workplace;

/// More than a pipe holds: the program has begun to read when so many bytes are written.
const MORE_THAN_A_PIPE_HOLDS: usize = 1 << 20;

/// A terrain of 498,002 triangles, which takes seconds to decimate.
fn terrain(place: &Workplace) -> Vec<u8> {
    place.done("generate terrain --side 500 -o in.ply");
    let bytes = place.read("in.ply");
    assert!(bytes.len() > 4 * MORE_THAN_A_PIPE_HOLDS);
    bytes
}

fn start(place: &Workplace, line: &str) -> (Child, ChildStdin) {
    let mut command = place.command(line.split_whitespace());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let stdin = child.stdin.take().expect("piped");
    (child, stdin)
}

fn interrupt(child: &Child) {
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.expect("kill is there").success());
}

fn assert_interrupted(place: &Workplace, child: Child, when: &str) {
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(130), "{when}");
    let stderr = String::from_utf8(output.stderr).expect("text");
    assert_eq!(stderr, "nephrite: interrupted, nothing was written\n", "{when}");
    assert_eq!(place.files(), ["in.ply"], "{when}");
}

#[test]
fn an_interrupted_build_leaves_nothing() {
    let place = Workplace::new();
    let mesh = terrain(&place);
    for method in ["jade", "progressive"] {
        let line = format!("build - -o out.neph --method {method}");

        let (child, mut stdin) = start(&place, &line);
        let (first, rest) = mesh.split_at(MORE_THAN_A_PIPE_HOLDS);
        stdin.write_all(first).expect("the program reads");
        interrupt(&child);
        stdin.write_all(rest).expect("the program reads on");
        drop(stdin);
        assert_interrupted(&place, child, &format!("{method}, while the mesh is read"));

        let (child, mut stdin) = start(&place, &line);
        stdin.write_all(&mesh).expect("the program reads");
        drop(stdin);
        interrupt(&child);
        assert_interrupted(&place, child, &format!("{method}, after the mesh was read"));
    }
}

/// A measurement asks nobody between its samples: it does not take over the interrupt and ends at
/// once.
#[test]
fn a_measurement_without_end_is_interrupted() {
    let place = Workplace::new();
    let mesh = terrain(&place);
    let (mut measure, mut stdin) = start(&place, "measure - in.ply --samples 99999999999999");
    stdin.write_all(&mesh).expect("the program reads");
    drop(stdin);
    interrupt(&measure);
    // If interrupts are ignored where the tests run, the program inherits that and would never end.
    for _ in 0..100 {
        if measure.try_wait().expect("its status is known").is_some() {
            break;
        }
        thread::sleep(Duration::from_millis(300));
    }
    // An error if the program has ended, as it should have.
    let _ = measure.kill();
    let status = measure.wait().expect("the program ends");
    assert_eq!(status.signal(), Some(2), "{status}: were the tests started with interrupts ignored?");
}
