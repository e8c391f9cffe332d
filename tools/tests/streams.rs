//! Meshes and files go through standard input and output as they go through files, and results stay
//! out of their way.

#![allow(clippy::expect_used, reason = "a panic is how a test fails")]

mod support;

use std::io::Write;
use std::process::Stdio;
use std::thread;

use serde_json::Value;
use support::{Workplace, number};

/// Runs the program with bytes on standard input; returns standard output and standard error. It
/// must succeed.
fn filter(place: &Workplace, line: &str, input: Vec<u8>) -> (Vec<u8>, String) {
    let mut command = place.command(line.split_whitespace());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("piped");
    // The program may write before it has read all. It may also end early, which its status tells.
    let writer = thread::spawn(move || _ = stdin.write_all(&input));
    let output = child.wait_with_output().expect("the program ends");
    writer.join().expect("it only writes");
    let stderr = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(0), "nephrite {line}: {stderr}");
    (output.stdout, stderr)
}

#[test]
fn a_surface_goes_through_pipes() {
    let place = Workplace::new();
    let (mesh, report) = filter(&place, "generate torus -o - --output-format stl", vec![]);
    assert_eq!(report, "standard output: 50,000 triangles, 25,000 vertices\n");
    place.done("generate torus -o in.stl");
    assert!(mesh == place.read("in.stl"));
    place.done("build in.stl -o out.neph");
    // The contents of a binary STL say little: its length does, or the format that is named.
    for format in ["", "--input-format stl"] {
        let (file, report) = filter(&place, &format!("build - -o - {format}"), mesh.clone());
        assert!(file == place.read("out.neph"));
        assert!(report.starts_with("standard output\n  mesh      50,000 triangles"), "{report}");
    }
    let file = place.read("out.neph");

    place.done("extract out.neph --triangles 10% -o lod.ply");
    let line = "extract - --triangles 10% -o - --output-format ply --json";
    let (level, report) = filter(&place, line, file.clone());
    assert!(level == place.read("lod.ply"));
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let n = number(&report, "triangles");
    assert!((4_800.0..=5_000.0).contains(&n), "{n}");

    for command in ["info", "verify"] {
        let (text, _) = filter(&place, &format!("{command} -"), file.clone());
        assert!(text.starts_with(b"standard input"), "{command}");
    }
    let (picture, _) = filter(&place, "plot - -o -", file);
    assert!(picture.starts_with(b"<svg "));
    let (measured, _) = filter(&place, "measure in.stl - --samples 1000 --json", level);
    let measured: Value = serde_json::from_slice(&measured).expect("JSON");
    assert!(number(&measured, "lower_bound") <= number(&report, "error"));
}

#[test]
fn a_volume_goes_through_pipes() {
    let place = Workplace::new();
    let (mesh, _) = filter(&place, "generate ball --cells 6 -o - --output-format vtu", vec![]);
    let (file, _) = filter(&place, "build - -o -", mesh.clone());
    let (level, report) = filter(&place, "extract - --tetrahedra 50% -o - --output-format vtk --json", file);
    let report: Value = serde_json::from_str(&report).expect("JSON");
    assert!(number(&report, "tetrahedra") <= 540.0, "{report}");
    place.write("in.vtu", mesh);
    let (measured, _) = filter(&place, "measure in.vtu - --samples 1000 --json", level);
    let measured: Value = serde_json::from_slice(&measured).expect("JSON");
    assert!(number(&measured, "lower_bound") <= number(&report, "error"));
}

#[test]
fn what_cannot_be_read_from_a_stream_is_told() {
    let place = Workplace::new();
    place.write("empty", "");
    for (line, what) in [
        ("info - ", "standard input: "),
        ("measure - empty", "standard input: "),
        ("build - -o out.neph", "standard input: "),
        ("extract - --level 0 -o lod.ply", "standard input: "),
    ] {
        let mut command = place.command(line.split_whitespace());
        let output = command.stdin(Stdio::null()).output().expect("the program starts");
        let stderr = String::from_utf8(output.stderr).expect("text");
        assert_eq!((output.status.code(), stderr.lines().count()), (Some(1), 1), "{line}: {stderr}");
        assert!(stderr.contains(what), "{line}: {stderr}");
    }
    assert_eq!(place.files(), ["empty"]);
}
