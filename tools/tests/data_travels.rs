//! What belongs to a vertex stays with it, from the mesh through the file into every level.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;

use std::fmt::Write;

use support::{Workplace, index};

const SIDE: i32 = 12;

/// A wavy square as ASCII PLY: colours and a weight that follow from the position, shifted by
/// `origin` in doubles.
fn wavy_square(origin: f64) -> String {
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float weight\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        SIDE * SIDE,
        (SIDE - 1) * (SIDE - 1)
    );
    for row in 0..SIDE {
        for column in 0..SIDE {
            let [x, y] = [column, row].map(|index| f64::from(index) + origin);
            let z = f64::from((column * row) % 3) * 0.125;
            writeln!(text, "{x:?} {y:?} {z:?} {} {} 7 {}.5", column * 10, row * 10, column - row).unwrap();
        }
    }
    for row in 0..SIDE - 1 {
        for column in 0..SIDE - 1 {
            let corner = row * SIDE + column;
            writeln!(text, "4 {corner} {} {} {}", corner + 1, corner + SIDE + 1, corner + SIDE).unwrap();
        }
    }
    text
}

#[test]
fn attributes_stay_with_their_vertices() {
    let place = Workplace::new();
    place.write("in.ply", wavy_square(0.0));
    place.done("build in.ply -o out.neph");
    let info = place.json("info out.neph");
    assert_eq!(info["attributes"].as_array().unwrap().len(), 2, "{info}");
    for level in [0, 1, index(&info, "levels") / 2, index(&info, "levels") - 1] {
        place.done(&format!("extract out.neph --level {level} -o lod.ply"));
        let (mesh, _) = nephrite_formats::read_mesh(place.path("lod.ply")).unwrap();
        let [colors, weights] = ["color", "weight"].map(|name| &mesh.attribute(name).unwrap().bytes);
        for (vertex, [x, y, _]) in mesh.positions.iter().enumerate() {
            let color = colors[vertex * 3..vertex * 3 + 3].iter().map(|&value| f32::from(value));
            assert!(color.eq([x * 10.0, y * 10.0, 7.0]), "vertex {vertex} of level {level}");
            let weight = f32::from_le_bytes(weights[vertex * 4..vertex * 4 + 4].try_into().unwrap());
            assert!((weight - (x - y)).abs() <= 0.5, "vertex {vertex} of level {level}: {weight}");
        }
    }
}

#[test]
fn a_mesh_far_from_the_origin_keeps_its_shape() {
    let place = Workplace::new();
    place.write("near.ply", wavy_square(0.0));
    // Between neighbouring f32 values at this distance lies a whole cell of the square.
    place.write("far.ply", wavy_square(12_345_678.0));
    let near = place.json("build near.ply -o near.neph");
    let far = place.json("build far.ply -o far.neph");
    assert_eq!(near["bounding_diagonal"], far["bounding_diagonal"]);
    place.done("extract far.neph --level 0 -o back.ply");
    let (mesh, _) = nephrite_formats::read_mesh(place.path("back.ply")).unwrap();
    for vertex in 0..u32::try_from(mesh.positions.len()).unwrap() {
        let [x, y, z] = mesh.point(vertex);
        let [column, row] = [x, y].map(|coordinate| coordinate - 12_345_678.0);
        assert_eq!([column, row], [column, row].map(f64::round), "vertex {vertex}");
        assert_eq!(z, (column * row) % 3.0 * 0.125, "vertex {vertex}");
    }
}
