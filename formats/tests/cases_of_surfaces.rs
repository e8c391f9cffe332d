//! Promise: small files that other programs write come out as their formats define them, whatever
//! format they are written to.
//!
//! The files are those of `cases/surfaces` in the folder of real meshes; what was written is read
//! back by the few lines at the end of this file, which share nothing with the readers.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a failed step is a failed test")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]

mod plain;
mod samples;

use std::path::PathBuf;

use nephrite_formats::{FileReport, MeshFormat, TriangleMesh, read_mesh};
use plain::{Glb, Obj, Ply};
use samples::{data_folder, written};

/// The folder of the cases, where there is one.
fn folder() -> Option<PathBuf> {
    Some(data_folder()?.join("cases/surfaces"))
}

fn read(name: &str) -> Option<(TriangleMesh, FileReport)> {
    Some(read_mesh(folder()?.join(name)).unwrap())
}

fn refused(name: &str) -> Option<String> {
    Some(read_mesh(folder()?.join(name)).unwrap_err().to_string())
}

fn bounds(mesh: &TriangleMesh) -> [[f64; 3]; 2] {
    let points = || mesh.triangles.iter().flatten().map(|&vertex| mesh.point(vertex));
    let fold = |start: f64, choose: fn(f64, f64) -> f64| {
        points().fold([start; 3], |found, point| std::array::from_fn(|i| choose(found[i], point[i])))
    };
    [fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max)]
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    let is_near = found.len() == expected.len()
        && found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= tolerance);
    assert!(is_near, "{found:?} is not {expected:?}");
}

/// The least and the largest value of one of two columns.
fn range(pairs: &[f64], column: usize) -> [f64; 2] {
    let values = || pairs.iter().skip(column).step_by(2).copied();
    [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
}

#[test]
fn v_counts_from_the_top_in_gltf_and_from_the_bottom_elsewhere() {
    const BOTTOM: [f64; 4] = [0.1, 0.1, 0.4, 0.4];
    const TOP: [f64; 4] = [0.9, 0.9, 0.6, 0.6];
    for name in ["uvquad.obj", "uvquad.glb", "uvquad_st.ply"] {
        let Some((mesh, _)) = read(name) else { return };
        let place = |point: &[f64]| match (point[0] > 0.5, point[1] > 0.5) {
            (false, false) => 0,
            (true, false) => 1,
            (true, true) => 2,
            (false, true) => 3,
        };
        let check = |points: Vec<f64>, uv: Vec<f64>, v: [f64; 4]| {
            assert_eq!(uv.len(), 8);
            for (point, uv) in points.chunks(3).zip(uv.chunks(2)) {
                let corner = place(point);
                assert_near(uv, &[[0.25, 0.75, 0.75, 0.25][corner], v[corner]], 1e-6);
            }
        };
        let glb = Glb::parse(&written(&mesh, MeshFormat::Glb));
        check(glb.values("POSITION"), glb.values("TEXCOORD_0"), TOP);
        let obj = Obj::parse(&written(&mesh, MeshFormat::Obj));
        check(obj.positions, obj.texcoords, BOTTOM);
        let ply = Ply::parse(&written(&mesh, MeshFormat::Ply));
        check(ply.columns(&["x", "y", "z"]), ply.columns(&["s", "t"]), BOTTOM);
    }
}

#[test]
fn texture_transforms_are_applied() {
    for (name, [u, v]) in [
        ("packed_tiled.glb", [[0.0316, 4.0], [0.0, 4.0]]),
        ("packed_q.glb", [[0.0079, 1.0], [0.0, 1.0]]),
        ("packed_c.glb", [[0.0079, 1.0], [0.0, 1.0]]),
    ] {
        let Some((mesh, report)) = read(name) else { return };
        let glb = Glb::parse(&written(&mesh, MeshFormat::Glb)).values("TEXCOORD_0");
        assert_near(&range(&glb, 0), &u, 2e-3);
        assert_near(&range(&glb, 1), &v, 2e-3);
        let obj = Obj::parse(&written(&mesh, MeshFormat::Obj)).texcoords;
        assert_near(&range(&obj, 0), &u, 2e-3);
        assert_near(&range(&obj, 1), &[1.0 - v[1], 1.0 - v[0]], 2e-3);
        let notes = [
            "material \"#0\" (5,120 triangles) is left out",
            "image \"#0\" is left out",
            "1 texture is left out",
        ];
        assert_eq!(report.notes(), notes);
    }
}

#[test]
fn quantised_and_compressed_meshes_are_where_they_were() {
    let Some((plain, _)) = read("packed_q.glb") else { return };
    let Some((compressed, _)) = read("packed_c.glb") else { return };
    assert_eq!(plain.triangles.len(), 5120);
    let expected = [[-1.0; 3], [1.0; 3]];
    for mesh in [&plain, &compressed] {
        assert_near(bounds(mesh).as_flattened(), expected.as_flattened(), 1e-3);
    }
    // gltfpack encodes the same numbers in both.
    let corners = |mesh: &TriangleMesh| {
        let mut corners: Vec<[[u32; 3]; 3]> = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let mut corners = triangle.map(|vertex| mesh.positions[vertex as usize].map(f32::to_bits));
                let first = (0..3).min_by_key(|&i| corners[i]).unwrap();
                corners.rotate_left(first);
                corners
            })
            .collect();
        corners.sort_unstable();
        corners
    };
    assert_eq!(corners(&compressed), corners(&plain));
    for (i, normal) in
        compressed.attribute("normal").unwrap().values().collect::<Vec<_>>().chunks(3).enumerate()
    {
        let position = compressed.positions[i].map(f64::from);
        let dot: f64 = normal.iter().zip(position).map(|(a, b)| a * b).sum();
        assert!(dot > 0.97, "{normal:?} at {position:?}");
    }
}

