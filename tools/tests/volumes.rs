//! Volumes go the same way as surfaces: generated, built, looked into, taken out and measured.

mod support;

use support::{Workplace, number};

#[test]
fn a_volume_goes_the_whole_way() {
    let place = Workplace::new();
    place.done("generate ball --cells 10 -o in.vtu");
    let build = place.json("build in.vtu -o out.neph --method fusion --field-weight 0.5");
    for key in "tetrahedra_in vertices_in tetrahedra_stored levels coarsest_tetrahedra max_error bounding_diagonal seconds file_bytes"
        .split(' ')
    {
        assert!(build[key].is_number(), "no {key} in {build}");
    }
    assert_eq!(number(&build, "tetrahedra_in"), 5000.0);
    assert!(number(&build, "coarsest_tetrahedra") < 1500.0);
    assert!(number(&build["deviations"], "radius") > 0.0);

    let info = place.json("info out.neph");
    assert_eq!(number(&info, "tetrahedra_in"), 5000.0);
    assert_eq!(number(&info["curve"][0], "tetrahedra"), 5000.0);
    assert_eq!(info["deviations"][1]["name"], "radius");
    place.done("verify out.neph");

    let extract = place.json("extract out.neph --tetrahedra 2500 -o lod.vtu");
    let n = number(&extract, "tetrahedra");
    assert!((1500.0..=2500.0).contains(&n), "{n}");
    assert!(number(&extract["deviations"], "radius") <= number(&build["deviations"], "radius"));
    place.done("extract out.neph --tetrahedra 2500 -o lod.vtk");
    let boundary = place.json("extract out.neph --tetrahedra 2500 --boundary -o lod.ply");
    assert!(number(&boundary, "triangles") > 0.0);
    let slice = place.json("extract out.neph --tetrahedra 2500 --slice 0,0,-1,0.1 -o slice.ply");
    assert!(number(&slice, "triangles") > 0.0);

    let measure = place.json("measure in.vtu lod.vtk --samples 10000");
    assert!(number(&measure, "lower_bound") <= number(&extract, "error"));
    assert!((number(&measure, "volume") / number(&measure, "volume_reference") - 1.0).abs() <= 0.001);
    assert_eq!(measure["fields"][0]["name"], "radius");
}

