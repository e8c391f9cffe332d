//! Promise: a mesh that is written and read again is the same mesh, as far as the format can
//! represent it.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod samples;

use nephrite_formats::{Attribute, MeshFormat, ScalarType, TriangleMesh, read_mesh, write_mesh};
use proptest::prelude::*;
use samples::{WRITTEN, again, bumpy_square, corners, counting, decorated_square};

/// Meshes of a few vertices with any finite positions, any triangles and attributes of all types.
fn meshes() -> impl Strategy<Value = TriangleMesh> {
    let coordinate = prop_oneof![
        -100.0_f32..100.0,
        any::<f32>().prop_filter("finite", |value| value.is_finite()),
        Just(0.0),
        Just(-0.0),
    ];
    let positions = prop::collection::vec(prop::array::uniform3(coordinate), 1..20);
    positions.prop_flat_map(|positions| {
        let n_vertices = positions.len();
        let index = 0..u32::try_from(n_vertices).unwrap();
        let triangles = prop::collection::vec(prop::array::uniform3(index), 1..30);
        (Just(positions), triangles, prop::collection::vec(attributes(n_vertices), 0..4)).prop_map(
            |(positions, triangles, mut attributes)| {
                for (i, attribute) in attributes.iter_mut().enumerate() {
                    attribute.name += &format!("{i}x");
                }
                TriangleMesh { positions, triangles, attributes, ..TriangleMesh::default() }
            },
        )
    })
}

fn attributes(n_vertices: usize) -> impl Strategy<Value = Attribute> {
    let scalars = [
        ScalarType::I8,
        ScalarType::U8,
        ScalarType::I16,
        ScalarType::U16,
        ScalarType::I32,
        ScalarType::U32,
        ScalarType::F32,
        ScalarType::F64,
    ];
    ("[a-z]{1,5}", prop::sample::select(scalars.to_vec())).prop_flat_map(move |(name, scalar)| {
        let bytes = prop::collection::vec(any::<u8>(), n_vertices * scalar.size_bytes());
        bytes.prop_map(move |bytes| Attribute { name: name.clone(), scalar, n_components: 1, bytes })
    })
}

/// Positions are compared as bits, so that -0 and 0 differ.
fn bits(mesh: &TriangleMesh) -> Vec<[u32; 3]> {
    mesh.positions.iter().map(|position| position.map(f32::to_bits)).collect()
}

proptest! {
    #[test]
    fn ply_keeps_every_bit(mesh in meshes()) {
        let read = again(&mesh, MeshFormat::Ply);
        prop_assert_eq!(bits(&read), bits(&mesh));
        prop_assert_eq!(read, mesh);
    }

    #[test]
    fn text_and_glb_keep_vertices_and_triangles(mesh in meshes()) {
        for format in [MeshFormat::Obj, MeshFormat::Off, MeshFormat::Glb] {
            let read = again(&mesh, format);
            prop_assert_eq!(&read.triangles, &mesh.triangles, "{}", format);
            prop_assert_eq!(&read.positions, &mesh.positions, "{}", format);
        }
    }

    #[test]
    fn stl_keeps_corners(mesh in meshes()) {
        prop_assert_eq!(corners(&again(&mesh, MeshFormat::Stl)), corners(&mesh));
    }

    #[test]
    fn glb_keeps_small_types(mesh in meshes()) {
        let read = again(&mesh, MeshFormat::Glb);
        for attribute in &mesh.attributes {
            let found = read.attribute(&attribute.name).unwrap();
            match attribute.scalar {
                ScalarType::I32 | ScalarType::U32 | ScalarType::F64 => prop_assert_eq!(found.scalar, ScalarType::F32),
                _ => prop_assert_eq!(found, attribute),
            }
        }
    }

    /// Positions about an origin come back in place, to the precision of doubles and of the new
    /// origin.
    #[test]
    fn shifted_meshes_stay_in_place(offset in prop::array::uniform3(-1e8_f64..1e8)) {
        let mut mesh = bumpy_square(5);
        mesh.origin = offset;
        for format in WRITTEN {
            let read = again(&mesh, format);
            let far = offset.iter().fold(1.0_f64, |far, value| far.max(value.abs()));
            let bound = read.rounding + 4.0 * far * f64::EPSILON;
            for (a, b) in corners(&mesh).iter().zip(corners(&read)) {
                let distance = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
                prop_assert!(distance <= bound, "{format}: {distance} beyond {bound}");
            }
            prop_assert!(read.rounding < 1e-6, "{}: {}", format, read.rounding);
        }
    }
}

