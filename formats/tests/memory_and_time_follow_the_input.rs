//! What a file claims costs nothing; only what it holds does.
//!
//! The allocator of this test refuses what goes beyond a multiple of the input, and a refused allocation ends the process.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]
#![allow(clippy::print_stdout, reason = "a long run says how long")]

mod samples;

use std::alloc::System;
use std::fmt::Write;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use cap::Cap;
use nephrite_formats::{
    MeshError, MeshFormat, ReadReport, TetrahedronMesh, TriangleMesh, VolumeFormat, VolumeReport,
    read_mesh_bytes, read_volume, read_volume_bytes,
};

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

/// Does something with an input under the cap, within ten seconds.
fn within<T>(n_bytes: usize, what: impl std::fmt::Display, read: impl FnOnce() -> T) -> T {
    let _capped = Capped::to(BYTES_ALWAYS + BYTES_PER_BYTE * n_bytes);
    let start = Instant::now();
    let result = read();
    let elapsed = start.elapsed();
    assert!(elapsed < Duration::from_secs(10), "{what}: {n_bytes} bytes took {elapsed:?}");
    result
}

fn read_within(bytes: &[u8], format: MeshFormat) -> Result<(TriangleMesh, ReadReport), MeshError> {
    within(bytes.len(), format, || read_mesh_bytes(bytes, format))
}

fn read_volume_within(
    bytes: &[u8],
    format: VolumeFormat,
) -> Result<(TetrahedronMesh, VolumeReport), MeshError> {
    within(bytes.len(), format, || read_volume_bytes(bytes, format))
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

/// Half a minute and 2 GB of memory for each file: `cargo test -p nephrite-formats --test memory_and_time_follow_the_input --
/// --ignored --nocapture`. The last results are in fuzz/RESULTS.md.
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
        let start = Instant::now();
        // What a reader copies at most: the text once, and once more as a string.
        let capped = Capped::to(2 * GIGABYTE + BYTES_ALWAYS);
        let is_refused = match format {
            Ok(format) => read_mesh_bytes(&bytes, format).is_err(),
            Err(format) => read_volume_bytes(&bytes, format).is_err(),
        };
        drop(capped);
        let elapsed = start.elapsed();
        println!("{name}, {head:?} and a gigabyte of {fill:?}: {elapsed:.1?}");
        assert!(is_refused && elapsed < Duration::from_secs(60), "{name}: {elapsed:?}");
    }
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

/// Two tetrahedra in every text format of volumes, and in binary where it is written.
fn volumes() -> Vec<(VolumeFormat, Vec<u8>)> {
    let mesh = TetrahedronMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.3]],
        tetrahedra: vec![[0, 1, 2, 3], [1, 2, 3, 4]],
        ..TetrahedronMesh::default()
    };
    let written = |format| {
        let mut bytes = Vec::new();
        nephrite_formats::write_volume_to(&mut bytes, &mesh, format).unwrap();
        (format, bytes)
    };
    let points = "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
    let gmsh_2 = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{points}$EndNodes\n\
         $Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n$NodeData\n1\nf\n0\n3\n0\n1\n4\n1 1\n2 1\n3 1\n4 1\n$EndNodeData\n"
    );
    let gmsh_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n\
                  $Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";
    let medit = "MeshVersionFormatted 2\nDimension\n3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n\
                 Triangles\n1\n1 2 3 0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n";
    let vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n\
               4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS a int 1\nLOOKUP_TABLE default\n1 2 3 4\nFIELD b 1\nc 1 4 int\n1 2 3 4\n";
    let vtk_5 = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 2 4\n\
                 OFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\n";
    let texts = [
        (VolumeFormat::Gmsh, gmsh_2.as_str()),
        (VolumeFormat::Gmsh, gmsh_4),
        (VolumeFormat::Medit, medit),
        (VolumeFormat::Vtk, vtk),
        (VolumeFormat::Vtk, vtk_5),
    ];
    let mut files = vec![written(VolumeFormat::Vtu), written(VolumeFormat::Vtk)];
    files.extend(texts.map(|(format, text)| (format, text.as_bytes().to_vec())));
    files
}

#[test]
fn numbers_in_volumes_that_claim_more_are_refused_or_cost_nothing() {
    let _guard = alone();
    for (format, bytes) in volumes() {
        read_volume_within(&bytes, format).unwrap();
        let mut at = 0;
        while at < bytes.len() {
            let n_digits = bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
            for giant in ["0", "1000000", "2147483648", "4000000000", "18446744073709551615", "-1"] {
                let edited = [&bytes[..at], giant.as_bytes(), &bytes[at + n_digits..]].concat();
                // Whatever comes of it, it is bounded.
                let _ = read_volume_within(&edited, format);
            }
            at += n_digits.max(1);
        }
    }
}

#[test]
fn dimensions_of_plot3d_that_claim_more_are_refused() {
    let _guard = alone();
    for dimensions in [[u32::MAX; 3], [65536, 65536, 2], [1 << 31, 2, 2], [0, 0, 0], [1, 1, 1]] {
        for is_big_endian in [true, false] {
            let word = |value: u32| if is_big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
            let bytes = [dimensions.map(word).concat(), vec![0; 96]].concat();
            assert!(read_volume_within(&bytes, VolumeFormat::Plot3d).is_err());
        }
    }
}

