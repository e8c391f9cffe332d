//! A database of parts is built beside the parts that are bad, goes on where it was, and leaves alone what is unchanged.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;

use serde_json::Value;
use support::{Workplace, index};

fn manifest(workplace: &Workplace) -> Vec<Value> {
    let text = String::from_utf8(workplace.read("db/manifest.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn bad_parts_are_listed_and_stop_nobody() {
    let workplace = Workplace::new();
    for side in 8..14 {
        workplace.done(&format!("generate cosine --side {side} -o part{side}.ply"));
    }
    workplace.write("bad.stl", "solid nothing");
    let line = "build . --output-dir db --method progressive --bound accumulated";
    let run = workplace.run(line);
    assert!(run.status == 1 && run.stderr.contains("1 of 7 parts failed"), "{}", run.stderr);
    let lines = manifest(&workplace);
    assert_eq!(lines.len(), 7);
    assert!(lines[0]["reason"].is_string(), "{}", lines[0]);
    for line in &lines[1..] {
        assert!(line["curve"].as_array().unwrap().len() > 2);
        assert_eq!(index(line, "coarsest_triangles"), 0);
    }
    workplace.done("verify db/part8.neph");
}

#[test]
fn a_second_run_builds_only_what_changed() {
    let workplace = Workplace::new();
    for side in 8..12 {
        workplace.done(&format!("generate cosine --side {side} -o part{side}.ply"));
    }
    let line = "build part8.ply part9.ply part10.ply part11.ply --output-dir db --method progressive";
    assert_eq!(index(&workplace.json(line), "parts_unchanged"), 0);
    let before = workplace.read("db/manifest.jsonl");
    assert_eq!(index(&workplace.json(line), "parts_unchanged"), 4);
    assert!(workplace.read("db/manifest.jsonl") == before);
    workplace.done("generate cosine --side 15 -o part9.ply");
    assert_eq!(index(&workplace.json(line), "parts_unchanged"), 3);
    // A run that was stopped leaves a manifest that ends in the middle of a line.
    let manifest = workplace.read("db/manifest.jsonl");
    workplace.write("db/manifest.jsonl", &manifest[..manifest.len() - 20]);
    assert_eq!(index(&workplace.json(line), "parts_unchanged"), 3);
    assert_eq!(index(&workplace.json(&format!("{line} --levels 5")), "parts"), 4);
}
