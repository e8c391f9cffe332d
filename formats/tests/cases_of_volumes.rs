//! Volumes of other programs' users come out right: what their files hold is in the mesh or is
//! named.
//!
//! The files lie beside the repository; what each promises is tested on generated files in
//! `volumes_of_every_format.rs` and `nothing_of_a_volume_is_lost_in_silence.rs` as well.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a failed step is a failed test")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

use std::path::PathBuf;

use nephrite_formats::{FileReport, ScalarType, TetrahedronMesh, read_volume};

/// A file of the folder; `None` if the folder is not there.
fn case(file: &str) -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/cases/volumes");
    if !folder.is_dir() {
        println!("skipped: there are no cases at {}", folder.display());
        return None;
    }
    Some(folder.join(file))
}

fn read(file: &str) -> Option<(TetrahedronMesh, FileReport)> {
    let path = case(file)?;
    Some(read_volume(&path).unwrap_or_else(|error| panic!("{error}")))
}

/// Checks tetrahedra and volume, and that each of the words stands in a note of its own.
fn check(file: &str, n_tetrahedra: usize, volume: f64, noted: &[&str]) {
    let Some((mesh, report)) = read(file) else { return };
    mesh.check().unwrap();
    assert_eq!(mesh.tetrahedra.len(), n_tetrahedra, "{file}");
    let found = mesh.volume();
    assert!((found / volume - 1.0).abs() < 1e-5, "{file}: {found}");
    let notes = report.notes();
    for word in noted {
        assert!(notes.iter().any(|note| note.contains(word)), "{file}: {word} is not in {notes:?}");
    }
    if noted.is_empty() {
        assert!(notes.is_empty(), "{file}: {notes:?}");
    }
}

fn values(mesh: &TetrahedronMesh, name: &str) -> Vec<f64> {
    mesh.attribute(name).unwrap_or_else(|| panic!("no field {name}")).values().collect()
}

#[test]
fn medit_is_read_by_words() {
    check("medit_silent_loss.mesh", 8, 4.0 / 3.0, &["\"RequiredVertices\"", "\"references\""]);
    check("medit_lists_one_line.mesh", 384, 1.0, &["\"Corners\""]);
    check("medit_geom.mesh", 384, 1.0, &["\"Geometry\"", "\"Identifier\""]);
    check("medit_angle.mesh", 384, 1.0, &["\"AngleOfCornerBound\""]);
    check("medit_angle2.mesh", 384, 1.0, &["\"AngleOfCornerBound\""]);
    for file in ["medit_dimlines.mesh", "medit_lower.mesh", "medit_all_one_line.mesh"] {
        let Some((mesh, _)) = read(file) else { return };
        assert_eq!(mesh.tetrahedra.len(), 384, "{file}");
        assert!((mesh.volume() - 1.0).abs() < 1e-6, "{file}");
    }
}