#[test]
fn attributes_come_back_from_the_formats_that_hold_them() {
    let mesh = decorated_square(4);
    let check = |format, names: &[&str]| {
        let read = again(&mesh, format);
        let found: Vec<&str> = read.attributes.iter().map(|attribute| attribute.name.as_str()).collect();
        let mut sorted = (found.clone(), names.to_vec());
        sorted.0.sort_unstable();
        sorted.1.sort_unstable();
        assert_eq!(sorted.0, sorted.1, "{format}");
        read
    };
    assert_eq!(check(MeshFormat::Ply, &["normal", "color", "texcoord", "label"]), mesh);
    let glb = check(MeshFormat::Glb, &["normal", "color", "texcoord", "label"]);
    for attribute in &mesh.attributes {
        assert_eq!(glb.attribute(&attribute.name), Some(attribute));
    }
    let off = check(MeshFormat::Off, &["normal", "color", "texcoord"]);
    for name in ["normal", "color", "texcoord"] {
        assert_eq!(off.attribute(name), mesh.attribute(name));
    }
    let obj = check(MeshFormat::Obj, &["normal", "color", "texcoord"]);
    for name in ["normal", "texcoord"] {
        assert_eq!(obj.attribute(name), mesh.attribute(name));
    }
    // OBJ has colours as numbers from 0 to 1.
    let color = obj.attribute("color").unwrap();
    assert_eq!((color.scalar, color.n_components), (ScalarType::F32, 4));
    let first = f32::from_le_bytes(color.bytes[4..8].try_into().unwrap());
    assert!((first - f32::from(mesh.attribute("color").unwrap().bytes[1]) / 255.0).abs() < 1e-7);
    check(MeshFormat::Stl, &[]);
}

#[test]
fn wide_and_odd_attributes_find_a_place_in_glb() {
    let mut mesh = bumpy_square(3);
    mesh.attributes = vec![
        counting("spectrum", ScalarType::F32, 6, 9),
        counting("color", ScalarType::U8, 3, 9),
        counting("color_1", ScalarType::U16, 4, 9),
        counting("joints_0", ScalarType::U8, 4, 9),
        counting("normal", ScalarType::I8, 3, 9),
        counting("position", ScalarType::I16, 2, 9),
    ];
    let read = again(&mesh, MeshFormat::Glb);
    for attribute in &mesh.attributes[1..] {
        assert_eq!(read.attribute(&attribute.name), Some(attribute));
    }
    assert_eq!(read.attribute("spectrum_5").unwrap().n_components, 1);
}

#[test]
fn files_are_written_by_extension_in_any_case() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = bumpy_square(4);
    for name in ["a.ply", "a.OBJ", "a.Stl", "a.off", "a.GLB"] {
        let path = folder.path().join(name);
        write_mesh(&path, &mesh).unwrap();
        let (read, report) = read_mesh(&path).unwrap();
        assert_eq!(corners(&read), corners(&mesh), "{name}");
        assert!(report.notes().is_empty(), "{name}");
    }
}

#[test]
fn a_mesh_without_triangles_can_be_written() {
    let mut mesh = bumpy_square(2);
    mesh.triangles.clear();
    for format in WRITTEN {
        let error = nephrite_formats::read_mesh_bytes(&samples::written(&mesh, format), format).unwrap_err();
        assert!(matches!(error, nephrite_formats::MeshError::NoFaces { .. }), "{format}: {error}");
    }
}
