//! Whatever a volume file holds is in the mesh under its name or is named in the notes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a failed step is a failed test")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

use std::fs;
use std::path::{Path, PathBuf};

use nephrite_formats::{FileReport, TetrahedronMesh, VolumeFormat, read_volume, read_volume_bytes};

/// A file that holds one of everything: what of it is kept, and the notes on all else.
struct Sample {
    format: VolumeFormat,
    text: String,
    kept: &'static [&'static str],
    notes: &'static [&'static str],
}

fn check(sample: &Sample) {
    let Sample { format, text, kept, notes } = sample;
    let (mesh, report) = read_volume_bytes(text.as_bytes(), *format).unwrap();
    let names: Vec<&str> = mesh.attributes.iter().map(|field| field.name.as_str()).collect();
    assert_eq!(names, *kept, "{format}");
    assert_eq!(report.notes(), *notes, "{format}");
}

const POINTS: &str = "0 0 0 1 0 0 0 1 0 0 0 1 1 1 0.5";

#[test]
fn of_a_vtu_file() {
    let array = |kind: &str, name: &str, values: &str| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">{values}</DataArray>")
    };
    let text = format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><FieldData>{time}</FieldData>\
         <Piece NumberOfPoints=\"5\" NumberOfCells=\"3\"><PointData>{heat}{flag}{id}{label}{ghost}{short}</PointData>\
         <CellData>{region}{material}{ghosts}</CellData>\
         <Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">{POINTS}</DataArray></Points>\
         <Cells>{connectivity}{offsets}{types}</Cells></Piece></UnstructuredGrid></VTKFile>",
        time = array("Float64", "TimeValue", "2.5"),
        heat = array("Float64", "heat", "1 2 -nan(ind) 1.5D+03 5"),
        flag = array("Bit", "flag", "1 0 1 1 0"),
        id = array("Int64", "id", "1 2 3 4 5"),
        label = "<Array type=\"String\" Name=\"label\" format=\"ascii\">97 0 98 0</Array>",
        ghost = array("UInt8", "vtkGhostType", "0 0 0 0 0"),
        short = array("Float64", "short", "1 2"),
        region = array("Int32", "region", "1 2 2"),
        material = "<Array type=\"String\" Name=\"material\" format=\"ascii\">97 0 98 0 99 0</Array>",
        ghosts = array("UInt8", "vtkGhostType", "0 0 1"),
        connectivity = array("Int32", "connectivity", "0 1 2 3 1 2 3 4 0 1 2 3"),
        offsets = array("Int32", "offsets", "4 8 12"),
        types = array("UInt8", "types", "10 71 10"),
    );
    let sample = Sample {
        format: VolumeFormat::Vtu,
        text,
        kept: &["heat", "flag", "id"],
        notes: &[
            "field data \"TimeValue\" is left out",
            "cell data \"region\" is left out",
            "cell data \"material\" is left out",
            "1 ghost cell is left out",
            "field \"label\" is left out: data array of type \"String\"",
            "field \"vtkGhostType\" is left out",
            "field \"id\" is kept as i32",
            "field \"short\" is left out: it has 2 values for 5 vertices",
        ],
    };
    check(&sample);
    let (mesh, _) = read_volume_bytes(sample.text.as_bytes(), VolumeFormat::Vtu).unwrap();
    assert_eq!(mesh.tetrahedra, [[0, 1, 2, 3], [1, 2, 3, 4]]);
    let heat: Vec<f64> = mesh.attribute("heat").unwrap().values().collect();
    assert!(heat[2].is_nan());
    assert_eq!([heat[0], heat[1], heat[3], heat[4]], [1.0, 2.0, 1500.0, 5.0]);
    assert_eq!(mesh.attribute("flag").unwrap().bytes, [1, 0, 1, 1, 0]);
}

