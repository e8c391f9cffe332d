//! Promise: every triangle primitive of the default scene appears under the transform of its node,
//! and nothing else does.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod samples;

use nephrite_formats::{FileReport, MeshError, MeshFormat, ScalarType, TriangleMesh, read_mesh_bytes};
use samples::{floats, gltf, gltf_triangle};

fn read(bytes: &[u8]) -> (TriangleMesh, FileReport) {
    read_mesh_bytes(bytes, MeshFormat::Gltf).unwrap()
}

fn error(bytes: &[u8]) -> MeshError {
    read_mesh_bytes(bytes, MeshFormat::Gltf).unwrap_err()
}

fn numbers(mesh: &TriangleMesh, name: &str) -> Vec<f32> {
    let attribute = mesh.attribute(name).unwrap();
    assert_eq!(attribute.scalar, ScalarType::F32);
    attribute.bytes.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect()
}

#[test]
fn transforms_are_applied_along_the_hierarchy() {
    let nodes = r#"[{"translation": [10, 0, 0], "children": [1, 2]}, {"mesh": 0, "scale": [2, 2, 2]},
        {"mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}]"#;
    let (mesh, _) = read(&gltf_triangle(nodes));
    assert_eq!(mesh.positions[..3], [[10.0, 0.0, 0.0], [12.0, 0.0, 0.0], [10.0, 2.0, 0.0]]);
    for (found, expected) in
        mesh.positions[3..].iter().zip([[10.0, 0.0, 0.0], [10.0, 1.0, 0.0], [9.0, 0.0, 0.0]])
    {
        assert!(found.iter().zip(expected).all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-6), "{found:?}");
    }
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
}

