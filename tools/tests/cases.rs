//! Small files that go wrong elsewhere come out right, or the program says what it left out.
//!
//! The files are in a folder beside the repository, with a list that says what is right for each.
//! The table below has every row of the list and where its promise is tested: here if it is about
//! the program, else in the test that is named. Without the folder nothing is run; the promises of
//! this file are then tested on generated meshes in `usage`, `database`, `volumes` and `view`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a panic is how a test fails")]

mod support;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;
use support::{Workplace, index, number};

/// How the promise of a row is tested.
enum Check {
    /// In a test file of the repository, which names the case.
    By(&'static str),
    /// So many triangles or tetrahedra are built.
    Counts(usize),
    /// The notes of the build have one of these words.
    Notes(&'static [&'static str]),
    /// The file is built, or refused with one of these words.
    BuiltOrRefused(&'static [&'static str]),
    /// The file is refused with one of these words.
    Refused(&'static [&'static str]),
    /// By a function of this file.
    Run(fn(&Workplace, &Path)),
    /// The file is built; the rest of the promise is for an option that does not exist yet.
    Built,
}

use Check::{Built, BuiltOrRefused, By, Counts, Notes, Refused, Run};

const SURFACES: &str = "formats/tests/cases_of_surfaces.rs";
const VOLUMES: &str = "formats/tests/cases_of_volumes.rs";
const FIELDS: &str = "tests/fields_of_volumes_are_carried_along.rs";
const JUMPS: &str = "tests/values_never_cross_a_jump.rs";