#[test]
fn of_a_legacy_vtk_file() {
    let text = format!(
        "# vtk DataFile Version 3.0\nall\nASCII\nDATASET UNSTRUCTURED_GRID\n\
         FIELD FieldData 2\nauthor 1 1 string\nsome%20one\nTimeValue 1 1 double\n2.5\nMETADATA\nINFORMATION 0\n\n\
         POINTS 5 float\n{POINTS}\nMETADATA\nINFORMATION 0\n\n\
         CELLS 4 19\n4 0 1 2 3\n4 1 2 3 4\n4 0 1 2 3\n3 0 1 2\nCELL_TYPES 4\n10\n71\n10\n69\n\
         CELL_DATA 4\nSCALARS region int 1\nLOOKUP_TABLE default\n1 2 2 3\n\
         FIELD FieldData 2\nmaterial 1 4 string\nsteel\n\nair\nair\nvtkGhostType 1 4 unsigned_char\n0 0 32 0\n\
         POINT_DATA 5\nSCALARS flag bit 1\nLOOKUP_TABLE default\n1 0 1 1 0\nVECTORS flow float\n{POINTS}\n\
         FIELD FieldData 2\nheat 1 5 double\n1 1.#QNAN 3 1.5D+03 -1.#INF\nMETADATA\nINFORMATION 0\n\n\
         label 1 5 string\na\nb\nc\n\nd\n"
    );
    let sample = Sample {
        format: VolumeFormat::Vtk,
        text,
        kept: &["flag", "flow", "heat"],
        notes: &[
            "field data \"author\" is left out",
            "field data \"TimeValue\" is left out",
            "cell data \"region\" is left out",
            "cell data \"material\" is left out",
            "field \"label\" is left out",
            "1 ghost cell is left out",
            "1 cell without a volume is left out",
        ],
    };
    check(&sample);
    let (mesh, _) = read_volume_bytes(sample.text.as_bytes(), VolumeFormat::Vtk).unwrap();
    let heat: Vec<f64> = mesh.attribute("heat").unwrap().values().collect();
    assert!(heat[1].is_nan());
    assert_eq!([heat[0], heat[2], heat[3], heat[4]], [1.0, 3.0, 1500.0, f64::NEG_INFINITY]);
}

const NODES: &str = "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 0.5\n6 nan 0 0\n$EndNodes\n";

#[test]
fn of_a_gmsh_file() {
    let values = "1\n0.0\n3\n0\n1\n6\n1 1\n2 nan\n3 1.5D+03\n4 4\n5 5\n6 6\n";
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 10 \"steel beam\"\n3 11 \"air\"\n2 5 \"inlet\"\n$EndPhysicalNames\n\
         {NODES}$Elements\n4\n1 4 2 10 1 1 2 3 4\n2 4 4 11 2 1 3 2 3 4 5\n3 2 2 5 1 1 2 3\n4 36 2 0 1 1 2 3 4 5 1 2 3 4 5 1 2 3 4 5 1\n\
         $EndElements\n$NodeData\n1\n\"heat flow\"\n{values}$EndNodeData\n$ElementData\n1\n\"stress\"\n1\n0\n3\n0\n1\n2\n1 1\n2 2\n\
         $EndElementData\n$Periodic\n0\n$EndPeriodic\n"
    );
    check(&Sample {
        format: VolumeFormat::Gmsh,
        text,
        kept: &["heat flow"],
        notes: &[
            "cell data \"stress\" is left out",
            "section \"Periodic\" is left out",
            "physical group \"inlet\" (1 element) is left out",
            "physical group \"steel beam\" (1 element) is left out",
            "physical group \"air\" (1 element) is left out",
            "element data \"geometrical entities\" (2 volumes) is left out",
            "element data \"partitions\" is left out",
            "1 unused point without a usable position is left out",
            "2 cells without a volume are left out",
        ],
    });
}

#[test]
fn of_gmsh_files_of_other_versions() {
    let one = "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n2\n1 4 7 3 4 1 2 3 4\n2 2 0 3 3 1 2 3\n$ENDELM\n";
    check(&Sample {
        format: VolumeFormat::Gmsh,
        text: one.to_owned(),
        kept: &[],
        notes: &["physical group \"7\" (1 element) is left out", "1 cell without a volume is left out"],
    });
    let four = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"steel\"\n$EndPhysicalNames\n\
        $Entities\n1 0 0 1\n1 0 0 0 0\n1 0 0 0 1 1 1 1 7 0\n$EndEntities\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n\
        0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";
    check(&Sample {
        format: VolumeFormat::Gmsh,
        text: four.to_owned(),
        kept: &[],
        notes: &["physical group \"steel\" (1 element) is left out"],
    });
}

