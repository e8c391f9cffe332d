//! Promise: the conventions of each format are applied, and the dialects that other programs write
//! are read. Every file here is literal, so that what it means can be seen.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]

mod plain;
mod samples;

use nephrite_formats::{FileReport, MeshFormat, ScalarType, TriangleMesh, read_mesh_bytes};
use plain::{Obj, Ply};
use samples::{floats, gltf, written};

fn read(bytes: impl AsRef<[u8]>, format: MeshFormat) -> (TriangleMesh, FileReport) {
    read_mesh_bytes(bytes.as_ref(), format).unwrap()
}

fn values(mesh: &TriangleMesh, name: &str) -> Vec<f64> {
    mesh.attribute(name).unwrap().values().collect()
}

fn assert_near(found: &[f64], expected: &[f64]) {
    let is_near = found.len() == expected.len()
        && found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6);
    assert!(is_near, "{found:?} is not {expected:?}");
}

/// A glTF triangle whose accessors 1 and on are given; views are 36 bytes of positions, then the
/// rest.
fn triangle(attributes: &str, primitive: &str, accessors: &str, rest: &str, data: &[u8]) -> Vec<u8> {
    let positions = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let buffer = [&positions, data].concat();
    let lists = format!(
        r#""nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0{attributes}}}{primitive}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}}{accessors}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": {}}}]{rest}"#,
        data.len()
    );
    gltf(&lists, &buffer)
}

const UV: &str = r#", {"bufferView": 1, "componentType": 5126, "type": "VEC2", "count": 3}"#;

#[test]
fn v_is_turned_at_the_edge_of_every_format_but_gltf() {
    // (0.25, 0.1), (0.75, 0.1), (0.75, 0.4), counted from the bottom.
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.1\nvt 0.75 0.1\nvt 0.75 0.4\nf 1/1 2/2 3/3\n";
    let ply = |u: &str, v: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float {u}\n\
             property float {v}\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0.25 0.1\n1 0 0 0.75 0.1\n\
             0 1 0 0.75 0.4\n3 0 1 2\n"
        )
    };
    let off = "STOFF\n3 1 0\n0 0 0 0.25 0.1\n1 0 0 0.75 0.1\n0 1 0 0.75 0.4\n3 0 1 2\n";
    let gltf = triangle(", \"TEXCOORD_0\": 1", "", UV, "", &floats(&[0.25, 0.9, 0.75, 0.9, 0.75, 0.6]));
    let files: Vec<(MeshFormat, Vec<u8>)> = vec![
        (MeshFormat::Obj, obj.into()),
        (MeshFormat::Ply, ply("s", "t").into()),
        (MeshFormat::Ply, ply("u", "v").into()),
        (MeshFormat::Ply, ply("texture_u", "texture_v").into()),
        (MeshFormat::Off, off.into()),
        (MeshFormat::Gltf, gltf),
    ];
    for (format, bytes) in files {
        let (mesh, _) = read(&bytes, format);
        assert_near(&values(&mesh, "texcoord"), &[0.25, 0.9, 0.75, 0.9, 0.75, 0.6]);
        let bottom = [0.25, 0.1, 0.75, 0.1, 0.75, 0.4];
        assert_near(&Obj::parse(&written(&mesh, MeshFormat::Obj)).texcoords, &bottom);
        assert_near(&Ply::parse(&written(&mesh, MeshFormat::Ply)).columns(&["s", "t"]), &bottom);
        let text = String::from_utf8(written(&mesh, MeshFormat::Off)).unwrap();
        assert!(text.starts_with("STOFF") && text.contains("0.0 0.0 0.0 0.25 0.1\n"), "{text}");
    }
}