#[test]
fn mirrored_nodes_turn_their_triangles_over() {
    let (mesh, _) = read(&gltf_triangle(r#"[{"mesh": 0, "scale": [-1, 1, 1]}]"#));
    assert_eq!(mesh.triangles, [[0, 2, 1]]);
    assert_eq!(mesh.positions[1], [-1.0, 0.0, 0.0]);
}

#[test]
fn one_far_translation_becomes_the_origin_exactly() {
    let (mesh, _) = read(&gltf_triangle(r#"[{"mesh": 0, "translation": [4200000.123, 0, -1]}]"#));
    assert_eq!(mesh.origin, [4_200_000.123, 0.0, -1.0]);
    assert_eq!(mesh.positions[1], [1.0, 0.0, 0.0]);
    assert_eq!(mesh.rounding, 0.0);
    let (mesh, _) = read(&gltf_triangle(r#"[{"mesh": 0, "translation": [4, 0, -1]}]"#));
    assert_eq!((mesh.origin, mesh.positions[1]), ([0.0; 3], [5.0, 0.0, -1.0]));
}

#[test]
fn normals_turn_with_the_inverse_transpose() {
    let mut buffer = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let slanted = std::f32::consts::FRAC_1_SQRT_2;
    buffer.extend(floats(&[slanted, 0.0, slanted, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]));
    let lists = r#""nodes": [{"mesh": 0, "scale": [2, 1, 1]}], "scenes": [{"nodes": [0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
            {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}]"#;
    let (mesh, _) = read(&gltf(lists, &buffer));
    let normal = numbers(&mesh, "normal");
    let expected = [1.0 / 5.0_f32.sqrt(), 0.0, 2.0 / 5.0_f32.sqrt(), 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    assert!(normal.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{normal:?}");
}

/// Four vertices and the indices 0 1 2 3 as bytes, in a drawing mode.
fn four_corners(mode: u32, indices: &str) -> Vec<u8> {
    let mut buffer = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    buffer.extend([0, 1, 2, 3]);
    let lists = format!(
        r#""nodes": [{{"mesh": 0}}], "scenes": [{{"nodes": [0]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "mode": {mode} {indices}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4}},
            {{"bufferView": 0, "byteOffset": 48, "componentType": 5121, "type": "SCALAR", "count": 4}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 52}}]"#
    );
    gltf(&lists, &buffer)
}

#[test]
fn triangles_strips_and_fans() {
    for indices in ["", ", \"indices\": 1"] {
        assert_eq!(read(&four_corners(5, indices)).0.triangles, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(read(&four_corners(6, indices)).0.triangles, [[0, 1, 2], [0, 2, 3]]);
        let (mesh, report) = read(&four_corners(4, indices));
        assert_eq!((mesh.triangles, report.n_faces_dropped), (vec![[0, 1, 2]], 1));
        for mode in [0, 1, 2, 3, 7] {
            assert!(matches!(error(&four_corners(mode, indices)), MeshError::NoFaces { n_vertices: 4 }));
        }
    }
}

#[test]
fn primitives_of_one_mesh_share_vertices_with_the_same_attributes() {
    let mut buffer = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    buffer.extend([0, 1, 2, 0, 2, 3, 0, 0]);
    let lists = r#""nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]}], "scenes": [{"nodes": [0, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1},
            {"attributes": {"POSITION": 0}, "indices": 2}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4},
            {"bufferView": 1, "componentType": 5121, "type": "SCALAR", "count": 3},
            {"bufferView": 1, "byteOffset": 3, "componentType": 5121, "type": "SCALAR", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 8}]"#;
    let (mesh, _) = read(&gltf(lists, &buffer));
    assert_eq!(mesh.positions.len(), 8);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
}

#[test]
fn quantized_positions_and_normalized_attributes() {
    let mut buffer: Vec<u8> = Vec::new();
    for position in [[0_i16, 0, 0], [32767, 0, 0], [0, -32768, 0]] {
        position.iter().for_each(|value| buffer.extend(value.to_le_bytes()));
        buffer.extend([0, 0]);
    }
    buffer.extend([0, 255, 51, 0, 0, 0, 255, 255, 0, 0, 0, 0]);
    let lists = r#""nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2, "_ID": 3, "FOO": 3}}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5122, "type": "VEC3", "count": 3, "normalized": true},
            {"bufferView": 1, "componentType": 5121, "type": "VEC2", "count": 3, "normalized": true},
            {"bufferView": 1, "componentType": 5121, "type": "VEC3", "count": 3, "normalized": true},
            {"bufferView": 1, "componentType": 5121, "type": "SCALAR", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 24, "byteStride": 8},
            {"buffer": 0, "byteOffset": 24, "byteLength": 12, "byteStride": 4}]"#;
    let (mesh, report) = read(&gltf(lists, &buffer));
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
    assert_eq!(numbers(&mesh, "texcoord"), [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(mesh.attribute("color").unwrap().bytes, [0, 255, 51, 0, 0, 255, 0, 0, 0]);
    assert_eq!(mesh.attribute("ID").unwrap().bytes, [0, 0, 0]);
    assert_eq!(report.notes(), ["attribute \"FOO\" is left out: glTF does not define it"]);
}

#[test]
fn compressed_primitives_are_refused() {
    let draco = String::from_utf8(gltf_triangle(r#"[{"mesh": 0}]"#))
        .unwrap()
        .replace("{\"attributes\"", "{\"extensions\": {\"KHR_draco_mesh_compression\": {}}, \"attributes\"");
    assert_eq!(read(draco.as_bytes()).0.triangles.len(), 1, "the uncompressed copy is read");
    let bare = draco.replace("\"bufferView\": 0, ", "");
    let message = "mesh 0: KHR_draco_mesh_compression is not supported";
    assert_eq!(error(bare.as_bytes()).to_string(), message);
}

#[test]
fn broken_streams_of_meshopt_are_refused_where_they_are_used() {
    let lists = |stride: u32, filter: &str| {
        format!(
            r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36, "extensions": {{"EXT_meshopt_compression": {{
            "buffer": 0, "byteLength": 36, "byteStride": {stride}, "count": 3, "mode": "ATTRIBUTES", "filter": "{filter}"}}}}}}]"#
        )
    };
    for (stride, filter, first, found) in [
        (12, "NONE", 0x00, "other bytes"),
        (12, "NONE", 0xa1, "other bytes"),
        (13, "NONE", 0xa0, "a stride of 13 bytes"),
        (12, "OCTAHEDRAL", 0xa0, "other bytes"),
    ] {
        let mut bytes = [0; 36];
        bytes[0] = first;
        let message = format!("buffer view 0: expected a stream of EXT_meshopt_compression, found {found}");
        assert_eq!(error(&gltf(&lists(stride, filter), &bytes)).to_string(), message);
    }
    // 12 data blocks of one empty group each, then the tail: three times the baseline.
    let mut bytes = vec![0xa0];
    bytes.extend([0; 12 + 20]);
    for value in [1.0_f32, 2.0, 3.0] {
        bytes.extend(value.to_le_bytes());
    }
    let whole = lists(12, "NONE").replace("\"byteLength\": 36", &format!("\"byteLength\": {}", bytes.len()));
    let (mesh, _) = read(&gltf(&whole, &bytes));
    assert_eq!(mesh.positions, [[1.0, 2.0, 3.0]; 3]);
}

#[test]
fn contradictions_name_the_object_at_fault() {
    let document = String::from_utf8(gltf_triangle(r#"[{"mesh": 0}]"#)).unwrap();
    let check = |from: &str, to: &str, message: &str| {
        assert!(document.contains(from), "{from}");
        assert_eq!(error(document.replace(from, to).as_bytes()).to_string(), message);
    };
    check("\"count\": 3", "\"count\": 4", "data at accessor 0 is cut short: 48 bytes expected, 36 found");
    check(
        "\"bufferView\": 0",
        "\"bufferView\": 7",
        "accessor 0: buffer view index 7 is out of range (1 there)",
    );
    check("\"mesh\": 0", "\"mesh\": 1", "the scene: mesh index 1 is out of range (1 there)");
    check("\"POSITION\": 0", "\"POSITION\": 9", "the file: accessor index 9 is out of range (1 there)");
    check("\"POSITION\"", "\"NORMAL\"", "mesh 0 has no attribute POSITION");
    check("VEC3", "VEC2", "accessor 0: expected positions, found 2 components");
    check(
        "\"byteLength\": 36}]",
        "\"byteLength\": 37}]",
        "data at buffer view 0 is cut short: 37 bytes expected, 36 found",
    );
    check(
        "\"byteLength\": 36}]",
        "\"byteLength\": 36, \"byteStride\": 8}]",
        "accessor 0: expected a stride of an element's size at least, found 8",
    );
    check("\"version\": \"2.0\"", "\"version\": \"1.0\"", "the file: glTF version 1.0 is not supported");
    let message = "the scene: 8000000001 vertices and corners of all instances announced, there can be at most 16777216";
    check("\"count\": 3", "\"count\": 4000000000", message);
    assert!(error(document.replace("5126", "5124").as_bytes()).to_string().contains("component type 5124"));
    assert!(matches!(error(b"{"), MeshError::Json(_)));
}

#[test]
fn instances_cannot_unfold_without_bound() {
    let node = r#"{"mesh": 0},"#.repeat(3000);
    let primitives = r#"{"attributes": {"POSITION": 0}},"#.repeat(3000);
    let children: Vec<String> = (1..=3000).map(|child| child.to_string()).collect();
    let lists = format!(
        r#""scenes": [{{"nodes": [0]}}], "nodes": [{{"children": [{}]}}, {}], "meshes": [{{"primitives": [{}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}]"#,
        children.join(","),
        node.trim_end_matches(','),
        primitives.trim_end_matches(','),
    );
    let error = error(&gltf(&lists, &[0; 36]));
    assert!(matches!(error, MeshError::CountTooLarge { count: 36_009_000, .. }), "{error}");
}
