//! Bad input ends in one clear line that names the file, status 1 and no output file.

mod support;

use support::Workplace;

const TETRAHEDRON: &str = "\
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
";

/// Checks that no command makes anything of a mesh file, and that the line on stderr says `what` is
/// wrong.
fn assert_refused(name: &str, contents: &[u8], what: &str) {
    let place = Workplace::new();
    place.write(name, contents);
    for options in ["", "--json"] {
        let line = place.failure(&format!("build {name} -o out.neph {options}"));
        assert!(line.starts_with(&format!("nephrite: {name}: ")), "{line}");
        assert!(line.contains(what), "{line}");
        assert_eq!(place.files(), [name]);
    }
}

#[test]
fn missing_files() {
    let place = Workplace::new();
    for line in [
        "build none.ply -o out.neph",
        "extract none.neph --level 0 -o out.ply",
        "info none.neph",
        "verify none.neph",
        "bench none.neph",
    ] {
        let message = place.failure(line);
        assert!(message.contains("none."), "{message}");
    }
    assert!(place.files().is_empty());
}

#[test]
fn truncated_meshes() {
    let half = &TETRAHEDRON[..TETRAHEDRON.len() - 12];
    assert_refused("half.ply", half.as_bytes(), "");

    let place = Workplace::new();
    place.done("generate sphere --triangles 80 -o whole.ply");
    let binary = place.read("whole.ply");
    assert_refused("half.ply", &binary[..binary.len() - 7], "");
    assert_refused("head.ply", &binary[..30], "");
}

#[test]
fn unknown_formats() {
    assert_refused("text.xyz", b"neither this nor that\n", "format");
    assert_refused("empty.ply", b"", "");
}

#[test]
fn no_faces() {
    let points = TETRAHEDRON.replace("element face 4", "element face 0");
    let points = &points[..points.find("3 0 2 1").unwrap()];
    assert_refused("points.ply", points.as_bytes(), "no faces");
    assert_refused("points.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces");
}

#[test]
fn indices_out_of_range() {
    assert_refused("far.ply", TETRAHEDRON.replace("3 1 2 3", "3 1 2 4").as_bytes(), "out of range");
    assert_refused("negative.ply", TETRAHEDRON.replace("3 1 2 3", "3 1 2 -1").as_bytes(), "");
    assert_refused("zero.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4");
}

#[test]
fn coordinates_that_are_no_numbers() {
    for bad in ["nan", "inf", "-inf"] {
        assert_refused(
            "bad.ply",
            TETRAHEDRON.replace("1 0 0\n", &format!("{bad} 0 0\n")).as_bytes(),
            "not finite",
        );
    }
    assert_refused("bad.ply", TETRAHEDRON.replace("1 0 0\n", "one 0 0\n").as_bytes(), "line");
}

#[test]
fn files_that_are_no_neph() {
    let place = Workplace::new();
    place.write("mesh.neph", TETRAHEDRON);
    place.write("empty.neph", "");
    for name in ["mesh.neph", "empty.neph"] {
        for line in
            [format!("extract {name} --level 0 -o out.ply"), format!("info {name}"), format!("verify {name}")]
        {
            let message = place.failure(&line);
            assert!(message.starts_with(&format!("nephrite: {name}: ")), "{message}");
        }
    }
    assert_eq!(place.files(), ["empty.neph", "mesh.neph"]);
}

#[test]
fn truncated_neph_files() {
    let place = Workplace::new();
    place.done("generate sphere --triangles 80 -o in.ply");
    place.done("build in.ply -o out.neph");
    let whole = place.read("out.neph");
    for length in [1, 8, 100, 200, 1000, whole.len() / 2, whole.len() - 1] {
        place.write("cut.neph", &whole[..length]);
        let message = place.failure("extract cut.neph --level 0 -o out.ply");
        assert!(message.starts_with("nephrite: cut.neph: "), "{message}");
    }
    assert_eq!(place.files(), ["cut.neph", "in.ply", "out.neph"]);
}

#[test]
fn levels_that_are_not_there() {
    let place = Workplace::new();
    place.done("generate sphere --triangles 80 -o in.ply");
    place.done("build in.ply -o out.neph");
    let message = place.failure("extract out.neph --level 100000 -o out.ply");
    assert!(message.contains("out.neph") && message.contains("100000"), "{message}");
    assert_eq!(place.files(), ["in.ply", "out.neph"]);
}

#[test]
fn outputs_that_cannot_be() {
    let place = Workplace::new();
    place.write("in.ply", TETRAHEDRON);
    place.done("build in.ply -o in.neph");
    std::fs::create_dir(place.path("folder")).unwrap();
    for (line, named) in [
        ("build in.ply -o nowhere/out.neph", "nowhere"),
        ("build in.ply -o folder", "folder"),
        ("build in.ply -o in.ply", "in.ply"),
        ("build in.ply -o ./folder/../in.ply", "in.ply"),
        ("extract in.neph --level 0 -o nowhere/out.ply", "nowhere"),
        ("extract in.neph --level 0 -o out.xyz", "out.xyz"),
        ("extract in.neph --level 0 -o out", "out"),
        ("extract in.neph --level 0 -o in.neph", "in.neph"),
        ("generate cosine -o out.xyz", "out.xyz"),
        ("generate cosine -o nowhere/out.ply", "nowhere"),
        ("demo -o in.ply", "in.ply"),
    ] {
        let message = place.failure(line);
        assert!(message.contains(named), "{message}");
    }
    assert_eq!(place.files(), ["folder", "in.neph", "in.ply"]);
    assert_eq!(place.read("in.ply"), TETRAHEDRON.as_bytes());
}

#[test]
fn a_failed_build_keeps_the_old_file() {
    let place = Workplace::new();
    place.write("in.ply", TETRAHEDRON);
    place.done("build in.ply -o out.neph");
    let old = place.read("out.neph");
    place.write("in.ply", "ply\n");
    place.failure("build in.ply -o out.neph");
    assert_eq!(place.read("out.neph"), old);
}

#[test]
fn degenerate_and_duplicate_triangles_are_repaired_and_counted() {
    let place = Workplace::new();
    let double = TETRAHEDRON
        .replace("element vertex 4", "element vertex 5")
        .replace("element face 4", "element face 6")
        .replace("0 0 1\n", "0 0 1\n5 5 5\n");
    place.write("in.ply", format!("{double}3 0 2 1\n3 1 1 2\n"));
    let build = place.json("build in.ply -o out.neph");
    assert_eq!(build["triangles_in"], 6);
    assert_eq!(build["vertices_in"], 5);
    let repairs = build["repairs"].as_object().unwrap();
    let n_repairs: u64 = repairs.values().filter_map(serde_json::Value::as_u64).sum();
    assert!(n_repairs >= 3, "{build}");
    let level = place.json("extract out.neph --level 0 -o lod.ply");
    assert_eq!(level["triangles"], 4);
    assert_eq!(level["vertices"], 4);
}

#[test]
fn files_that_are_read_beside_the_mesh_are_not_replaced() {
    let place = Workplace::new();
    for name in ["a.ele", "a.node", "grid.p3d", "q.bin"] {
        place.write(name, "something");
    }
    for line in [
        "build a.ele -o a.node",
        "build a.node -o a.ele",
        "build grid.p3d --solution q.bin -o q.bin",
        "build grid.p3d --solution q.bin -o grid.p3d",
    ] {
        let failure = place.failure(line);
        assert!(failure.ends_with("is the input, which the output would replace"), "{line}: {failure}");
    }
}