#[test]
fn of_a_medit_file() {
    let text = "MeshVersionFormatted 2 Dimension 3\nVertices 6 0 0 0 1\n1 0 0 1 0 1 0 1 0 0 1 1 1 1 0.5 2 nan 0 0 0\n\
        Identifier \"a part\" Corners 2 1\n2\nTetrahedra 2 1 2 3 4 5\n2 3 4 5 6\nTriangles 1 1 2 3 9\nRidges 0 END";
    check(&Sample {
        format: VolumeFormat::Medit,
        text: text.to_owned(),
        kept: &[],
        notes: &[
            "section \"Identifier\" is left out",
            "section \"Corners\" is left out",
            "section \"Ridges\" is left out",
            "element data \"references of vertices\" (3 values) is left out",
            "element data \"references\" (2 values) is left out",
            "1 unused point without a usable position is left out",
            "1 cell without a volume is left out",
        ],
    });
}

#[test]
fn of_an_mfem_file() {
    let text = "MFEM mesh v1.3\n\ndimension\n3\n\nelements\n2\n1 4 0 1 2 3\n2 4 1 2 3 4\n\nattribute_sets\n1\n\"all\" 2 1 2\n\n\
        boundary\n1\n1 2 0 1 2\n\nvertices\n5\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 0.5\n\nmfem_mesh_end\n";
    check(&Sample {
        format: VolumeFormat::Mfem,
        text: text.to_owned(),
        kept: &[],
        notes: &[
            "section \"attribute_sets\" is left out",
            "element data \"attributes\" (2 values) is left out",
            "1 cell without a volume is left out",
        ],
    });
}

#[test]
fn of_files_of_tetgen() {
    let folder = tempfile::tempdir().unwrap();
    let node =
        "5 3 2 1\n1 0 0 0 7 1 0\n2 1 0 0 8 2 1\n3 0 1 0 1.#IND 3 0\n4 0 0 1 10 4 0\n5 1 1 0.5 11 5 0\n";
    fs::write(folder.path().join("a.node"), node).unwrap();
    fs::write(folder.path().join("a.ele"), "2 4 1\n1 1 2 3 4 5\n2 2 3 4 5 6\n").unwrap();
    let (mesh, report) = read_volume(folder.path().join("a.ele")).unwrap();
    let names: Vec<&str> = mesh.attributes.iter().map(|field| field.name.as_str()).collect();
    assert_eq!(names, ["attribute_1", "attribute_2"]);
    let notes = ["boundary markers", "attributes of tetrahedra"];
    assert_eq!(report.notes(), notes.map(|name| format!("element data \"{name}\" is left out")));
}

#[test]
fn of_pieces_and_times() {
    let folder = tempfile::tempdir().unwrap();
    let grid = |x: u32, heat: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\
             <PointData><DataArray type=\"Float64\" Name=\"heat\">{heat}</DataArray></PointData>\
             <CellData><DataArray type=\"Int32\" Name=\"region\">7</DataArray></CellData>\
             <Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">{x} 0 0 {x} 1 0 {x} 0 1 9 0 0</DataArray></Points><Cells>\
             <DataArray type=\"Int8\" Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int8\" Name=\"offsets\">4</DataArray>\
             <DataArray type=\"Int8\" Name=\"types\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"
        )
    };
    fs::create_dir(folder.path().join("parts")).unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    for (time, heat) in ["1 2 3 4", "5 6 7 8"].into_iter().enumerate() {
        for part in 0..2 {
            write(&format!("parts/{time}_{part}.vtu"), &grid(part, heat));
        }
        let pieces = format!("<Piece Source=\"{time}_0.vtu\"/><Piece Source=\"{time}_1.vtu\"/>");
        let text = format!(
            "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>{pieces}</PUnstructuredGrid></VTKFile>"
        );
        write(&format!("parts/{time}.pvtu"), &text);
    }
    let entry =
        |time: usize, file: &str| format!("<DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>");
    let entries = [entry(0, "parts/0.pvtu"), entry(1, "parts/1.pvtu"), entry(2, "parts/0_0.vtu")].concat();
    // The same by their parts, those of one time apart from each other.
    let by_part = [(0, 0), (1, 0), (0, 1), (1, 1)]
        .map(|(time, part)| entry(time, &format!("parts/{time}_{part}.vtu")))
        .concat();
    write(
        "by_part.pvd",
        &format!("<VTKFile type=\"Collection\"><Collection>{by_part}</Collection></VTKFile>"),
    );
    write(
        "all.pvd",
        &format!(
            "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection>{entries}</Collection></VTKFile>"
        ),
    );
    let (mesh, report) = read_volume(folder.path().join("all.pvd")).unwrap();
    let (by_part, _) = read_volume(folder.path().join("by_part.pvd")).unwrap();
    assert_eq!(by_part, mesh);
    assert_eq!((mesh.tetrahedra.len(), mesh.positions.len()), (2, 8));
    let values = |name: &str| mesh.attribute(name).unwrap().values().collect::<Vec<f64>>();
    assert_eq!(values("heat"), [1.0, 2.0, 3.0, 4.0, 1.0, 2.0, 3.0, 4.0]);
    assert_eq!(values("heat_2"), [5.0, 6.0, 7.0, 8.0, 5.0, 6.0, 7.0, 8.0]);
    assert_eq!(
        report.notes(),
        [
            "cell data \"region\" is left out",
            "field \"heat\" is renamed \"heat_2\"",
            "part \"time step 2 (parts/0_0.vtu)\" is left out: its grid is not that of the first time step",
        ]
    );
}

