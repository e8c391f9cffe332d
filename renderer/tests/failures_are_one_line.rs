//! Promise: the program writes whole pictures and one JSON object, or fails with one line.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use nephrite::{BuildOptions, StoreOptions, generate};
use std::path::Path;
use std::process::{Command, Output};

fn renderer(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephrite-renderer"));
    command.current_dir(folder);
    command
}

fn write_levels(path: &Path) {
    let mesh = generate::torus(30, 15);
    let build = nephrite::build(&mesh, &BuildOptions::default()).unwrap();
    build.write(path, &StoreOptions::default()).unwrap();
}

/// The line of the program itself; drivers write other lines.
fn failure(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("nephrite-renderer: ")).collect();
    assert_eq!(lines.len(), 1, "{text}");
    lines[0].to_owned()
}

#[test]
fn a_flight_writes_its_pictures_and_its_statistics() {
    let folder = tempfile::tempdir().unwrap();
    write_levels(&folder.path().join("torus.neph"));
    let arguments =
        ["torus.neph", "--instances", "30", "--size", "90x60", "--frames", "3", "-o", "f.png", "--json"];
    let output = renderer(folder.path()).args(arguments).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let statistics: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let frames = statistics["frames"].as_array().unwrap();
    assert_eq!((frames.len(), &statistics["instances"]), (3, &30.into()));
    for frame in frames {
        let number = |key: &str| frame[key].as_u64().unwrap();
        assert!(number("triangles") > 0 && number("triangles") < number("triangles_finest"));
        assert!(number("draws") >= number("levels") && number("query_ns") > 0);
    }
    for name in ["f-000.png", "f-001.png", "f-002.png"] {
        let file = std::fs::File::open(folder.path().join(name)).unwrap();
        let picture = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        assert_eq!((picture.info().width, picture.info().height), (90, 60));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4, "nothing else is left behind");
}

#[test]
fn what_cannot_be_drawn_is_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("text.neph"), "no levels").unwrap();
    write_levels(&folder.path().join("damaged.neph"));
    let mut bytes = std::fs::read(folder.path().join("damaged.neph")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(folder.path().join("damaged.neph"), bytes).unwrap();
    for name in ["missing.neph", "text.neph", "damaged.neph"] {
        let line = failure(&renderer(folder.path()).arg(name).output().unwrap());
        assert!(line.contains(name), "{line}");
    }
    let line = failure(&renderer(folder.path()).args(["--size", "0x10"]).output().unwrap());
    assert!(line.contains("0 by 10 pixels"), "{line}");
}

#[test]
fn a_machine_without_a_driver_is_told_which_package_to_install() {
    let folder = tempfile::tempdir().unwrap();
    let nowhere = [("VK_DRIVER_FILES", "/nowhere.json"), ("VK_ICD_FILENAMES", "/nowhere.json")];
    let line = failure(&renderer(folder.path()).envs(nowhere).output().unwrap());
    assert!(line.contains("mesa-vulkan-drivers"), "{line}");
}
