//! Meshes and files shared by the tests.
#![allow(dead_code, reason = "each test uses some of them")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a failed step is a failed test, a skipped one is said"
)]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small literal numbers")]

use std::path::PathBuf;

use base64::Engine;
use nephrite_formats::{Attribute, MeshFormat, ScalarType, TriangleMesh, read_mesh_bytes, write_mesh_to};

/// The formats that are written.
pub(crate) const WRITTEN: [MeshFormat; 5] =
    [MeshFormat::Ply, MeshFormat::Obj, MeshFormat::Stl, MeshFormat::Off, MeshFormat::Glb];

/// The folder of real meshes, if there is one.
pub(crate) fn data_folder() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    if !folder.join("MANIFEST.md").is_file() {
        println!("skipped: there are no real meshes at {}", folder.display());
        return None;
    }
    Some(folder)
}

/// A bumpy square of `side * side` vertices, all at different positions, without attributes.
pub(crate) fn bumpy_square(side: u32) -> TriangleMesh {
    let position = |i: u32| {
        let (x, y) = ((i % side) as f32, (i / side) as f32);
        [x * 0.1, y * 0.3, (x * 1.7).sin() * (y * 0.9).cos()]
    };
    let quad = |i: u32| [[i, i + 1, i + side + 1], [i, i + side + 1, i + side]];
    let starts = (0..side * (side - 1)).filter(|i| i % side != side - 1);
    TriangleMesh {
        positions: (0..side * side).map(position).collect(),
        triangles: starts.flat_map(quad).collect(),
        ..TriangleMesh::default()
    }
}

/// An attribute of numbers that differ from vertex to vertex.
pub(crate) fn counting(name: &str, scalar: ScalarType, n_components: u32, n_vertices: usize) -> Attribute {
    let n_values = n_vertices * n_components as usize;
    let bytes = match scalar {
        ScalarType::F32 => (0..n_values).flat_map(|i| (i as f32 * 0.125).to_le_bytes()).collect(),
        ScalarType::F64 => (0..n_values).flat_map(|i| (i as f64 * 0.1).to_le_bytes()).collect(),
        _ => (0..n_values * scalar.size_bytes()).map(|i| (i * 7 % 251) as u8).collect(),
    };
    Attribute { name: name.into(), scalar, n_components, bytes }
}

/// The bumpy square with attributes of several kinds.
pub(crate) fn decorated_square(side: u32) -> TriangleMesh {
    let mut mesh = bumpy_square(side);
    let n_vertices = mesh.positions.len();
    mesh.attributes = vec![
        counting("normal", ScalarType::F32, 3, n_vertices),
        counting("color", ScalarType::U8, 4, n_vertices),
        counting("texcoord", ScalarType::F32, 2, n_vertices),
        counting("label", ScalarType::U16, 1, n_vertices),
    ];
    mesh
}

/// A mesh as a file's bytes.
pub(crate) fn written(mesh: &TriangleMesh, format: MeshFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_mesh_to(&mut bytes, mesh, format).unwrap();
    bytes
}

/// A mesh written and read again.
pub(crate) fn again(mesh: &TriangleMesh, format: MeshFormat) -> TriangleMesh {
    read_mesh_bytes(&written(mesh, format), format).unwrap().0
}

/// The corners of all triangles in file coordinates: what every format keeps, whatever it does to
/// vertices.
pub(crate) fn corners(mesh: &TriangleMesh) -> Vec<[f64; 3]> {
    mesh.triangles.iter().flatten().map(|&index| mesh.point(index)).collect()
}

/// Little-endian bytes of floats.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// A glTF document from its lists and the bytes of its only buffer, which is embedded.
pub(crate) fn gltf(lists: &str, buffer: &[u8]) -> Vec<u8> {
    let data = base64::engine::general_purpose::STANDARD.encode(buffer);
    let length = buffer.len();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {length},
        "uri": "data:application/octet-stream;base64,{data}"}}], {lists}}}"#
    )
    .into_bytes()
}

/// A glTF document of one triangle whose nodes are given.
pub(crate) fn gltf_triangle(nodes: &str) -> Vec<u8> {
    let buffer = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let lists = format!(
        r#""scenes": [{{"nodes": [0]}}], "nodes": {nodes},
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}]"#
    );
    gltf(&lists, &buffer)
}

