//! One mesh in, any level of detail out: the whole way as a user goes it.

mod support;

use serde_json::Value;
use support::{Workplace, index, number};

/// Checks that a JSON object has all these keys.
fn assert_keys(value: &Value, keys: &str) {
    for key in keys.split_whitespace() {
        assert!(!value[key].is_null(), "no {key} in {value}");
    }
}

fn built(line: &str) -> (Workplace, Value) {
    let place = Workplace::new();
    place.done(&format!("generate {line} -o in.ply"));
    let build = place.json("build in.ply -o out.neph");
    (place, build)
}

#[test]
fn build_reports_what_the_contract_names() {
    let (place, build) = built("cosine --side 40");
    assert_keys(
        &build,
        "triangles_in vertices_in triangles_stored levels coarsest_triangles max_error bounding_diagonal seconds file_bytes",
    );
    assert_eq!(number(&build, "triangles_in"), 2.0 * 39.0 * 39.0);
    assert_eq!(number(&build, "vertices_in"), 1600.0);
    assert_eq!(number(&build, "file_bytes"), place.read("out.neph").len() as f64);
    assert!(number(&build, "triangles_stored") >= number(&build, "triangles_in"));
    assert!(number(&build, "coarsest_triangles") < 0.1 * number(&build, "triangles_in"));
}

#[test]
fn info_lists_the_curve_finest_first() {
    let (place, build) = built("cosine --side 40");
    let info = place.json("info out.neph");
    for key in "triangles_in vertices_in triangles_stored levels coarsest_triangles max_error bounding_diagonal file_bytes"
        .split_whitespace()
    {
        assert_eq!(info[key], build[key], "{key}");
    }
    let curve = info["curve"].as_array().unwrap();
    assert_eq!(curve.len() as f64, number(&build, "levels"));
    assert_eq!(curve[0]["triangles"], build["triangles_in"]);
    assert_eq!(curve[0]["vertices"], build["vertices_in"]);
    assert_eq!(curve[curve.len() - 1]["triangles"], build["coarsest_triangles"]);
    assert_eq!(curve[curve.len() - 1]["error"], build["max_error"]);
    for pair in curve.windows(2) {
        assert!(number(&pair[0], "error") <= number(&pair[1], "error"));
        assert!(number(&pair[0], "triangles") >= number(&pair[1], "triangles"));
        assert!(number(&pair[0], "vertices") >= number(&pair[1], "vertices"));
    }
    let text = place.done("info out.neph");
    assert!(text.contains("3,042"), "{text}");
}

#[test]
fn extract_takes_each_selector() {
    let (place, build) = built("sphere --triangles 2000");
    let curve = place.json("info out.neph")["curve"].as_array().unwrap().clone();

    let by_level = place.json("extract out.neph --level 1 -o level.ply");
    assert_keys(&by_level, "triangles vertices error level runs seconds");
    assert_eq!(number(&by_level, "level"), 1.0);
    assert_eq!(by_level["triangles"], curve[1]["triangles"]);

    let budget = 500.0;
    let by_triangles = place.json("extract out.neph --triangles 500 -o triangles.ply");
    let level = index(&by_triangles, "level");
    assert!(number(&by_triangles, "triangles") <= budget);
    assert!(number(&curve[level - 1], "triangles") > budget, "a finer level fits the budget");

    let diagonal = number(&build, "bounding_diagonal");
    for (selector, error) in
        [("0.01".to_owned(), 0.01), ("1%".to_owned(), 0.01 * diagonal), ("0".to_owned(), 0.0)]
    {
        let by_error = place.json(&format!("extract out.neph --error {selector} -o error.ply"));
        let level = index(&by_error, "level");
        assert!(number(&by_error, "error") <= error, "{selector}");
        assert!(curve.get(level + 1).is_none_or(|next| number(next, "error") > error), "{selector}");
    }
}

#[test]
fn a_budget_that_no_level_meets_is_told() {
    let (place, build) = built("sphere --triangles 320");
    let run = place.run("extract out.neph --triangles 1 -o least.ply");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("coarsest") && run.stderr.lines().count() == 1, "{}", run.stderr);
    let (mesh, _) = nephrite_formats::read_mesh(place.path("least.ply")).unwrap();
    assert_eq!(mesh.triangles.len(), index(&build, "coarsest_triangles"));
}

#[test]
fn extracted_meshes_have_the_counts_that_were_reported() {
    let (place, _) = built("torus --segments 40 --sides 20");
    for extension in ["ply", "obj", "stl", "off", "glb"] {
        let file = format!("lod.{extension}");
        let extract = place.json(&format!("extract out.neph --error 1% -o {file}"));
        let (mesh, _) = nephrite_formats::read_mesh(place.path(&file)).unwrap();
        assert_eq!(mesh.triangles.len() as f64, number(&extract, "triangles"), "{file}");
        assert_eq!(mesh.positions.len() as f64, number(&extract, "vertices"), "{file}");
    }
}

#[test]
fn level_zero_is_the_input() {
    let (place, _) = built("plate --columns 2 --rows 1 --segments 16");
    place.done("extract out.neph --level 0 -o same.ply");
    let sorted = |name: &str| {
        let (mesh, _) = nephrite_formats::read_mesh(place.path(name)).unwrap();
        let corner = |v: u32| mesh.positions[v as usize].map(f32::to_bits);
        let mut triangles: Vec<_> = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let mut corners = triangle.map(corner);
                let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
                corners.rotate_left(least);
                corners
            })
            .collect();
        triangles.sort_unstable();
        triangles
    };
    assert_eq!(sorted("in.ply"), sorted("same.ply"));
}

