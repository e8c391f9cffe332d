//! `measure` says what the contract names, agrees with closed forms, and writes what it is asked
//! to.

mod support;

use support::{Workplace, number};

/// A unit square at a height, as OFF text.
fn square(z: f64) -> String {
    format!("OFF\n4 2 0\n0 0 {z}\n1 0 {z}\n1 1 {z}\n0 1 {z}\n3 0 1 2\n3 0 2 3\n")
}

fn squares() -> Workplace {
    let place = Workplace::new();
    place.write("low.off", square(0.0));
    place.write("high.off", square(0.25));
    place
}

#[test]
fn the_contract_has_its_keys() {
    let found = squares().json("measure low.off high.off --samples 1000");
    for key in ["max", "mean", "rms", "max_forward", "max_backward", "lower_bound", "upper_bound"] {
        let value = number(&found, key);
        assert!((value - 0.25).abs() < 0.0026, "{key} is {value}");
    }
    assert!((number(&found, "bounding_diagonal") - 2f64.sqrt()).abs() < 1e-12);
    assert!((number(&found, "max") - 0.25).abs() < 1e-12);
    assert!(number(&found, "lower_bound") <= 0.25 && 0.25 <= number(&found, "upper_bound"));
    assert!(number(&found["forward"], "area_mean") > 0.0);
}

#[test]
fn one_direction_may_be_zero() {
    let place = squares();
    place.write("half.off", "OFF\n4 2 0\n0 0 0\n0.5 0 0\n0.5 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    let found = place.json("measure low.off half.off --samples 1000");
    assert!((number(&found, "max_forward") - 0.5).abs() < 1e-12);
    assert!(number(&found, "max_backward") < 1e-12);
    let text = place.done("measure half.off low.off --samples 1000");
    assert!(text.contains("mesh to reference") && text.contains("0.5000"), "{text}");
}

#[test]
fn threads_change_nothing_but_the_time() {
    let place = Workplace::new();
    place.done("generate cosine --side 30 -o fine.ply");
    place.done("generate cosine --side 12 -o coarse.ply");
    let run = |n_threads: u32| {
        let mut found =
            place.json(&format!("measure fine.ply coarse.ply --samples 5000 --threads {n_threads}"));
        found["seconds"].take();
        found
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn colours_and_histogram_are_written() {
    let place = Workplace::new();
    place.done("generate cosine --side 30 -o fine.ply");
    place.done("generate cosine --side 12 -o coarse.ply");
    place.done("measure fine.ply coarse.ply --samples 5000 --colour out.ply --plot out.svg");
    let (mesh, _) = nephrite_formats::read_mesh(place.path("out.ply")).unwrap();
    let color = mesh.attribute("color").unwrap();
    let distance = mesh.attribute("distance").unwrap();
    assert_eq!(
        (color.bytes.len(), distance.bytes.len()),
        (3 * mesh.positions.len(), 4 * mesh.positions.len())
    );
    let svg = String::from_utf8(place.read("out.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    assert!(svg.contains("from the mesh to the reference") && svg.contains("fine.ply"));
}

#[test]
fn a_bracket_that_stays_wide_is_told() {
    let place = Workplace::new();
    // The farthest points of the one lie midway between the parts of the other, at no corner.
    place.write("apart.off", "OFF\n6 2 0\n0 0 0\n0 3 0\n0 0 3\n7 0 0\n7 2 0\n7 0 2\n3 0 1 2\n3 3 4 5\n");
    place.write("between.off", "OFF\n3 1 0\n1 0 0\n6 0 1\n5 1 0\n3 0 1 2\n");
    let run = place.run("measure apart.off between.off --samples 10 --tolerance 1e-6 --max-pieces 10 --json");
    assert_eq!(run.status, 0);
    assert!(run.stderr.contains("wider"), "{}", run.stderr);
    assert!(run.stdout.contains("\"is_within_tolerance\":false"));
}

#[test]
fn what_is_no_surface_is_refused() {
    let place = squares();
    place.write("points.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
    place.write("nan.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n");
    place.write("empty.off", "");
    for bad in ["points.off", "nan.off", "empty.off", "missing.off"] {
        for line in [format!("measure {bad} low.off"), format!("measure low.off {bad}")] {
            assert!(place.failure(&line).contains(bad), "{line}");
        }
    }
    let files = place.files();
    assert!(place.failure("measure low.off high.off --colour low.off").contains("low.off"));
    assert!(place.failure("measure low.off high.off --plot none/out.svg").contains("none"));
    assert_eq!(place.files(), files);
}
