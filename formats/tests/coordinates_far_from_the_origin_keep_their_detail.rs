//! Promise: a survey in metres on a national grid, with points millimetres apart, keeps its detail
//! in every format.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod samples;

use nephrite_formats::{MeshFormat, TriangleMesh, read_mesh_bytes};

const EAST: f64 = 10_000_000.0;
const NORTH: f64 = -5_432_109.875;

/// Points a millimetre apart in x and three in y, 10,000 kilometres from the origin.
fn survey() -> Vec<[f64; 3]> {
    let point = |i: u32| {
        let (x, y) = (f64::from(i % 10), f64::from(i / 10));
        [EAST + 0.001 * x, NORTH + 0.003 * y, 100.0 + 0.0001 * x * y]
    };
    (0..100).map(point).collect()
}

fn check(mesh: &TriangleMesh, text: &str) {
    assert_ne!(mesh.origin, [0.0; 3], "{text}");
    assert!(mesh.rounding < 2e-9, "{text}: {}", mesh.rounding);
    for (i, expected) in survey().iter().enumerate() {
        let found = mesh.point(u32::try_from(i).unwrap());
        let distance = (0..3).map(|axis| (found[axis] - expected[axis]).powi(2)).sum::<f64>().sqrt();
        // A unit in the last place of 1e7 is 1.9e-9.
        assert!(distance <= mesh.rounding + 2e-9, "{text}: vertex {i} is off by {distance}");
    }
    let distinct: std::collections::HashSet<[u32; 3]> =
        mesh.positions.iter().map(|p| p.map(f32::to_bits)).collect();
    assert_eq!(distinct.len(), 100, "{text}");
}

#[test]
fn doubles_in_binary_ply() {
    let mut bytes =
        b"ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty double x\nproperty double y\n\
        property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            .to_vec();
    survey().iter().flatten().for_each(|value| bytes.extend(value.to_le_bytes()));
    bytes.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    check(&read_mesh_bytes(&bytes, MeshFormat::Ply).unwrap().0, "PLY");
}

#[test]
fn digits_in_text() {
    let lines = |before: &str| -> String {
        survey().iter().map(|[x, y, z]| format!("{before}{x} {y} {z}\n")).collect()
    };
    let ply = "ply\nformat ascii 1.0\nelement vertex 100\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let files = [
        (MeshFormat::Obj, lines("v ") + "f 1 2 3\n"),
        (MeshFormat::Off, format!("OFF\n100 1 0\n{}3 0 1 2\n", lines(""))),
        (MeshFormat::Ply, format!("{ply}{}3 0 1 2\n", lines(""))),
    ];
    for (format, text) in files {
        check(&read_mesh_bytes(text.as_bytes(), format).unwrap().0, &format.to_string());
    }
}

#[test]
fn what_is_written_is_where_it_was() {
    let text: String = survey().iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let faces: String = (1..=98).map(|i| format!("f {i} {} {}\n", i + 1, i + 2)).collect();
    let (mesh, _) = read_mesh_bytes((text + &faces).as_bytes(), MeshFormat::Obj).unwrap();
    for format in samples::WRITTEN {
        let again = samples::again(&mesh, format);
        for (a, b) in samples::corners(&mesh).iter().zip(samples::corners(&again)) {
            let distance = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
            assert!(distance <= again.rounding + 4e-9, "{format}: {distance}");
        }
    }
}

#[test]
fn doubles_that_are_single_precision_stay_at_the_origin_zero() {
    let text = "v 16777216 0.5 -3\nv 0.1 0 0\nv 0 1e-20 0\nf 1 2 3\n";
    let (mesh, _) = read_mesh_bytes(text.as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!(mesh.origin, [0.0; 3]);
    assert_eq!(mesh.positions[1], [0.1, 0.0, 0.0]);
}