#[test]
fn materials_groups_and_solids_are_named() {
    for (name, expected) in [
        (
            "two_materials.obj",
            &[
                "group \"upper\" (2,528 triangles)",
                "material \"upper\" (2,528 triangles)",
                "material \"lower\" (2,592 triangles)",
            ][..],
        ),
        (
            "two_materials.glb",
            &[
                "material \"upper\" (2,528 triangles)",
                "material \"lower\" (2,592 triangles)",
                "object \"ball\" (5,120 triangles)",
            ],
        ),
        (
            "multi_solid.stl",
            &[
                "solid \"Inlet\" (320 triangles)",
                "solid \"Wall\" (320 triangles)",
                "solid \"Outlet\" (320 triangles)",
            ],
        ),
        (
            "colour_viscam.stl",
            &["face colour \"#ff0000\" (624 triangles)", "face colour \"#0000ff\" (656 triangles)"],
        ),
        (
            "colour_magics.stl",
            &["face colour \"#ff0000\" (624 triangles)", "face colour \"#0000ff\" (656 triangles)"],
        ),
        (
            "face_colours.ply",
            &["face colour \"#ff0000\" (624 triangles)", "face colour \"#0000ff\" (656 triangles)"],
        ),
        (
            "groups.obj",
            &[
                "object \"part0\" (320 triangles)",
                "object \"part1\" (288 triangles)",
                "material \"hub_paint\" (320 triangles)",
                "group \"rim\" (288 triangles)",
            ],
        ),
    ] {
        let Some((_, report)) = read(name) else { return };
        let notes = report.notes();
        for expected in expected {
            let is_there = notes.iter().any(|note| *note == format!("{expected} is left out"));
            assert!(is_there, "{name}: {expected} is not in {notes:?}");
        }
    }
}

#[test]
fn colours_reach_ply_as_bytes() {
    for name in ["objcol.obj", "coff_float.off", "ncoff.off", "colour_under_off.off", "bom.ply"] {
        let Some((mesh, _)) = read(name) else { return };
        let ply = Ply::parse(&written(&mesh, MeshFormat::Ply));
        for channel in ["red", "green", "blue"] {
            assert!(ply.header.contains(&format!("property uchar {channel}\n")), "{name}: {}", ply.header);
        }
        let rows = ply.columns(&["z", "red", "green", "blue"]);
        let mut n_checked = 0;
        for row in rows.chunks(4) {
            let expected = match name {
                // Colours stand behind the vertices of the lower side only.
                "objcol.obj" if row[0] == 0.0 => [255.0, 0.0, 0.0],
                "objcol.obj" => [255.0; 3],
                _ if row[0] > 1e-6 => [255.0, 0.0, 0.0],
                _ if row[0] < -1e-6 => [0.0, 0.0, 255.0],
                _ => continue,
            };
            assert_eq!(row[1..], expected, "{name} at {}", row[0]);
            n_checked += 1;
        }
        assert!(n_checked >= 8, "{name}: {n_checked}");
    }
}

#[test]
fn normals_and_colours_of_off_keep_their_places() {
    let Some((mesh, report)) = read("ncoff.off") else { return };
    assert_eq!(mesh.triangles.len(), 320);
    assert!(report.notes().is_empty());
    let ply = Ply::parse(&written(&mesh, MeshFormat::Ply));
    for row in ply.columns(&["x", "y", "z", "nx", "ny", "nz"]).chunks(6) {
        assert_near(&row[3..], &row[..3], 2e-2);
    }
}

