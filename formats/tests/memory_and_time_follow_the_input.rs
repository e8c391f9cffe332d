//! What a file claims costs nothing; only what it holds does.
//!
//! The allocator of this test refuses what goes beyond a multiple of the input, and a refused allocation ends the process.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod samples;

use std::alloc::System;
use std::fmt::Write;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use cap::Cap;
use nephrite_formats::{MeshError, MeshFormat, ReadReport, TriangleMesh, read_mesh_bytes};

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Held by the test that runs, as the cap is for the process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Bytes that may be allocated at once per byte of input, and in any case: the harness needs some itself.
const BYTES_PER_BYTE: usize = 64;
const BYTES_ALWAYS: usize = 1 << 20;

/// Lifts the cap when it goes, also when a panic needs memory to be told.
struct Capped;

impl Capped {
    fn to(n_bytes: usize) -> Self {
        ALLOCATOR.set_limit(ALLOCATOR.allocated() + n_bytes).unwrap();
        Self
    }
}

impl Drop for Capped {
    fn drop(&mut self) {
        ALLOCATOR.set_limit(usize::MAX).unwrap();
    }
}

/// Reads under the cap, within ten seconds.
fn read_within(bytes: &[u8], format: MeshFormat) -> Result<(TriangleMesh, ReadReport), MeshError> {
    let _capped = Capped::to(BYTES_ALWAYS + BYTES_PER_BYTE * bytes.len());
    let start = Instant::now();
    let result = read_mesh_bytes(bytes, format);
    let elapsed = start.elapsed();
    assert!(elapsed < Duration::from_secs(10), "{format}: {} bytes took {elapsed:?}", bytes.len());
    result
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

#[test]
fn a_face_of_a_hundred_thousand_corners() {
    let _guard = alone();
    let n_corners = 100_000_u32;
    let mut star = String::new();
    // A star with spikes of random length: simple; and the same corners in an order that crosses itself everywhere.
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
    // Corners at random: every polygon crosses itself.
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
fn a_position_with_a_hundred_thousand_normals() {
    let _guard = alone();
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for i in 1..=100_000 {
        writeln!(text, "vn 0 0 {i}\nf 1//{i} 2//{i} 3//{i}").unwrap();
    }
    let (mesh, _) = read_within(text.as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!(mesh.positions.len(), 300_000);
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
