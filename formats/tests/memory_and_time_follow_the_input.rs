//! Promise: memory and time follow what a file holds, not what it claims.
//!
//! The allocator of these tests refuses more than a multiple of the input. Volumes have a test file
//! of their own.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]
#![allow(clippy::print_stdout, reason = "a long run says how long")]

mod capped;
mod samples;

use std::fmt::Write;
use std::time::Instant;

use capped::{BYTES_ALWAYS, Capped, Watchdog, alone, within};
use nephrite_formats::{
    FileReport, MeshError, MeshFormat, TriangleMesh, VolumeFormat, read_mesh_bytes, read_volume_bytes,
};

fn read_within(bytes: &[u8], format: MeshFormat) -> Result<(TriangleMesh, FileReport), MeshError> {
    within(bytes.len(), format, || read_mesh_bytes(bytes, format))
}

#[test]
fn claims_beyond_the_bytes_are_refused() {
    let _guard = alone();
    let ply = |format: &str, vertices: &str, list: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
             element face 4000000000\nproperty list {list} vertex_indices\nend_header\n"
        )
    };
    let mut files: Vec<(MeshFormat, Vec<u8>)> = Vec::new();
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for vertices in ["0", "4294967295", "18446744073709551615"] {
            for list in ["uchar int", "uint double"] {
                let mut bytes = ply(format, vertices, list).into_bytes();
                bytes.extend([255; 40]);
                files.push((MeshFormat::Ply, bytes));
            }
        }
    }
    let mut stl = vec![0; 80];
    stl.extend([255; 4]);
    files.push((MeshFormat::Stl, stl));
    files.push((MeshFormat::Off, b"OFF\n4294967295 4294967295 0\n0 0 0\n".to_vec()));
    files.push((MeshFormat::Off, b"OFF\n3 1 0\n0 0 0\n0 0 0\n0 0 0\n4294967295 0 1 2\n".to_vec()));
    files.push((MeshFormat::Obj, b"v 0 0 0\nf 4294967295 4294967294 4294967293\n".to_vec()));
    files.push((MeshFormat::Glb, b"glTF\x02\0\0\0\xff\xff\xff\xff".to_vec()));
    files.push((MeshFormat::Glb, b"glTF\x02\0\0\0\x14\0\0\0\xff\xff\xff\xffJSON".to_vec()));
    let triangle = String::from_utf8(samples::gltf_triangle(r#"[{"mesh": 0}]"#)).unwrap();
    for count in ["1000000", "4000000000", "18446744073709551615"] {
        let claimed = triangle.replace("\"count\": 3", &format!("\"count\": {count}"));
        files.push((MeshFormat::Gltf, claimed.replace("\"bufferView\": 0, ", "").into_bytes()));
        files.push((MeshFormat::Gltf, claimed.into_bytes()));
    }
    for (format, bytes) in files {
        assert!(read_within(&bytes, format).is_err(), "{format}: {}", bytes.escape_ascii());
    }
}

#[test]
fn what_is_there_is_read_within_a_multiple() {
    let _guard = alone();
    let square = samples::decorated_square(100);
    for format in samples::WRITTEN {
        assert!(read_within(&samples::written(&square, format), format).is_ok(), "{format}");
    }
}

#[test]
fn one_line_of_many_megabytes() {
    let _guard = alone();
    let spaces = " ".repeat(30_000_000);
    assert!(read_within(format!("v 0 0 0{spaces}\nf 1 1 1\n").as_bytes(), MeshFormat::Obj).is_ok());
    let word = "x".repeat(30_000_000);
    for format in MeshFormat::ALL {
        assert!(read_within(word.as_bytes(), format).is_err());
        assert!(read_within(format!("ply\n{word}").as_bytes(), format).is_err());
        assert!(read_within(format!("OFF\n{word}").as_bytes(), format).is_err());
        assert!(read_within(format!("solid {word}").as_bytes(), format).is_err());
    }
    let comments = "#\n".repeat(5_000_000);
    assert!(read_within(comments.as_bytes(), MeshFormat::Obj).is_err());
    assert!(read_within(format!("OFF\n3 1 0\n{comments}").as_bytes(), MeshFormat::Off).is_err());
}

/// Half a minute and 2 GB of memory for each file: `cargo test -p nephrite-formats --test
/// memory_and_time_follow_the_input -- --ignored --nocapture`. The last results are in
/// fuzz/RESULTS.md.
#[test]
#[ignore = "reads eleven files of a gigabyte"]
fn a_gigabyte_in_one_line() {
    const GIGABYTE: usize = 1_000_000_000;
    let _guard = alone();
    let vtk = "# vtk DataFile Version 3.0\n";
    let meshes = [
        (MeshFormat::Obj, "v 0 0 0", " "),
        (MeshFormat::Obj, "f 1/1/1", "1"),
        (MeshFormat::Obj, "v 0 0 0\n# ", "x"),
        (MeshFormat::Ply, "ply\ncomment ", "x"),
        (MeshFormat::Off, "OFF\n", "x"),
        (MeshFormat::Stl, "solid ", "x"),
        (MeshFormat::Gltf, "{\"asset\": \"", "x"),
    ]
    .map(|(format, head, fill)| (format.to_string(), head, fill, Ok(format)));
    let volumes = [
        (VolumeFormat::Vtk, vtk, "x"),
        (VolumeFormat::Vtu, "<VTKFile type=\"", "x"),
        (VolumeFormat::Gmsh, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$", "x"),
        (VolumeFormat::Medit, "MeshVersionFormatted 2\nDimension ", " "),
    ]
    .map(|(format, head, fill)| (format.to_string(), head, fill, Err(format)));
    for (name, head, fill, format) in meshes.into_iter().chain(volumes) {
        let mut bytes = head.as_bytes().to_vec();
        bytes.resize(GIGABYTE, fill.as_bytes()[0]);
        let _watchdog = Watchdog::over(&name);
        let start = Instant::now();
        // The most that a reader copies: the text once, and once more as a string.
        let capped = Capped::to(2 * GIGABYTE + BYTES_ALWAYS);
        let is_refused = match format {
            Ok(format) => read_mesh_bytes(&bytes, format).is_err(),
            Err(format) => read_volume_bytes(&bytes, format).is_err(),
        };
        drop(capped);
        println!("{name}, {head:?} and a gigabyte of {fill:?}: {:.1?}", start.elapsed());
        assert!(is_refused, "{name}");
    }
}

#[test]
fn a_face_of_a_hundred_thousand_corners() {
    let _guard = alone();
    let n_corners = 100_000_u32;
    let mut star = String::new();
    // A star with spikes of random length is simple, and is cut within the allowed work. If it
    // exceeded that work it would be a fan, which the test would count. The same corners in another
    // order cross themselves everywhere.
    let mut random = 1_u32;
    for i in 0..n_corners {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let radius = 1.0 + f64::from(random >> 16) / 65536.0;
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n_corners);
        writeln!(star, "v {} {} 0", radius * angle.cos(), radius * angle.sin()).unwrap();
    }
    let in_order: String = (1..=n_corners).map(|i| format!(" {i}")).collect();
    let (mesh, report) = read_within(format!("{star}f{in_order}\n").as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!((mesh.triangles.len(), report.n_polygons_folded), (99_998, 0));
    let crossing: String =
        (0..n_corners).map(|i| format!(" {}", u64::from(i) * 38_197 % 100_000 + 1)).collect();
    let (mesh, report) = read_within(format!("{star}f{crossing}\n").as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!((mesh.triangles.len(), report.n_polygons_folded), (99_998, 1));
}

#[test]
fn many_hostile_polygons() {
    let _guard = alone();
    // Random corners: every polygon crosses itself.
    let mut text = String::new();
    let mut random = 1_u32;
    for _ in 0..1000 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        writeln!(text, "v {} {} 0", random >> 20, (random >> 8) & 0xfff).unwrap();
    }
    let corners: String = (1..=1000).map(|i| format!(" {i}")).collect();
    for _ in 0..300 {
        writeln!(text, "f{corners}").unwrap();
    }
    assert!(read_within(text.as_bytes(), MeshFormat::Obj).is_ok());
}

#[test]
fn a_position_with_a_million_normals() {
    let _guard = alone();
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for i in 1..=1_000_000 {
        writeln!(text, "vn 0 0 {i}\nf 1//{i} 2//{i} 3//{i}").unwrap();
    }
    let (mesh, _) = read_within(text.as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!(mesh.positions.len(), 3_000_000);
}

#[test]
fn a_million_names() {
    let _guard = alone();
    let square = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for keyword in ["g", "usemtl", "o", "mtllib", "s"] {
        let names: String = (0..200_000).map(|i| format!("{keyword} {i}\n")).collect();
        let (_, report) = read_within(format!("{square}{names}").as_bytes(), MeshFormat::Obj).unwrap();
        assert_eq!((report.items().len(), report.notes().len()), (200_000 - usize::from(keyword == "s"), 1));
    }
    let words: String = (0..200_000).map(|i| format!("x{i}\n")).collect();
    assert_eq!(read_within((words + square).as_bytes(), MeshFormat::Obj).unwrap().1.notes().len(), 1);
}

#[test]
fn a_vertex_with_a_million_texture_coordinates() {
    let _guard = alone();
    let n_faces = 200_000;
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face {n_faces}\n\
         property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
    );
    for i in 0..n_faces {
        writeln!(text, "3 0 1 2 6 {i} 0 {i} 0 {i} 0").unwrap();
    }
    let (mesh, _) = read_within(text.as_bytes(), MeshFormat::Ply).unwrap();
    assert_eq!(mesh.positions.len(), 3 * n_faces);
    // Vertices that come behind the faces cost nothing before they are there.
    let claim = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
        element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2 6 0 0 0 0 0 0\n";
    assert!(read_within(claim.as_bytes(), MeshFormat::Ply).is_err());
}

#[test]
fn json_nested_deeply() {
    let _guard = alone();
    for open in ["[", "{\"a\":"] {
        assert!(matches!(
            read_within(open.repeat(1_000_000).as_bytes(), MeshFormat::Gltf),
            Err(MeshError::Json(_))
        ));
    }
}
