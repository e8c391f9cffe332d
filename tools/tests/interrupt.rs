//! An interrupt ends a build with status 130 and leaves the folder as it was.
#![cfg(unix)]

mod support;

use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use support::Workplace;

#[test]
fn an_interrupted_build_leaves_nothing() {
    let place = Workplace::new();
    place.done("generate terrain --side 500 -o in.ply");
    // From before the mesh is read to the midst of decimation, which takes seconds for half a million triangles.
    for milliseconds in [100, 400, 1000] {
        let build = place
            .command(["build", "in.ply", "-o", "out.neph"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        thread::sleep(Duration::from_millis(milliseconds));
        let killed = Command::new("kill").args(["-INT", &build.id().to_string()]).status();
        assert!(killed.expect("kill is there").success());
        let output = build.wait_with_output().expect("the program ends");
        assert_eq!(output.status.code(), Some(130), "after {milliseconds} ms");
        let stderr = String::from_utf8(output.stderr).expect("text");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        assert_eq!(place.files(), ["in.ply"], "after {milliseconds} ms");
    }
}

/// A measurement asks nobody between its samples; it does not take over the interrupt and ends at once.
#[test]
fn a_measurement_without_end_is_interrupted() {
    let place = Workplace::new();
    place.done("generate sphere --triangles 300 -o in.ply");
    let samples = ["measure", "in.ply", "in.ply", "--samples", "99999999999999"];
    let mut measure = place.command(samples).stdout(Stdio::null()).spawn().expect("the program starts");
    thread::sleep(Duration::from_millis(300));
    let killed = Command::new("kill").args(["-INT", &measure.id().to_string()]).status();
    assert!(killed.expect("kill is there").success());
    // Where the tests were started with interrupts ignored, so is this one: then it would never end by itself.
    for _ in 0..100 {
        if measure.try_wait().expect("its status is known").is_some() {
            break;
        }
        thread::sleep(Duration::from_millis(300));
    }
    // An error where it has ended, as it should have.
    let _ = measure.kill();
    let status = measure.wait().expect("the program ends");
    assert_eq!(status.signal(), Some(2), "{status}: were the tests started with interrupts ignored?");
}