/// Names of arrays and groups in a file, found by looking for them in its text and not by reading
/// it.
fn names_in(text: &str) -> Vec<String> {
    if text.contains("<VTKFile") {
        let data = ["PointData", "CellData", "FieldData"];
        let sections = data.iter().flat_map(|tag| between(text, &format!("<{tag}"), &format!("</{tag}")));
        return sections.flat_map(|section| between(section, " Name=\"", "\"")).map(str::to_owned).collect();
    }
    let mut names = Vec::new();
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    for (at, line) in lines.iter().enumerate() {
        let words: Vec<&str> = line.split_whitespace().take(5).collect();
        match words[..] {
            ["SCALARS" | "VECTORS" | "NORMALS" | "TENSORS" | "GLOBAL_IDS", name, ..] => {
                names.push(name.to_owned());
            }
            [name, n_components, n_tuples, "int" | "float" | "double" | "string" | "unsigned_char"]
                if n_components.parse::<u32>().is_ok() && n_tuples.parse::<u32>().is_ok() =>
            {
                names.push(name.to_owned());
            }
            ["$NodeData" | "$ElementData"] => names.push(lines[at + 2].trim_matches('"').to_owned()),
            ["$PhysicalNames"] => {
                let n: usize = lines[at + 1].parse().unwrap();
                let groups = &lines[at + 2..at + 2 + n];
                names.extend(groups.iter().filter_map(|group| group.split('"').nth(1)).map(str::to_owned));
            }
            [
                "Corners" | "Ridges" | "RequiredVertices" | "Normals" | "Geometry" | "AngleOfCornerBound",
                ..,
            ] => {
                names.push(words[0].to_owned());
            }
            _ => {}
        }
    }
    names
}

/// What stands between each pair of texts.
fn between<'a>(text: &'a str, start: &str, end: &str) -> Vec<&'a str> {
    let parts = text.split(start).skip(1);
    parts.filter_map(|part| part.split_once(end)).map(|(inside, _)| inside).collect()
}

fn is_known(name: &str, mesh: &TetrahedronMesh, report: &FileReport) -> bool {
    mesh.attribute(name).is_some()
        // Ghosts are left out as cells, and counted.
        || name == "vtkGhostType"
        || report.items().iter().any(|item| &*item.name == name)
}

#[test]
fn of_all_volumes_beside_the_repository() {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folders = ["volume", "cases/volumes"].map(|folder| data.join(folder));
    if !folders.iter().all(|folder| folder.is_dir()) {
        println!("skipped: there are no volumes at {}", data.display());
        return;
    }
    const LARGEST_BYTES: u64 = 4 << 20;
    let (mut n_files, mut n_names) = (0, 0);
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    for path in entries.map(|entry| entry.unwrap().path()) {
        let is_small = fs::metadata(&path).unwrap().len() <= LARGEST_BYTES;
        // A solution of PLOT3D is no grid.
        let is_solution = short(&path).ends_with("q.bin");
        if !is_small || is_solution || VolumeFormat::from_path(&path).is_none() {
            continue;
        }
        let Ok((mesh, report)) = read_volume(&path) else {
            panic!("{} is not read", path.display());
        };
        n_files += 1;
        let text = String::from_utf8_lossy(&fs::read(&path).unwrap()).into_owned();
        for name in names_in(&text) {
            n_names += 1;
            assert!(is_known(&name, &mesh, &report), "{}: {name} is lost", short(&path));
        }
    }
    assert!(n_files > 40 && n_names > 60, "{n_files} files, {n_names} names");
}

fn short(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