#[test]
fn a_built_file_verifies_and_a_damaged_one_does_not() {
    let (place, _) = built("cosine --side 30");
    assert!(place.done("verify out.neph").contains("out.neph"));
    assert_eq!(place.json("verify out.neph")["ok"], true);
    let mut bytes = place.read("out.neph");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    place.write("out.neph", bytes);
    let line = place.failure("verify out.neph");
    assert!(line.contains("out.neph"), "{line}");
}

#[test]
fn a_build_stops_at_the_error_asked_for() {
    let place = Workplace::new();
    place.done("generate cosine --side 40 -o in.ply");
    let build = place.json("build in.ply -o out.neph --max-error 0.5%");
    assert!(number(&build, "max_error") <= 0.005 * number(&build, "bounding_diagonal"));
    let whole = place.json("build in.ply -o whole.neph");
    assert!(number(&build, "coarsest_triangles") > number(&whole, "coarsest_triangles"));
}

#[test]
fn levels_limits_their_number() {
    let place = Workplace::new();
    place.done("generate sphere --triangles 2000 -o in.ply");
    let few = place.json("build in.ply -o few.neph --levels 8");
    let all = place.json("build in.ply -o all.neph");
    assert!(number(&few, "levels") <= 8.0 && number(&few, "levels") >= 2.0, "{few}");
    assert!(number(&all, "levels") > 8.0);
    assert_eq!(few["coarsest_triangles"], all["coarsest_triangles"]);
    assert!(number(&few, "triangles_stored") < number(&all, "triangles_stored"));
}

#[test]
fn every_bound_builds() {
    let place = Workplace::new();
    place.done("generate cosine --side 30 -o in.ply");
    for bound in ["certified", "joint", "removed", "accumulated"] {
        let build = place.json(&format!("build in.ply -o {bound}.neph --bound {bound} --max-error 1%"));
        assert!(number(&build, "max_error") <= 0.01 * number(&build, "bounding_diagonal"), "{bound}");
        assert!(number(&build, "coarsest_triangles") < 0.5 * number(&build, "triangles_in"), "{bound}");
        place.done(&format!("verify {bound}.neph"));
    }
}

#[test]
fn vertices_move_when_asked_and_only_under_the_proof() {
    let (place, kept) = built("torus --segments 60 --sides 30");
    let moved = place.json("build in.ply -o moved.neph --placement best");
    assert!(number(&moved, "triangles_stored") > number(&kept, "triangles_stored"));
    assert_eq!(moved["bounding_diagonal"], kept["bounding_diagonal"]);
    place.done("verify moved.neph --bound");
    assert!(place.done("info moved.neph").contains("best placement"));
}

/// Promise: a file that the program makes states its method and bound, and its errors are proven
/// from it.
#[test]
fn the_demonstration_writes_a_file_whose_errors_are_proven() {
    let place = Workplace::new();
    place.done("demo -o demo");
    let info = place.json("info demo/ripple.neph");
    assert_eq!((&info["method"], &info["bound"]), (&"jade".into(), &"certified".into()));
    assert_eq!(number(&info, "triangles_in"), 28_322.0);
    assert!(info["repairs"].is_object() && info["options"].is_object(), "{info}");
    place.done("verify demo/ripple.neph --bound --bound-levels 3");
}

#[test]
fn constants_of_the_estimates_have_an_effect() {
    let place = Workplace::new();
    place.done("generate terrain --side 24 -o in.ply");
    for (name, loss) in [("kept", 0.0), ("lost", 1.0)] {
        place.done(&format!("build in.ply -o {name}.neph --bound joint --jade-aspect-loss {loss}"));
        let info = place.json(&format!("info {name}.neph"));
        assert_eq!(info["options"]["jade"]["aspect_loss"], loss);
    }
    let curve = |name: &str| place.json(&format!("info {name}.neph"))["curve"].clone();
    assert_ne!(curve("kept"), curve("lost"));
}

#[test]
fn bench_stands_beside_memcpy() {
    let (place, _) = built("cosine --side 60");
    let bench = place.json("bench out.neph");
    let cuts = bench["cuts"].as_array().unwrap();
    assert!(cuts.len() >= 3, "{bench}");
    for cut in cuts {
        assert_keys(
            cut,
            "triangles runs query_ns extract_triangles_per_second memcpy_triangles_per_second ratio",
        );
        assert!(number(cut, "ratio") > 0.0);
    }
}

#[test]
fn the_demo_writes_levels_to_open() {
    let place = Workplace::new();
    let text = place.done("demo");
    assert!(text.contains("28,322"), "{text}");
    let demo = place.json("demo -o elsewhere");
    let written = demo["written"].as_array().unwrap();
    assert!(written.len() >= 2);
    for file in written {
        let path = place.path(file.as_str().unwrap());
        let (mesh, _) = nephrite_formats::read_mesh(&path).unwrap();
        assert!(mesh.triangles.len() < 28_322);
    }
    assert_eq!(place.files(), ["elsewhere", "nephrite-demo"]);
}

#[test]
fn verify_proves_certified_errors_anew_and_refuses_estimates() {
    let (place, build) = built("cosine --side 24");
    let verified = place.json("verify out.neph --bound");
    assert_eq!(number(&verified, "levels_proven"), number(&build, "levels") - 1.0);
    let few = place.json("verify out.neph --bound --bound-levels 3");
    assert_eq!(number(&few, "levels_proven"), 3.0);
    place.done("build in.ply -o joint.neph --bound joint");
    let line = place.failure("verify joint.neph --bound");
    assert!(line.contains("joint.neph") && line.contains("certified"), "{line}");
}
