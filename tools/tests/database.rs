//! A database of parts is built beside the parts that are bad, goes on where it was, and leaves
//! alone what is unchanged.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;

use serde_json::Value;
use std::collections::BTreeSet;
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
fn what_is_no_list_of_ours_is_left_alone() {
    let workplace = Workplace::new();
    workplace.done("generate cosine --side 8 -o part.ply");
    std::fs::create_dir(workplace.path("db")).unwrap();
    workplace.write("db/manifest.jsonl", "dear diary\n");
    let line = "build part.ply --output-dir db";
    let failure = workplace.failure(line);
    assert!(failure.ends_with("is not the manifest of a database"), "{failure}");
    assert_eq!(workplace.read("db/manifest.jsonl"), b"dear diary\n");
    #[cfg(unix)]
    {
        workplace.write("diary", "{dear");
        std::fs::remove_file(workplace.path("db/manifest.jsonl")).unwrap();
        std::os::unix::fs::symlink("../diary", workplace.path("db/manifest.jsonl")).unwrap();
        let failure = workplace.failure(line);
        assert!(failure.ends_with("manifest.jsonl: is not a regular file"), "{failure}");
        assert_eq!(workplace.read("diary"), b"{dear");
    }
}

#[test]
fn one_build_at_a_time_works_on_a_database() {
    let workplace = Workplace::new();
    workplace.done("generate cosine --side 8 -o part.ply");
    let line = "build part.ply --output-dir db";
    workplace.done(line);
    let list = std::fs::File::open(workplace.path("db/manifest.jsonl")).unwrap();
    list.lock().unwrap();
    let failure = workplace.failure(line);
    assert!(failure.ends_with("is being written by another build"), "{failure}");
    drop(list);
    workplace.done(line);
}

#[test]
fn no_part_is_replaced_by_a_file_or_shares_one_with_another() {
    let workplace = Workplace::new();
    workplace.done("generate cosine --side 8 -o part.ply");
    std::fs::rename(workplace.path("part.ply"), workplace.path("part.neph")).unwrap();
    let before = workplace.read("part.neph");
    let run = workplace.run("build part.neph --output-dir .");
    assert!(run.status == 1 && run.stderr.contains("is the input"), "{}", run.stderr);
    assert!(workplace.read("part.neph") == before);
    // The second names of two equal parts are the first name of a third.
    for folder in ["a", "b"] {
        std::fs::create_dir(workplace.path(folder)).unwrap();
        workplace.write(&format!("{folder}/x.ply"), &before);
    }
    workplace.done("build a/x.ply b/x.ply --output-dir db");
    let lines = manifest(&workplace);
    let second = lines[1]["output"].as_str().unwrap().strip_prefix("db/").unwrap().replace(".neph", ".ply");
    workplace.write(&second, &before);
    workplace.done(&format!("build a/x.ply b/x.ply {second} --output-dir db"));
    let lines = manifest(&workplace);
    let outputs: BTreeSet<&str> = lines.iter().map(|line| line["output"].as_str().unwrap()).collect();
    assert_eq!((lines.len(), outputs.len()), (3, 3), "{outputs:?}");
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

#[test]
fn folders_of_folders_are_parts_too() {
    let workplace = Workplace::new();
    std::fs::create_dir_all(workplace.path("parts/a/deep")).unwrap();
    std::fs::create_dir_all(workplace.path("empty/inside")).unwrap();
    for part in ["parts/top.ply", "parts/a/axle.stl", "parts/a/deep/wheel.obj"] {
        workplace.done(&format!("generate cosine --side 8 -o {part}"));
    }
    workplace.write("parts/notes.txt", "to do");
    workplace.write("parts/a/deep/wheel.mtl", "newmtl steel");
    let run = workplace.json("build parts --output-dir parts/db");
    assert_eq!(index(&run, "parts"), 3);
    assert_eq!(run["left_out"], serde_json::json!(["parts/notes.txt"]));
    for name in ["top", "axle", "wheel"] {
        assert!(workplace.path(format!("parts/db/{name}.neph")).exists(), "{name}");
    }
    // The database lies among the parts and is not one of them.
    let text = workplace.done("build parts --output-dir parts/db");
    assert!(text.contains("3 parts, 3 of them unchanged") && text.contains("notes.txt"), "{text}");
    let failure = workplace.failure("build empty --output-dir none");
    assert!(failure.ends_with("empty: no mesh or volume in it"), "{failure}");
    assert!(!workplace.path("none").exists());
}