#[test]
fn texture_transforms_turn_scale_and_move() {
    let material = |textures: &str| {
        format!(", \"materials\": [{{{textures}}}], \"extensionsUsed\": [\"KHR_texture_transform\"]")
    };
    let uv = floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let read_with = |textures: &str| {
        let bytes = triangle(", \"TEXCOORD_0\": 1", ", \"material\": 0", UV, &material(textures), &uv);
        read(bytes, MeshFormat::Gltf)
    };
    let base = |transform: &str| {
        format!(
            r#""pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, "extensions": {{"KHR_texture_transform": {{{transform}}}}}}}}}"#
        )
    };
    // The extension's own example: the lower left quadrant of the picture, turned clockwise.
    let (mesh, _) =
        read_with(&base(r#""offset": [0, 1], "rotation": 1.5707963267948966, "scale": [0.5, 0.5]"#));
    assert_near(&values(&mesh, "texcoord"), &[0.0, 1.0, 0.0, 0.5, 0.5, 1.0]);
    // Another set is moved, this one stays.
    let (mesh, _) = read_with(&base(r#""offset": [5, 5], "texCoord": 1"#));
    assert_near(&values(&mesh, "texcoord"), &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let both = base(r#""scale": [2, 2]"#) + r#", "normalTexture": {"index": 0}"#;
    let (mesh, report) = read_with(&both);
    assert_near(&values(&mesh, "texcoord"), &[0.0, 0.0, 2.0, 0.0, 0.0, 2.0]);
    let note = "attribute \"texcoord\" is under the transform of the base colour's texture; other textures have others";
    assert!(report.notes().iter().any(|found| found == note), "{:?}", report.notes());
}

#[test]
fn quantised_attributes_become_floats() {
    let accessors = r#", {"bufferView": 1, "componentType": 5123, "type": "VEC2", "count": 3, "normalized": true},
        {"bufferView": 1, "byteOffset": 12, "componentType": 5120, "type": "VEC3", "count": 3, "normalized": true},
        {"bufferView": 1, "componentType": 5123, "type": "VEC2", "count": 3}"#;
    let mut data: Vec<u8> =
        [0_u16, 65535, 32768, 0, 65535, 65535].iter().flat_map(|v| v.to_le_bytes()).collect();
    data.extend([0, 0, 127].repeat(3));
    data.extend([0; 3]);
    let attributes = ", \"TEXCOORD_0\": 1, \"NORMAL\": 2, \"TEXCOORD_1\": 3";
    let (mesh, _) = read(triangle(attributes, "", accessors, "", &data), MeshFormat::Gltf);
    assert!(mesh.attributes.iter().all(|attribute| attribute.scalar == ScalarType::F32));
    assert!((values(&mesh, "texcoord")[2] - 32768.0 / 65535.0).abs() < 1e-6);
    assert_near(&values(&mesh, "normal")[..3], &[0.0, 0.0, 1.0]);
    assert_near(&values(&mesh, "texcoord_1")[..3], &[0.0, 65535.0, 32768.0]);
}

#[test]
fn required_extensions_are_known_or_refused_by_name() {
    let file = |name: &str| triangle("", "", "", &format!(", \"extensionsRequired\": [\"{name}\"]"), &[0; 4]);
    for name in ["KHR_mesh_quantization", "KHR_materials_unlit", "EXT_texture_webp", "KHR_texture_basisu"] {
        assert_eq!(read(file(name), MeshFormat::Gltf).0.triangles.len(), 1, "{name}");
    }
    for name in ["KHR_draco_mesh_compression", "ACME_bend", ""] {
        let error = read_mesh_bytes(&file(name), MeshFormat::Gltf).unwrap_err().to_string();
        assert_eq!(error, format!("the file: the required extension {name} is not supported"));
    }
}

#[test]
fn copies_are_scaled_turned_and_moved() {
    let accessors = r#", {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 2},
        {"bufferView": 1, "byteOffset": 24, "componentType": 5122, "type": "VEC4", "count": 2, "normalized": true},
        {"bufferView": 1, "byteOffset": 40, "componentType": 5126, "type": "VEC3", "count": 2}"#;
    let mut data = floats(&[10.0, 0.0, 0.0, 0.0, 20.0, 0.0]);
    // No turn, and a half turn about z.
    data.extend([0_i16, 0, 0, 32767, 0, 0, 32767, 0].iter().flat_map(|v| v.to_le_bytes()));
    data.extend(floats(&[2.0, 2.0, 2.0, 1.0, 1.0, 1.0]));
    let text = String::from_utf8(triangle("", "", accessors, "", &data)).unwrap();
    let node = r#"{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1, "ROTATION": 2, "SCALE": 3, "_ID": 1}}}}"#;
    let (mesh, report) = read(text.replace(r#"{"mesh": 0}"#, node), MeshFormat::Gltf);
    assert_eq!(mesh.triangles.len(), 2);
    let points: Vec<f64> = (0..6).flat_map(|vertex| mesh.point(vertex)).collect();
    let expected =
        [10.0, 0.0, 0.0, 12.0, 0.0, 0.0, 10.0, 2.0, 0.0, 0.0, 20.0, 0.0, -1.0, 20.0, 0.0, 0.0, 19.0, 0.0];
    assert_near(&points, &expected);
    assert_eq!(report.notes(), ["property \"_ID\" (2 instances) is left out"]);
}

#[test]
fn normals_that_corners_of_obj_lack_are_computed() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3\nf 1 3 4\n";
    let (mesh, report) = read(text, MeshFormat::Obj);
    let normals = values(&mesh, "normal");
    let of_vertices: Vec<&[f64]> = normals.chunks(3).collect();
    assert_eq!(of_vertices[..2], [[0.0, 0.0, -1.0], [0.0, 0.0, -1.0]]);
    assert!(of_vertices[2..].iter().all(|normal| *normal == [0.0, 0.0, 1.0]), "{normals:?}");
    let note = "attribute \"normal\" is absent at 3 vertices and computed from the triangles there";
    assert_eq!(report.notes(), [note]);
}

#[test]
fn colours_of_any_type_reach_ply_as_bytes() {
    let text = |scalar: &str, rows: [&str; 3]| {
        format!(
            "ply\nformat ascii 1.0\nelement vertices 3\nproperty float x\nproperty float y\nproperty float z\nproperty {scalar} red\n\
             property {scalar} green\nproperty {scalar} blue\nelement faces 1\nproperty list uchar int vertex_indices\nend_header\n\
             0 0 0 {}\n1 0 0 {}\n0 1 0 {}\n3 0 1 2\n",
            rows[0], rows[1], rows[2]
        )
    };
    for (scalar, rows) in [
        ("uchar", ["255 0 51", "0 0 0", "0 255 0"]),
        ("ushort", ["65535 0 13107", "0 0 0", "0 65535 0"]),
        ("float", ["1 0 0.2", "0 0 0", "0 1 0"]),
        ("double", ["1.0 0.0 0.2", "0 0 0", "-0.5 3 0"]),
        // Numbers up to 255 as floats.
        ("float", ["255 0 51", "0 0 0", "0 255 0"]),
    ] {
        let (mesh, _) = read(text(scalar, rows), MeshFormat::Ply);
        let ply = Ply::parse(&written(&mesh, MeshFormat::Ply));
        assert!(ply.header.contains("property uchar red\nproperty uchar green\nproperty uchar blue\n"));
        let expected = [255.0, 0.0, 51.0, 0.0, 0.0, 0.0, 0.0, 255.0, 0.0];
        assert_eq!(ply.columns(&["red", "green", "blue"]), expected, "{scalar} {rows:?}");
    }
}

#[test]
fn texture_coordinates_of_corners_in_big_endian_ply() {
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property ushort id\nelement face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
        property int texnumber\nend_header\n"
        .to_vec();
    for (id, [x, y]) in [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].into_iter().enumerate() {
        bytes.extend([x, y, 0.0].iter().flat_map(|value| value.to_be_bytes()));
        bytes.extend((id as u16).to_be_bytes());
    }
    for (corners, uv) in
        [([0, 1, 2], [0.0, 0.0, 1.0, 0.0, 1.0, 1.0]), ([0, 2, 3], [0.0, 0.0, 0.5, 0.5, 0.0, 0.5])]
    {
        bytes.push(3);
        bytes.extend(corners.iter().flat_map(|corner: &u32| corner.to_be_bytes()));
        bytes.push(6);
        bytes.extend(uv.iter().flat_map(|value: &f32| value.to_be_bytes()));
        bytes.extend([0; 4]);
    }
    let (mesh, report) = read(bytes, MeshFormat::Ply);
    // Vertex 2 has two pairs of texture coordinates.
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 4, 3]]);
    assert_eq!(values(&mesh, "id"), [0.0, 1.0, 2.0, 3.0, 2.0]);
    assert_near(&values(&mesh, "texcoord"), &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.5, 0.5, 0.5]);
    assert_eq!(report.notes(), ["face data \"texnumber\" (2 faces) is left out"]);
}

#[test]
fn letters_of_off_in_any_order() {
    let row =
        |parts: [&str; 2]| format!("0 0 0 {0}\n1 0 0 {0}\n0 1 0 {0}\n3 0 1 2\n", parts.join(" ").trim());
    let (normal, bytes, unit) = ("0 -0.6 0.8", "255 0 51 255", "1.0 0.0 0.2 1.0");
    for (keyword, parts) in [
        // Geomview and MeshLab disagree about what comes first; the numbers tell.
        ("CNOFF", [normal, bytes]),
        ("CNOFF", [bytes, normal]),
        ("NCOFF", [bytes, normal]),
        ("NCOFF", [normal, bytes]),
        ("NCOFF", [normal, unit]),
        ("CNOFF", [unit, normal]),
        ("CNOFF", [normal, "255 0 51"]),
        ("COFF", [bytes, ""]),
        ("COFF", ["255 0 51", ""]),
        ("OFF", [bytes, ""]),
        ("OFF", ["255 0 51", ""]),
        ("NOFF", [normal, ""]),
        ("OFF", [normal, ""]),
    ] {
        let (mesh, report) = read(format!("{keyword}\n3 1 0\n{}", row(parts)), MeshFormat::Off);
        assert_eq!(report.notes(), [""; 0], "{keyword} {parts:?}");
        if let Some(color) = mesh.attribute("color") {
            let largest = if color.scalar == ScalarType::U8 { 255.0 } else { 1.0 };
            let shares: Vec<f64> = color.values().take(3).map(|value| value / largest).collect();
            assert_near(&shares, &[1.0, 0.0, 0.2]);
        }
        if parts.contains(&normal) {
            assert_near(&values(&mesh, "normal")[..3], &[0.0, -0.6, 0.8]);
        }
        let n_expected = parts.iter().filter(|part| !part.is_empty()).count();
        assert_eq!(mesh.attributes.len(), n_expected, "{keyword} {parts:?}");
    }
    let (_, report) = read("OFF\n3 1 0\n0 0 0 7 8 -9\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n", MeshFormat::Off);
    let note = "attribute \"numbers behind the coordinates\" (3 vertices) is left out";
    assert_eq!(report.notes(), [note]);
}

#[test]
fn binary_off_in_both_byte_orders() {
    for is_big_endian in [true, false] {
        for has_colors in [true, false] {
            let number = |bits: u32| if is_big_endian { bits.to_be_bytes() } else { bits.to_le_bytes() };
            let mut bytes = b"NOFF BINARY\n".to_vec();
            bytes.extend([3, 1, 3].into_iter().flat_map(number));
            for position in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
                bytes.extend(
                    position.iter().chain(&[0.0, 0.0, 1.0]).flat_map(|value| number(value.to_bits())),
                );
            }
            bytes.extend([3, 0, 1, 2].into_iter().flat_map(number));
            if has_colors {
                bytes.extend(number(4));
                bytes.extend([1.0_f32, 0.0, 0.0, 1.0].iter().flat_map(|value| number(value.to_bits())));
            }
            let (mesh, report) = read(&bytes, MeshFormat::Off);
            assert_eq!((mesh.triangles.len(), mesh.positions[1]), (1, [1.0, 0.0, 0.0]));
            assert_near(&values(&mesh, "normal")[..3], &[0.0, 0.0, 1.0]);
            let notes = ["face colour \"#ff0000\" (1 triangle) is left out"];
            assert_eq!(report.notes(), notes[..usize::from(has_colors)]);
            assert!(read_mesh_bytes(&bytes[..bytes.len() - 2], MeshFormat::Off).is_err());
        }
    }
}

#[test]
fn vertices_without_a_position_go_in_every_format() {
    let obj = "v 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1e300\nf 1 3 4\n";
    let off = "OFF\n5 1 0\n0 0 0\nnan 0 0\n1 0 0\n0 1 0\n0 0 inf\n3 0 2 3\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty double z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0\nnan 0 0\n1 0 0\n0 1 0\n0 0 inf\n3 0 2 3\n";
    let mut data =
        floats(&[0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f32::INFINITY]);
    data.extend([0, 2, 3, 0]);
    let lists = r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 5},
            {"bufferView": 0, "byteOffset": 60, "componentType": 5121, "type": "SCALAR", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 64}]"#;
    let gltf = gltf(lists, &data);
    for (format, bytes) in [
        (MeshFormat::Obj, obj.as_bytes()),
        (MeshFormat::Off, off.as_bytes()),
        (MeshFormat::Ply, ply.as_bytes()),
        (MeshFormat::Gltf, &gltf),
    ] {
        let (mesh, report) = read(bytes, format);
        assert_eq!((mesh.positions.len(), &mesh.triangles), (3, &vec![[0, 1, 2]]), "{format}");
        assert_eq!(report.notes(), ["2 unused points without a usable position are left out"], "{format}");
        assert_eq!(mesh.positions[2], [0.0, 1.0, 0.0], "{format}");
    }
    let error = read_mesh_bytes(obj.replace("f 1 3 4", "f 1 2 4").as_bytes(), MeshFormat::Obj).unwrap_err();
    assert_eq!(error.to_string(), "line 2: coordinate NaN is not finite");
}