#[test]
fn texture_coordinates_of_corners_make_seams() {
    let Some((mesh, report)) = read("wedge_uv.ply") else { return };
    assert_eq!(mesh.triangles.len(), 1280);
    assert_eq!(report.notes(), ["texture \"skin.png\" is left out"]);
    // The corners of the text, three coordinates and a pair for each.
    let text = std::fs::read_to_string(folder().unwrap().join("wedge_uv.ply")).unwrap();
    let (header, body) = text.split_once("end_header\n").unwrap();
    assert!(header.contains("property list uchar float texcoord"));
    let rows: Vec<Vec<f64>> = body
        .lines()
        .map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect())
        .collect();
    let obj = Obj::parse(&written(&mesh, MeshFormat::Obj));
    assert_eq!(obj.faces.len(), 1280);
    for (face, row) in obj.faces.iter().zip(&rows[642..]) {
        assert_eq!((row[0], row[4]), (3.0, 6.0));
        for (i, &[position, texcoord]) in face.iter().enumerate() {
            assert_near(
                &obj.positions[3 * position..3 * position + 3],
                &rows[row[1 + i] as usize][..3],
                1e-6,
            );
            assert_near(&obj.texcoords[2 * texcoord..2 * texcoord + 2], &row[5 + 2 * i..7 + 2 * i], 1e-6);
        }
    }
}

#[test]
fn a_skinned_mesh_ignores_its_node() {
    let Some((mesh, report)) = read("skin_morph.glb") else { return };
    assert_eq!(mesh.triangles.len(), 1280);
    assert_near(bounds(&mesh).as_flattened(), [[-1.0; 3], [1.0; 3]].as_flattened(), 1e-3);
    let notes = report.notes();
    assert!(notes.contains(&"skin \"#0\" is left out".to_owned()), "{notes:?}");
    assert!(notes.contains(&"1 morph target is left out".to_owned()), "{notes:?}");
}

#[test]
fn normals_that_some_primitives_lack_are_computed() {
    let Some((mesh, report)) = read("mixed_attributes.glb") else { return };
    let glb = Glb::parse(&written(&mesh, MeshFormat::Glb));
    let (points, normals) = (glb.values("POSITION"), glb.values("NORMAL"));
    assert_eq!(points.len(), normals.len());
    for (point, normal) in points.chunks(3).zip(normals.chunks(3)) {
        let length = normal.iter().map(|value| value * value).sum::<f64>().sqrt();
        let dot: f64 = point.iter().zip(normal).map(|(a, b)| a * b).sum();
        assert!((length - 1.0).abs() < 1e-5 && dot > 20.0_f64.to_radians().cos(), "{normal:?} at {point:?}");
    }
    let notes = report.notes();
    let is_told = |text: &str| notes.iter().any(|note| note.contains(text));
    assert!(
        is_told("attribute \"normal\" is absent at") && is_told("computed from the triangles"),
        "{notes:?}"
    );
    assert!(is_told("attribute \"color\" is absent at"), "{notes:?}");
}

#[test]
fn instances_unfold() {
    let Some((stones, _)) = read("stones_300.glb") else { return };
    assert_eq!(stones.triangles.len(), 384_000);
    let Some((copies, report)) = read("gpu_instancing_optional.glb") else { return };
    assert_eq!(copies.triangles.len(), 3840);
    assert_near(bounds(&copies).as_flattened(), &[-1.0, -1.0, -1.0, 11.0, 1.0, 1.0], 1e-5);
    assert!(report.notes().is_empty());
}

#[test]
fn vertices_without_a_position_go_if_no_face_uses_them() {
    let Some((mesh, report)) = read("nan_unused.ply") else { return };
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (1280, 642));
    assert_near(bounds(&mesh).as_flattened(), [[-1.0; 3], [1.0; 3]].as_flattened(), 1e-3);
    let notes = ["50 unused points without a usable position are left out"];
    assert_eq!(report.notes(), notes);
}

#[test]
fn dialects_are_read() {
    for (name, n_triangles) in
        [("bom.ply", 1280), ("binary.off", 320), ("utf16.obj", 320), ("wrong_count.stl", 320)]
    {
        let Some((mesh, report)) = read(name) else { return };
        assert_eq!(mesh.triangles.len(), n_triangles, "{name}");
        assert_near(bounds(&mesh).as_flattened(), [[-1.0; 3], [1.0; 3]].as_flattened(), 0.06);
        let noted = name == "wrong_count.stl";
        assert_eq!(report.notes().iter().any(|note| note.contains("320") && note.contains(" 0 ")), noted);
    }
}

#[test]
fn what_is_not_read_is_named() {
    for (name, word) in [("unknown_required.glb", "ACME_lattice_deform"), ("gltf1.gltf", "glTF version 1.0")]
    {
        let Some(message) = refused(name) else { return };
        assert!(message.contains(word), "{name}: {message}");
    }
    let Some(folder) = folder() else { return };
    let volumes = [
        ("poly.vtp", "VTP"),
        ("image.vti", "VTI"),
        ("phys.inp", "Abaqus"),
        ("two_pieces.vtu", "no known format"),
    ];
    for (name, word) in volumes {
        let message = read_mesh(folder.join("../volumes").join(name)).unwrap_err().to_string();
        assert!(message.contains(word) && message.contains("PLY") && message.contains("PLOT3D"), "{message}");
    }
}
