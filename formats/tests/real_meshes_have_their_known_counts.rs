//! Promise: meshes from scanners, modellers and other programs are read with their known counts.
//!
//! Another reader made the counts; they are in the list beside the meshes. Without that folder
//! nothing is tested.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod samples;

use std::path::Path;

use nephrite_formats::{FileFormat, MeshFormat, read_mesh};
use samples::data_folder;

/// A line of the list: file, vertices, vertices after an exact weld, triangles.
struct Known {
    file: String,
    n_vertices: usize,
    n_welded: Option<usize>,
    n_triangles: usize,
}

fn known(folder: &Path) -> Vec<Known> {
    let list = std::fs::read_to_string(folder.join("MANIFEST.md")).unwrap();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, file, vertices, triangles, ..] = cells[..] else { return None };
        let is_mesh = ["surfaces/", "hard/", "gltf/"].iter().any(|start| file.starts_with(start));
        let n_triangles = triangles.parse().ok().filter(|_| is_mesh)?;
        let mut numbers = vertices.split(|c: char| !c.is_ascii_digit()).filter(|word| !word.is_empty());
        let n_vertices = numbers.next()?.parse().ok()?;
        let n_welded = numbers.next().and_then(|word| word.parse().ok());
        Some(Known { file: file.into(), n_vertices, n_welded, n_triangles })
    };
    list.lines().filter_map(row).collect()
}

#[test]
fn real_meshes_have_their_known_counts() {
    let Some(folder) = data_folder() else { return };
    let meshes = known(&folder);
    assert!(meshes.len() > 60, "{} lines", meshes.len());
    for Known { file, n_vertices, n_welded, n_triangles } in meshes {
        let (mesh, report) = read_mesh(folder.join(&file)).unwrap();
        mesh.check().unwrap();
        if file == "gltf/2CylinderEngine.glb" {
            // The list counts each mesh once; the scene has some of them several times.
            assert_eq!((mesh.positions.len(), mesh.triangles.len()), (84_657, 121_496));
            continue;
        }
        assert_eq!(mesh.triangles.len(), n_triangles, "{file}");
        match report.format {
            FileFormat::Surface(MeshFormat::Stl) => {
                assert_eq!(Some(mesh.positions.len()), n_welded, "{file}");
            }
            // Seams make more vertices than there are positions.
            FileFormat::Surface(MeshFormat::Obj) if !mesh.attributes.is_empty() => {
                assert!(mesh.positions.len() >= n_vertices, "{file}");
            }
            _ => assert_eq!(mesh.positions.len(), n_vertices, "{file}"),
        }
    }
}

#[test]
fn odd_files_have_their_stated_outcomes() {
    let Some(folder) = data_folder() else { return };
    let check = |file: &str, outcome: &str| {
        let found = match read_mesh(folder.join("hard/odd_files").join(file)) {
            Ok((mesh, _)) => format!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len()),
            Err(error) => error.root().to_string(),
        };
        assert_eq!(found, outcome, "{file}");
    };
    check("OutOfMemory.off", "line 2: 353535235358 vertices announced, there can be at most 146");
    // Little-endian, without colours of faces.
    check("beetle.off", "5105 vertices, 9664 triangles");
    check("comments.off", "8 vertices, 12 triangles");
    check("empty.obj", "no faces (0 vertices)");
    check("eof_test.obj", "3 vertices, 1 triangles");
    // Its faces have more values than its header declares.
    // Its corners have texture coordinates, which make seams.
    check("fuze_ascii.ply", "664 vertices, 1000 triangles");
    // The face element is missing from its header, so the list of the faces is read as one of the
    // vertices.
    check("issue623.ply", "line 15: expected the length of a list, found \"7.941797\"");
    // A face without corners is dropped.
    check("malformed2.obj", "8 vertices, 10 triangles");
    check("negative_indices.obj", "24 vertices, 12 triangles");
    check("number_formats.obj", "line 11: expected a number, found \"3.1+e2\"");
    check("wallhole.obj", "92 vertices, 66 triangles");
}

#[test]
fn real_attributes_come_along() {
    let Some(folder) = data_folder() else { return };
    let check = |file: &str, expected: &[(&str, u32)]| {
        let (mesh, _) = read_mesh(folder.join(file)).unwrap();
        let found: Vec<(&str, u32)> = mesh
            .attributes
            .iter()
            .map(|attribute| (attribute.name.as_str(), attribute.n_components))
            .collect();
        assert_eq!(found, expected, "{file}");
    };
    check("surfaces/horse.ply", &[("confidence", 1), ("color", 3)]);
    check("surfaces/spot_subdiv.obj", &[("texcoord", 2)]);
    check("hard/nonmanifold/sofa__man.obj", &[("texcoord", 2), ("normal", 3)]);
    let multi_uv = [("normal", 3), ("tangent", 4), ("texcoord", 2), ("texcoord_1", 2)];
    check("gltf/MultiUVTest/MultiUVTest.gltf", &multi_uv);
    let skinned = [("joints_0", 4), ("normal", 3), ("texcoord", 2), ("weights_0", 4)];
    check("gltf/CesiumMan.glb", &skinned);
}