/// Every row: the first column of the list, and its checks.
const ROWS: &[(&str, &[Check])] = &[
    ("surfaces/uvquad.obj", &[By(SURFACES), Counts(2)]),
    ("surfaces/uvquad.glb", &[By(SURFACES), Counts(2)]),
    ("surfaces/uvquad_st.ply", &[By(SURFACES), Counts(2)]),
    ("surfaces/packed_tiled.glb", &[By(SURFACES), Counts(5120)]),
    ("surfaces/packed_q.glb", &[By(SURFACES), Counts(5120)]),
    ("surfaces/uvquad.obj (two meshes)", &[Run(two_meshes)]),
    ("surfaces/uvquad.obj (-o foo.ply)", &[Run(file_named_as_a_mesh)]),
    ("surfaces/two_materials.obj (--error 0)", &[Run(error_zero)]),
    ("surfaces/far_box.ply", &[Run(far_box)]),
    ("surfaces/two_materials.obj", &[Notes(&["material", "group"])]),
    ("surfaces/two_materials.glb", &[Notes(&["material"])]),
    ("surfaces/multi_solid.stl", &[Notes(&["solid"])]),
    ("surfaces/colour_viscam.stl", &[Notes(&["colour"])]),
    ("surfaces/face_colours.ply", &[Notes(&["colour", "color", "red"])]),
    ("surfaces/colour_under_off.off", &[By(SURFACES), Built]),
    ("surfaces/groups.obj", &[Notes(&["group", "material"])]),
    ("surfaces/colour_magics.stl", &[Notes(&["colour"])]),
    ("surfaces/wedge_uv.ply", &[By(SURFACES), Counts(1280)]),
    ("surfaces/chart_on_plate.glb", &[Built]),
    ("surfaces/mirrored_uv_flat.glb", &[Built]),
    ("surfaces/voxel_slab.ply", &[Built]),
    ("surfaces/flat_colours.glb", &[Built]),
    ("surfaces/objcol.obj", &[By(SURFACES), Built]),
    ("surfaces/coff_float.off", &[By(SURFACES), Built]),
    ("surfaces/skin_morph.glb", &[By(SURFACES), Counts(1280)]),
    ("surfaces/mixed_attributes.glb", &[By(SURFACES), Built]),
    ("surfaces/stones_300.glb", &[By(SURFACES)]),
    ("surfaces/gpu_instancing_optional.glb", &[By(SURFACES), Built]),
    ("surfaces/nan_unused.ply", &[Run(nan_vertices)]),
    ("surfaces/unknown_required.glb", &[Refused(&["ACME_lattice_deform"])]),
    ("surfaces/ncoff.off", &[By(SURFACES), Counts(320)]),
    ("surfaces/bom.ply", &[Counts(1280)]),
    ("surfaces/binary.off", &[Counts(320)]),
    ("surfaces/packed_c.glb", &[By(SURFACES), Counts(5120)]),
    ("surfaces/gltf1.gltf", &[Refused(&["1.0", "version 1"])]),
    ("surfaces/utf16.obj", &[BuiltOrRefused(&["UTF-16"])]),
    ("surfaces/wrong_count.stl", &[BuiltOrRefused(&["16000", "16,000", "320"])]),
    ("surfaces/tile_w.obj", &[By("tests/tiles_fit_at_every_level.rs"), Built]),
    ("volumes/panic_const.vtu", &[By(FIELDS), Counts(384)]),
    ("volumes/panic_const.msh", &[By(FIELDS), Counts(384)]),
    ("volumes/panic_zero_vec.vtu", &[By(FIELDS), Built]),
    ("volumes/panic_const_int.vtu", &[By(FIELDS), Built]),
    ("volumes/pan", &[Run(database_of_volumes)]),
    ("volumes/fault_split_nodes.vtu", &[By(JUMPS), Built]),
    ("volumes/own_vertices_tet_dg.vtu", &[By(JUMPS), Counts(1296)]),
    ("volumes/own_vertices_hex.vtu", &[Run(own_vertices)]),
    ("volumes/two_pieces.vtu", &[Run(measured_against_level_zero)]),
    ("volumes/ghost_pieces.vtu", &[Counts(1296), Notes(&["ghost"])]),
    ("volumes/s_nm_1.vtu", &[Run(unit_of_length)]),
    ("volumes/s_Gm_1.vtu", &[Run(unit_of_length)]),
    ("volumes/medit_silent_loss.mesh", &[By(VOLUMES), Counts(8)]),
    ("volumes/medit_lists_one_line.mesh", &[By(VOLUMES), Counts(384)]),
    ("volumes/medit_geom.mesh", &[By(VOLUMES), Counts(384)]),
    ("volumes/medit_angle.mesh", &[By(VOLUMES), Counts(384)]),
    ("volumes/medit_dimlines.mesh", &[By(VOLUMES), Counts(384)]),
    ("volumes/medit_lower.mesh", &[By(VOLUMES), Counts(384)]),
    ("volumes/medit_all_one_line.mesh", &[By(VOLUMES), Counts(384)]),
    ("volumes/medit_angle2.mesh", &[By(VOLUMES), Counts(384)]),
    ("volumes/phys_2.2.msh", &[Notes(&["group"])]),
    ("volumes/phys_refs.mesh", &[Notes(&["reference"])]),
    ("volumes/twomat.vtu (region)", &[Notes(&["region"])]),
    ("volumes/tg_attr.node", &[Notes(&["attribute"])]),
    ("volumes/phys_ids.vtk", &[Notes(&["CellEntityIds"])]),
    ("volumes/twomat.vtu (labels)", &[By(FIELDS), Counts(10_368)]),
    ("volumes/cell_data_only.vtu", &[Notes(&["\"p\""]), Notes(&["\"U\""])]),
    ("volumes/string_field.vtk", &[Counts(1296), Notes(&["author"])]),
    ("volumes/string_cells.vtu", &[Counts(1296), Notes(&["material"])]),
    ("volumes/bool_points.vtk", &[By(VOLUMES), Counts(1296)]),
    ("volumes/grid_fielddata.vtu", &[Counts(6), Notes(&["TimeValue"])]),
    ("volumes/string_cells.vtk", &[Counts(1296), Notes(&["material"])]),
    ("volumes/hex_o3.msh", &[Counts(162)]),
    ("volumes/txt_nan_ind.vtu", &[By(VOLUMES), Counts(6)]),
    ("volumes/txt_fort.vtu", &[By(VOLUMES), Counts(6)]),
    ("volumes/mfem.mesh", &[BuiltOrRefused(&["MFEM", "VTU"])]),
    ("volumes/phys_1.msh", &[BuiltOrRefused(&["version 1", "Gmsh 1", "VTU"])]),
    ("volumes/part.pvtu", &[BuiltOrRefused(&["PVTU", "VTU"])]),
    ("volumes/poly.vtp", &[BuiltOrRefused(&["PolyData", "VTP", "VTU"])]),
    ("volumes/series.pvd", &[BuiltOrRefused(&["PVD", "VTU"])]),
    ("volumes/image.vti", &[BuiltOrRefused(&["ImageData", "VTI", "VTU"])]),
    ("volumes/phys.inp", &[BuiltOrRefused(&["Abaqus"])]),
    ("volumes/m_vol.vtu", &[Run(volume_and_surface)]),
    ("volumes/amr_hanging.vtu", &[By("tests/volumes_stay_whole.rs"), Counts(3456)]),
    ("volumes/nested", &[Run(nested_folders)]),
    ("volumes/fields_nan.vtu", &[By(FIELDS), Run(nan_is_told)]),
    ("volumes/panic_allnan.vtu", &[By(FIELDS), Run(nan_is_told)]),
    ("volumes/lagrange_p1.vtu", &[Counts(1296)]),
    ("volumes/comp_lz4_appended_64.vtu", &[Counts(1296)]),
    ("volumes/comp_lzma_binary_32.vtu", &[Counts(1296)]),
    ("volumes/comp_lz4_binary_32.vtu", &[Counts(1296)]),
    ("volumes/tg_short.node", &[Counts(384)]),
    ("volumes/tg_eleshort.node", &[Counts(384)]),
    ("volumes/tg_short2.node", &[Counts(384)]),
    ("volumes/p_ascii.p3d", &[Counts(120)]),
    ("volumes/p_multi.p3d", &[By(VOLUMES), Built]),
    ("volumes/p_ascii_multi.x", &[By(VOLUMES), Built]),
];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The folder of the cases; `None`, with a line, if it is not there.
fn cases() -> Option<PathBuf> {
    let folder = repository().join("../shared/data/cases");
    if folder.join("MANIFEST.md").is_file() {
        return Some(folder);
    }
    println!("skipped: {} is not there", folder.display());
    None
}