#[test]
fn text_in_utf_16() {
    let texts = [
        (MeshFormat::Obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\no t\u{fc}r\nf 1 2 3\n"),
        (MeshFormat::Off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        (
            MeshFormat::Stl,
            "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n",
        ),
    ];
    for (format, text) in texts {
        let units: Vec<u16> = std::iter::once(0xFEFF).chain(text.encode_utf16()).collect();
        for bytes in [
            units.iter().flat_map(|unit| unit.to_le_bytes()).collect::<Vec<u8>>(),
            units.iter().flat_map(|unit| unit.to_be_bytes()).collect(),
        ] {
            assert_eq!(MeshFormat::detect(&bytes, None), Some(format));
            let (mesh, report) = read(&bytes, format);
            assert_eq!(mesh, read(text, format).0);
            assert_eq!(report.notes(), read(text, format).1.notes());
        }
    }
}

#[test]
fn binary_stl_of_another_count_than_it_states() {
    let file = |stated: u32, n_triangles: usize| {
        let mut bytes = vec![b' '; 80];
        bytes.extend(stated.to_le_bytes());
        for i in 0..n_triangles {
            bytes.extend([0; 12]);
            let x = i as f32;
            bytes.extend(floats(&[x, 0.0, 0.0, x + 1.0, 0.0, 0.0, x, 1.0, 0.0]));
            bytes.extend([0; 2]);
        }
        bytes
    };
    for stated in [0, 2, u32::MAX] {
        let (mesh, report) = read(file(stated, 3), MeshFormat::Stl);
        assert_eq!((mesh.triangles.len(), report.notes().len()), (3, 1), "{:?}", report.notes());
    }
    assert!(read(file(3, 3), MeshFormat::Stl).1.notes().is_empty());
    let error = read_mesh_bytes(&file(5, 3), MeshFormat::Stl).unwrap_err().to_string();
    assert_eq!(error, "STL file at byte 0 is cut short: 334 bytes expected, 234 found");
}