#[test]
fn files_of_tetgen_that_claim_more_are_refused() {
    let _guard = alone();
    let folder = tempfile::tempdir().unwrap();
    let (node, ele) = (folder.path().join("t.node"), folder.path().join("t.ele"));
    for (nodes, elements) in [
        ("4000000000 3 0 0\n1 0 0 0\n", "1 4 0\n1 1 1 1 1\n"),
        ("1 3 64 0\n1 0 0 0\n", "1 4 0\n1 1 1 1 1\n"),
        ("1 3 0 0\n1 0 0 0\n", "4000000000 4 0\n1 1 1 1 1\n"),
        ("1 3 0 0\n1 0 0 0\n", "1 4 4000000000\n1 1 1 1 1\n"),
    ] {
        std::fs::write(&node, nodes).unwrap();
        std::fs::write(&ele, elements).unwrap();
        assert!(within(nodes.len() + elements.len(), "TetGen", || read_volume(&node)).is_err());
    }
}

#[test]
fn thousands_of_fields_of_one_name() {
    let _guard = alone();
    let tetrahedron = "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>\
        <Cells><DataArray type=\"Int8\" Name=\"connectivity\">0 1 2 3</DataArray>\
        <DataArray type=\"Int8\" Name=\"offsets\">4</DataArray><DataArray type=\"Int8\" Name=\"types\">10</DataArray></Cells>";
    let fields = "<DataArray type=\"Int8\">1 2 3 4</DataArray>".repeat(30_000);
    let vtu = format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece><PointData>{fields}</PointData>{tetrahedron}</Piece>\
         </UnstructuredGrid></VTKFile>"
    );
    let (mesh, report) = read_volume_within(vtu.as_bytes(), VolumeFormat::Vtu).unwrap();
    assert_eq!((mesh.attributes.len(), report.warnings.len()), (30_000, 29_999));
    assert_eq!(mesh.attributes[29_999].name, "field_30000");
    let scalars = "SCALARS a int 1\nLOOKUP_TABLE default\n1 2 3 4\n".repeat(30_000);
    let vtk = format!(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n\
         4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\n{scalars}"
    );
    let (mesh, _) = read_volume_within(vtk.as_bytes(), VolumeFormat::Vtk).unwrap();
    assert_eq!(mesh.attributes[29_999].name, "a_30000");
}

#[test]
fn thousands_of_arrays_that_are_the_same_bytes() {
    let _guard = alone();
    // 100,000 points and 1,000 fields, all of them the one array of the appended data.
    let data = vec![0; 1_200_000];
    let array = |name: &str, n_components| {
        format!(
            "<DataArray type=\"Float32\" Name=\"{name}\" NumberOfComponents=\"{n_components}\" format=\"appended\" offset=\"0\"/>"
        )
    };
    let fields: String = (0..1000).map(|i| array(&format!("f{i}"), 3)).collect();
    let xml = format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece><Points>{}</Points><Cells>\
         <DataArray type=\"Int8\" Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int8\" Name=\"offsets\">4</DataArray>\
         <DataArray type=\"Int8\" Name=\"types\">10</DataArray></Cells><PointData>{fields}</PointData></Piece>\
         </UnstructuredGrid><AppendedData encoding=\"raw\">_",
        array("points", 3)
    );
    let bytes = [xml.as_bytes(), &1_200_000_u32.to_le_bytes(), &data].concat();
    let error = read_volume_within(&bytes, VolumeFormat::Vtu).unwrap_err();
    assert!(matches!(error, MeshError::CountTooLarge { .. }), "{error}");
}

#[test]
fn thousands_of_empty_values_at_nodes() {
    let _guard = alone();
    let n_nodes = 50_000;
    let nodes: String = (1..=n_nodes).map(|i| format!("{i} 0 0 {i}\n")).collect();
    let data = "$NodeData\n0\n0\n3\n0\n9\n0\n$EndNodeData\n".repeat(20_000);
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{n_nodes}\n{nodes}$EndNodes\n\
         $Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n{data}"
    );
    let (mesh, report) = read_volume_within(text.as_bytes(), VolumeFormat::Gmsh).unwrap();
    assert_eq!((mesh.attributes.len(), report.warnings.len()), (0, 20_000));
}

#[test]
fn xml_nested_deeply() {
    let _guard = alone();
    let nested = format!("<VTKFile type=\"UnstructuredGrid\">{}", "<a>".repeat(300_000));
    assert!(read_volume_within(nested.as_bytes(), VolumeFormat::Vtu).is_err());
    let closed = format!("{nested}{}</VTKFile>", "</a>".repeat(300_000));
    assert!(read_volume_within(closed.as_bytes(), VolumeFormat::Vtu).is_err());
    let entities = "<!DOCTYPE a [<!ENTITY b \"bbbbbbbbbb\"><!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;\">]><VTKFile>&c;</VTKFile>";
    assert!(read_volume_within(entities.as_bytes(), VolumeFormat::Vtu).is_err());
}

#[test]
fn one_line_of_many_megabytes_in_volumes() {
    let _guard = alone();
    let word = "x".repeat(10_000_000);
    let heads = [
        (VolumeFormat::Vtk, "# vtk DataFile Version 3.0\nx\nASCII\n"),
        (VolumeFormat::Vtk, "# vtk DataFile Version 3.0\n"),
        (VolumeFormat::Vtu, "<VTKFile "),
        (VolumeFormat::Gmsh, "$MeshFormat\n"),
        (VolumeFormat::Gmsh, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$"),
        (VolumeFormat::Medit, "MeshVersionFormatted 2\n"),
        (VolumeFormat::Plot3d, ""),
    ];
    for (format, head) in heads {
        assert!(read_volume_within(format!("{head}{word}").as_bytes(), format).is_err());
    }
}