/// The file that a row is about: its name without the words in brackets.
fn file_of(row: &str) -> &str {
    row.split(" (").next().unwrap_or(row)
}

#[test]
fn the_table_has_every_row_of_the_list() {
    let Some(cases) = cases() else { return };
    let manifest = std::fs::read_to_string(cases.join("MANIFEST.md")).expect("text");
    let rows: BTreeSet<String> = manifest
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split(" | ").next())
        .map(|row| row.replacen('`', "", 1))
        .collect();
    let table: BTreeSet<String> = ROWS.iter().map(|(row, _)| (*row).to_owned()).collect();
    assert_eq!(rows, table);
    assert_eq!(table.len(), ROWS.len(), "a row stands in the table twice");
}

#[test]
fn tests_named_in_the_table_name_their_cases() {
    for (row, checks) in ROWS {
        let name = Path::new(file_of(row)).file_name().expect("a name").to_string_lossy();
        for check in *checks {
            let By(test) = check else { continue };
            let text = std::fs::read_to_string(repository().join(test)).expect(test);
            assert!(text.contains(&*name), "{test} says nothing of {name}");
        }
    }
}

#[test]
fn surfaces() {
    check_all("surfaces/");
}

#[test]
fn volumes() {
    check_all("volumes/");
}

/// Makes all checks of the rows with a prefix and tells all that fail.
fn check_all(prefix: &str) {
    let Some(cases) = cases() else { return };
    let mut failed = Vec::new();
    for (row, checks) in ROWS.iter().filter(|(row, _)| row.starts_with(prefix)) {
        for check in *checks {
            let path = cases.join(file_of(row));
            if std::panic::catch_unwind(|| make(check, &path)).is_err() {
                failed.push(*row);
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

fn make(check: &Check, path: &Path) {
    let place = Workplace::new();
    match check {
        By(_) => {}
        Built => drop(build(&place, path, "")),
        Counts(expected) => {
            let build = build(&place, path, "");
            let key = if build["triangles_in"].is_u64() { "triangles_in" } else { "tetrahedra_in" };
            assert_eq!(index(&build, key), *expected, "{}", path.display());
        }
        Notes(words) => {
            let notes = build(&place, path, "")["notes"].to_string().replace('\\', "");
            assert!(words.iter().any(|word| notes.contains(word)), "{}: {notes}", path.display());
        }
        BuiltOrRefused(words) | Refused(words) => {
            let run = run(&place, "build", path, "-o out.neph --json");
            if run.status == 0 && matches!(check, BuiltOrRefused(_)) {
                return;
            }
            assert_eq!(
                (run.status, run.stderr.lines().count()),
                (1, 1),
                "{}: {}",
                path.display(),
                run.stderr
            );
            assert!(words.iter().any(|word| run.stderr.contains(word)), "{}", run.stderr);
            assert!(place.files().is_empty());
        }
        Run(check) => check(&place, path),
    }
}

/// Runs a command with a file, whose path may have spaces, and further words.
fn run(place: &Workplace, command: &str, path: &Path, words: &str) -> support::Run {
    let arguments = [command.as_ref(), path.as_os_str()].into_iter();
    let arguments = arguments.chain(words.split_whitespace().map(AsRef::as_ref));
    support::Run::of(place.command(arguments).output().expect("the program starts"))
}

/// Builds `out.neph`, which must succeed.
fn build(place: &Workplace, path: &Path, options: &str) -> Value {
    let run = run(place, "build", path, &format!("-o out.neph --json {options}"));
    assert_eq!(run.status, 0, "{}: {}", path.display(), run.stderr);
    serde_json::from_str(&run.stdout).expect("JSON")
}

fn two_meshes(place: &Workplace, path: &Path) {
    let other = path.with_extension("glb");
    let run = run(place, "build", path, &format!("{} -o z.neph", other.display()));
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("--output-dir"), "{}", run.stderr);
    assert!(place.files().is_empty());
}

fn file_named_as_a_mesh(place: &Workplace, path: &Path) {
    let run = run(place, "build", path, "-o foo.ply");
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("foo.ply") && run.stderr.contains("PLY"), "{}", run.stderr);
    assert!(place.files().is_empty());
}

fn error_zero(place: &Workplace, path: &Path) {
    build(place, path, "");
    let run = place.run("extract out.neph --error 0 -o lod.ply --json");
    assert_eq!(run.status, 0, "{}", run.stderr);
    let level: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!((index(&level, "level"), index(&level, "triangles")), (0, 5120));
}

/// What vanishes has moved by its distance to what is left.
fn far_box(place: &Workplace, path: &Path) {
    build(place, path, "--method progressive");
    for n_triangles in [150, 40, 11] {
        let level = place.json(&format!("extract out.neph --triangles {n_triangles} -o lod.ply"));
        let Some(error) = level["error"].as_f64() else { continue };
        assert!(index(&level, "triangles") > 0, "an empty level states no finite error");
        let measured = run(place, "measure", path, "lod.ply --samples 2000 --json");
        let measured: Value = serde_json::from_str(&measured.stdout).expect("JSON");
        assert!(number(&measured, "max") <= error, "at {n_triangles}: {error} for {measured}");
    }
    assert!(index(&place.json("extract out.neph --error 1% -o lod.ply"), "triangles") > 0);
}

fn nan_vertices(place: &Workplace, path: &Path) {
    let run = build(place, path, "");
    assert_eq!(index(&run, "triangles_in"), 1280);
    let told = format!("{} {}", run["notes"], run["repairs"]);
    assert!(told.contains("50"), "{told}");
    let diagonal = number(&run, "bounding_diagonal");
    assert!((diagonal - 12_f64.sqrt()).abs() < 0.01, "of the ball: {diagonal}");
}

fn database_of_volumes(place: &Workplace, path: &Path) {
    let run = run(place, "build", path, "--output-dir db");
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let manifest = String::from_utf8(place.read("db/manifest.jsonl")).expect("text");
    assert_eq!(manifest.lines().count(), 2, "{manifest}");
    assert_eq!(std::fs::read_dir(place.path("db")).expect("a folder").count(), 3);
}

fn nested_folders(place: &Workplace, path: &Path) {
    let run = run(place, "build", path, "--output-dir db");
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    for name in ["top", "axle", "wheel"] {
        place.done(&format!("verify db/{name}.neph"));
    }
}

fn own_vertices(place: &Workplace, path: &Path) {
    let build = build(place, path, "");
    assert_eq!(index(&build, "tetrahedra_in"), 1296);
    assert!(index(&build, "levels") >= 20 && index(&build, "coarsest_tetrahedra") < 324, "{build}");
    let level = place.json("extract out.neph --level 0 -o lod.vtu");
    assert_eq!((index(&level, "tetrahedra"), index(&level, "vertices")), (1296, 343));
    measured_against_level_zero(place, path);
}

fn measured_against_level_zero(place: &Workplace, path: &Path) {
    build(place, path, "");
    place.done("extract out.neph --level 0 -o lod.vtu");
    let measured = run(place, "measure", path, "lod.vtu --samples 2000 --json");
    let measured: Value = serde_json::from_str(&measured.stdout).expect("JSON");
    assert!(number(&measured, "max") < 1e-6, "{measured}");
    assert!((number(&measured, "volume") - 1.0).abs() < 1e-6, "{measured}");
}

/// The deviation of a field does not depend on the unit of length.
fn unit_of_length(place: &Workplace, path: &Path) {
    let deviation = |path: &Path| {
        build(place, path, "");
        let level = place.json("extract out.neph --tetrahedra 2000 -o lod.vtu");
        number(&level["deviations"], "T")
    };
    let (usual, found) = (deviation(&path.with_file_name("s_1_1.vtu")), deviation(path));
    assert!((found / usual - 1.0).abs() <= 0.2, "{found} instead of {usual}");
}

fn volume_and_surface(place: &Workplace, path: &Path) {
    let surface = path.with_extension("ply");
    let measured = run(place, "measure", path, &format!("{} --samples 2000 --json", surface.display()));
    assert_eq!(measured.status, 0, "{}", measured.stderr);
    let measured: Value = serde_json::from_str(&measured.stdout).expect("JSON");
    assert!(number(&measured, "max") < 1e-6, "{measured}");
}

fn nan_is_told(place: &Workplace, path: &Path) {
    let build = build(place, path, "");
    let told = format!("{} {}", build["notes"], build["repairs"]).to_lowercase();
    assert!(told.contains("nan"), "{told}");
    let level = place.json("extract out.neph --level 1 -o lod.vtu");
    let deviations = level["deviations"].as_object().expect("an object");
    assert!(deviations.values().all(|value| value.is_null() || value.as_f64().is_some()), "{level}");
}