#[test]
fn values_of_text_are_numbers_or_not_a_number() {
    let Some((mesh, _)) = read("txt_nan_ind.vtu") else { return };
    let found = values(&mesh, "T");
    assert!(found[2].is_nan());
    assert_eq!([&found[..2], &found[3..]].concat(), [1.0, 2.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
    let Some((mesh, _)) = read("txt_fort.vtu") else { return };
    assert_eq!(values(&mesh, "T"), [1.0, 2.0, 1500.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn what_is_not_needed_refuses_no_file() {
    check("string_field.vtk", 1296, 1.0, &["field data \"author\"", "field data \"TimeValue\""]);
    check("string_cells.vtu", 1296, 1.0, &["cell data \"material\""]);
    check("string_cells.vtk", 1296, 1.0, &["cell data \"material\""]);
    check("hex_o3.msh", 162, 1.0, &["without a volume", "nodes on their edges"]);
    check("bool_points.vtk", 1296, 1.0, &["field data"]);
    let Some((mesh, _)) = read("bool_points.vtk") else { return };
    let flag = mesh.attribute("flag").unwrap();
    assert_eq!(flag.scalar, ScalarType::U8);
    assert!(flag.bytes.contains(&0) && flag.bytes.contains(&1) && flag.bytes.iter().all(|&flag| flag < 2));
    check("grid_fielddata.vtu", 6, 1.0, &["field data \"TimeValue\""]);
    let Some((mesh, _)) = read("grid_fielddata.vtu") else { return };
    assert_eq!(values(&mesh, "T"), [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn data_at_cells_and_regions_are_named() {
    check("cell_data_only.vtu", 1296, 1.0, &["cell data \"p\"", "cell data \"U\""]);
    check("phys_2.2.msh", 2491, 2.0, &["\"steel\"", "\"air\"", "\"core\""]);
    check("phys_refs.mesh", 2491, 2.0, &["element data \"references\""]);
    check("tg_attr.node", 384, 1.0, &["\"attributes of tetrahedra\""]);
    let Some((_, report)) = read("twomat.vtu") else { return };
    assert!(report.notes().iter().any(|note| note.contains("cell data \"region\"")));
    let Some((mesh, report)) = read("phys_ids.vtk") else { return };
    assert_eq!(mesh.tetrahedra.len(), 742 + 78 + 770);
    assert!(report.notes().iter().any(|note| note.contains("cell data \"CellEntityIds\"")));
}

#[test]
fn labels_keep_their_integer_type() {
    let Some((mesh, _)) = read("twomat.vtu") else { return };
    for name in ["mat", "gid"] {
        let scalar = mesh.attribute(name).unwrap().scalar;
        assert!(!matches!(scalar, ScalarType::F32 | ScalarType::F64), "{name}: {scalar:?}");
    }
    assert!(values(&mesh, "mat").iter().all(|&value| value == 3.0 || value == 7.0));
}

#[test]
fn hexahedra_with_vertices_of_their_own_fit_together() {
    check("own_vertices_hex.vtu", 1296, 1.0, &[]);
}

#[test]
fn ghost_cells_are_left_out_and_counted() {
    check("ghost_pieces.vtu", 1296, 1.0, &["216 ghost cells are left out"]);
    check("two_pieces.vtu", 1296, 1.0, &[]);
}

#[test]
fn formats_that_should_open_do() {
    check("lagrange_p1.vtu", 1296, 1.0, &[]);
    check("comp_lz4_appended_64.vtu", 1296, 1.0, &[]);
    check("comp_lz4_binary_32.vtu", 1296, 1.0, &[]);
    check("comp_lzma_binary_32.vtu", 1296, 1.0, &[]);
    check("tg_short.node", 384, 1.0, &["attributes of tetrahedra"]);
    check("tg_eleshort.node", 384, 1.0, &[]);
    check("tg_short2.node", 384, 1.0, &["attributes of tetrahedra"]);
    check("p_ascii.p3d", 120, 24.0, &[]);
    check("p_multi.p3d", 6 * 36, 36.0, &[]);
    check("p_ascii_multi.x", 6 * 36, 36.0, &[]);
    check("phys_1.msh", 2491, 2.0, &["physical"]);
    check("part.pvtu", 1296, 1.0, &[]);
    check("mfem.mesh", 384, 1.0, &[]);
}

#[test]
fn the_same_fields_come_out_of_every_compressor() {
    let Some((first, _)) = read("comp_lz4_binary_32.vtu") else { return };
    for file in ["comp_lz4_appended_64.vtu", "comp_lzma_binary_32.vtu"] {
        let Some((other, _)) = read(file) else { return };
        assert_eq!(values(&first, "T").len(), 343);
        for name in ["T", "U"] {
            let pairs = values(&first, name).into_iter().zip(values(&other, name));
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-6), "{file}: {name}");
        }
    }
}

#[test]
fn a_series_whose_grid_changes_is_read_at_its_first_time() {
    check("series.pvd", 648, 0.5, &["time step 1 (part_1.vtu)"]);
}

#[test]
fn known_files_that_are_not_read_are_named() {
    let expected = [("poly.vtp", "PolyData"), ("image.vti", "ImageData"), ("phys.inp", "Abaqus")];
    for (file, word) in expected {
        let Some(path) = case(file) else { return };
        let message = read_volume(path).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn fields_without_a_number_somewhere_are_kept() {
    let Some((mesh, _)) = read("fields_nan.vtu") else { return };
    assert!(values(&mesh, "allnan").iter().all(|value| value.is_nan()));
    let masked = values(&mesh, "masked_nan");
    assert!(masked.iter().any(|value| value.is_nan()) && masked.iter().any(|value| value.is_finite()));
}
