//! Builds that run at once, into one folder or even to one output, do not get in each other's way.
#![allow(clippy::expect_used, reason = "a panic is how a test fails")]

mod support;

use std::process::{Child, Stdio};

use support::Workplace;

fn start(place: &Workplace, line: &str) -> Child {
    let mut command = place.command(line.split_whitespace());
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
}

fn finish(builds: Vec<Child>) {
    for build in builds {
        let output = build.wait_with_output().expect("it ends");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn into_one_folder() {
    let place = Workplace::new();
    place.done("generate sphere --triangles 1000 -o in.ply");
    place.done("build in.ply -o alone.neph");
    finish((0..12).map(|i| start(&place, &format!("build in.ply -o out{i}.neph --threads 1"))).collect());
    assert_eq!(place.files().len(), 14);
    for i in 0..12 {
        assert_eq!(place.read(&format!("out{i}.neph")), place.read("alone.neph"));
    }
}

#[test]
fn of_one_output() {
    let place = Workplace::new();
    place.done("generate sphere --triangles 1000 -o in.ply");
    let whole: Vec<Vec<u8>> = (2..10)
        .map(|levels| {
            place.done(&format!("build in.ply -o out.neph --levels {levels}"));
            place.read("out.neph")
        })
        .collect();
    for _ in 0..3 {
        let builds =
            (2..10).map(|levels| start(&place, &format!("build in.ply -o out.neph --levels {levels}")));
        finish(builds.collect());
        assert!(whole.contains(&place.read("out.neph")));
        assert_eq!(place.files(), ["in.ply", "out.neph"]);
    }
}