/// Small files of every format and form, each of which reads without an error.
pub(crate) fn small_files() -> Vec<(&'static str, MeshFormat, Vec<u8>)> {
    let square = decorated_square(3);
    let mut plain = bumpy_square(2);
    plain.origin = [1e7, -1e7, 0.5];
    let mut files = vec![
        ("ply binary", MeshFormat::Ply, written(&square, MeshFormat::Ply)),
        ("ply doubles", MeshFormat::Ply, written(&plain, MeshFormat::Ply)),
        ("ply big-endian strips", MeshFormat::Ply, big_endian_strips()),
        ("ply text", MeshFormat::Ply, TEXT_PLY.into()),
        ("obj", MeshFormat::Obj, written(&square, MeshFormat::Obj)),
        ("obj by hand", MeshFormat::Obj, OBJ.into()),
        ("stl binary", MeshFormat::Stl, written(&bumpy_square(3), MeshFormat::Stl)),
        ("stl text", MeshFormat::Stl, written(&plain, MeshFormat::Stl)),
        ("off", MeshFormat::Off, written(&square, MeshFormat::Off)),
        ("glb", MeshFormat::Glb, written(&square, MeshFormat::Glb)),
        (
            "gltf",
            MeshFormat::Gltf,
            gltf_triangle(r#"[{"mesh": 0, "rotation": [0, 0, 1, 1], "scale": [1, -2, 1]}]"#),
        ),
        ("gltf sparse strip", MeshFormat::Gltf, sparse_strip()),
    ];
    for (name, format, bytes) in &mut files {
        assert!(read_mesh_bytes(bytes, *format).is_ok(), "{name}");
    }
    files
}

const TEXT_PLY: &str = "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 5\r\nproperty double x\r\nproperty int y\r\n\
    property float z\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\nelement face 2\r\n\
    property list uchar int vertex_indices\r\nproperty list uchar float texcoord\r\nelement edge 1\r\n\
    property int vertex1\r\nproperty int vertex2\r\nend_header\r\n\
    0 0 0 1 2 3\r\n4.5 0 0 4 5 6\r\n4.5 3 1e-3 7 8 9\r\n1 1 0 255 255 255\r\n0 3 0 0 0 0\r\n\
    5 0 1 2 3 4 2 0.5 0.5\r\n3 0 2 1 0\r\n1 2\r\n";

const OBJ: &str = "# by hand\nmtllib none.mtl\no thing\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\n\
    vt 0 0\nvt 1 0 0\nvt 1\nvn 0 0 1\nvp 1 2\ng a b\nusemtl m\ns 1\nf 1/1/1 2/2/1 3/3/1 \\\n 4/1/1\nf -4 -2// -1//-1\nl 1 2\np 1\n";

fn big_endian_strips() -> Vec<u8> {
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty list uchar short tags\nproperty float x\n\
        property float y\nproperty double z\nproperty short label\nelement tristrips 1\n\
        property list int int vertex_indices\nend_header\n"
        .to_vec();
    for (i, [x, y]) in [[0.0_f32, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].into_iter().enumerate() {
        bytes.extend([1, 0, 9]);
        bytes.extend(x.to_be_bytes());
        bytes.extend(y.to_be_bytes());
        bytes.extend(0.1_f64.to_be_bytes());
        bytes.extend((i16::try_from(i).unwrap() - 2).to_be_bytes());
    }
    let strip = [0, 1, 2, 3, -1, 0, 2, 1];
    bytes.extend(i32::try_from(strip.len()).unwrap().to_be_bytes());
    strip.iter().for_each(|index: &i32| bytes.extend(index.to_be_bytes()));
    bytes
}

/// A strip of two triangles; the position of vertex 3 comes from a sparse accessor, positions lie
/// among other bytes.
fn sparse_strip() -> Vec<u8> {
    let mut buffer = Vec::new();
    for position in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [9.0, 9.0, 9.0]] {
        buffer.extend(floats(&position));
        buffer.extend([255, 128, 0, 255]);
    }
    buffer.extend(floats(&[1.0, 1.0, 0.5]));
    buffer.extend([3, 0, 1, 2, 3, 0, 0, 0]);
    let lists = r#""nodes": [{"mesh": 0, "translation": [0.1, 0, 0]}], "scenes": [{"nodes": [0]}], "scene": 0,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 2}, "indices": 1, "mode": 5}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "sparse": {"count": 1,
                "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 1}}},
            {"bufferView": 2, "byteOffset": 1, "componentType": 5121, "type": "SCALAR", "count": 4},
            {"bufferView": 0, "byteOffset": 12, "componentType": 5121, "type": "VEC4", "count": 4, "normalized": true}],
        "bufferViews": [{"buffer": 0, "byteLength": 64, "byteStride": 16},
            {"buffer": 0, "byteOffset": 64, "byteLength": 12}, {"buffer": 0, "byteOffset": 76, "byteLength": 8}]"#;
    gltf(lists, &buffer)
}