#[test]
fn kinds_are_not_mixed_up() {
    let place = Workplace::new();
    place.done("generate box --cells 2 -o in.vtk");
    place.done("build in.vtk -o volume.neph");
    place.done("generate cosine --side 12 -o in.ply");
    place.done("build in.ply -o surface.neph");
    for line in [
        "extract volume.neph --level 0 -o lod.ply",
        "extract surface.neph --level 0 -o lod.vtu",
        "extract volume.neph --level 0 -o lod.msh",
        "generate box -o box.ply",
    ] {
        let run = place.run(line);
        assert_eq!(run.status, 1, "{line}: {}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
    for (line, option) in [
        ("extract surface.neph --level 0 --boundary -o lod.ply", "--boundary"),
        ("extract surface.neph --level 0 --slice 0,0,1,0 -o lod.ply", "--slice"),
        ("extract surface.neph --tetrahedra 50 -o lod.ply", "--tetrahedra"),
        ("extract volume.neph --triangles 50 -o lod.vtu", "--tetrahedra"),
    ] {
        let run = place.run(line);
        assert_eq!(run.status, 2, "{line}: {}", run.stderr);
        assert!(run.stderr.contains(option) && run.stderr.contains("holds a"), "{}", run.stderr);
    }
    for (line, option) in [
        ("build in.ply -o other.neph --method fusion", "--method needs a volume"),
        ("build in.ply -o other.neph --field-weight 2", "--field-weight needs a volume"),
        ("build in.ply -o other.neph --solution q.bin", "--solution needs a PLOT3D grid"),
        ("build in.vtk -o other.neph --solution q.bin", "--solution needs a PLOT3D grid"),
        ("build in.vtk -o other.neph --method jade", "--method needs a surface"),
        ("build in.vtk -o other.neph --bound certified", "--bound needs a surface"),
        ("build in.vtk -o other.neph --jade-k 100", "--jade-k needs a surface"),
        ("build in.ply in.vtk --output-dir db --reduction 1", "--reduction needs a surface and --method"),
        ("build in.vtk --output-dir db --placement best", "--placement needs a surface"),
    ] {
        let run = place.run(line);
        assert_eq!(run.status, 2, "{line}: {}", run.stderr);
        assert!(run.stderr.contains(option), "{line}: {}", run.stderr);
    }
    assert_eq!(place.files(), ["in.ply", "in.vtk", "surface.neph", "volume.neph"]);
    // In a database an option concerns the parts for which it has a meaning.
    place.done("build in.ply in.vtk --output-dir db --method progressive --field-weight 2");
}

/// Of a volume, `measure` takes the boundary, also beside a surface; the same grid in pieces is one
/// grid.
#[test]
fn a_volume_is_measured_by_its_boundary() {
    let place = Workplace::new();
    place.done("generate ball --cells 6 -o in.vtu");
    place.done("build in.vtu -o out.neph");
    place.done("extract out.neph --level 0 --boundary -o boundary.ply");
    let measure = place.json("measure in.vtu boundary.ply --samples 2000");
    assert!(number(&measure, "max") < 1e-12, "{measure}");
    assert!(measure["fields"].is_null(), "{measure}");
    assert!(place.done("measure boundary.ply in.vtu --samples 100").contains("in.vtu, the boundary, "));

    // Both tetrahedra have nodes of their own where they meet.
    let split =
        TWO_TETRAHEDRA.replace("POINTS 5", "POINTS 8").replace("1 1 1\n", "1 1 1 1 0 0 0 1 0 0 0 1\n");
    let split = split.replace("4 1 2 3 4", "4 5 6 7 4").replace("POINT_DATA 5", "POINT_DATA 8");
    place.write(
        "split.vtk",
        split.replace("0 1 2 3 4\n", "0 1 2 3 4 1 2 3\n").replace("4 0 1 2 3 4 1 2 3", "4 0 1 2 3"),
    );
    place.write("whole.vtk", TWO_TETRAHEDRA);
    let measure = place.json("measure whole.vtk split.vtk --samples 2000");
    assert!(number(&measure, "max") < 1e-12, "{measure}");
    assert_eq!(measure["triangles"], 6, "no wall inside");
}

/// Two tetrahedra with a field, as text.
const TWO_TETRAHEDRA: &str = "\
# vtk DataFile Version 3.0
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0 1 0 0 0 1 0 0 0 1 1 1 1
CELLS 2 10
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 2
10 10
POINT_DATA 5
SCALARS triangles_in float 1
LOOKUP_TABLE default
0 1 2 3 4
";

/// A file or a field may be called as the simplices of the other kind are: names stay as they are.
#[test]
fn words_for_simplices_do_not_reach_into_names() {
    let place = Workplace::new();
    std::fs::create_dir(place.path("triangles")).expect("a folder");
    place.write("triangles/two.vtk", TWO_TETRAHEDRA);
    let text = place.done("build triangles/two.vtk -o triangles/two.neph");
    assert!(text.starts_with("triangles/two.neph\n"), "{text}");
    assert!(place.done("info triangles/two.neph").starts_with("triangles/two.neph\n"));
    let text = place.done("extract triangles/two.neph --level 0 -o triangles/lod.vtu");
    assert!(text.starts_with("triangles/lod.vtu: 2 tetrahedra, 5 vertices, "), "{text}");
    let extract = place.json("extract triangles/two.neph --level 0 -o triangles/lod.vtu");
    assert!(extract["deviations"]["triangles_in"].is_number(), "{extract}");
    assert_eq!(number(&extract, "tetrahedra"), 2.0);
    let info = place.json("info triangles/two.neph");
    assert_eq!(info["attributes"][0]["name"], "triangles_in");
    assert_eq!(number(&info["curve"][0], "tetrahedra"), 2.0);
    assert!(info["curve"][0]["triangles"].is_null() && info["triangles_in"].is_null(), "{info}");
}
