//! Promise: volume files are read with their fields, come back the same after writing, and end in
//! an error if they are damaged.
#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

use std::path::PathBuf;

use nephrite_formats::{
    Attribute, MeshError, ScalarType, TetrahedronMesh, VolumeFormat, read_plot3d, read_volume,
    read_volume_bytes, write_volume_to,
};

/// Two tetrahedra with fields of several types.
fn two_tetrahedra() -> TetrahedronMesh {
    let field = |name: &str, scalar, n_components: u32| {
        let values =
            (0..5 * n_components).map(|i| f64::from(i) + if scalar == ScalarType::F64 { 0.1 } else { 0.0 });
        Attribute::from_values(name, scalar, n_components, values)
    };
    TetrahedronMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.3]],
        tetrahedra: vec![[0, 1, 2, 3], [1, 2, 3, 4]],
        attributes: vec![
            field("a name with \"quotes\", <b> & 50%", ScalarType::F64, 1),
            field("velocity", ScalarType::F32, 3),
            field("kind", ScalarType::U8, 1),
            field("count", ScalarType::I32, 2),
        ],
        ..Default::default()
    }
}

fn written(mesh: &TetrahedronMesh, format: VolumeFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_volume_to(&mut bytes, mesh, format).unwrap();
    bytes
}

#[test]
fn what_is_written_reads_back_the_same() {
    let near = two_tetrahedra();
    let far = TetrahedronMesh { origin: [1e7, -2e6, 0.5], ..near.clone() };
    for format in [VolumeFormat::Vtu, VolumeFormat::Vtk] {
        let (read, report) = read_volume_bytes(&written(&near, format), format).unwrap();
        assert_eq!(read, near, "{format}");
        assert!(report.notes().is_empty());
        let (read, _) = read_volume_bytes(&written(&far, format), format).unwrap();
        for v in 0..5 {
            let point = |mesh: &TetrahedronMesh| {
                let p = mesh.positions[v].map(f64::from);
                [p[0] + mesh.origin[0], p[1] + mesh.origin[1], p[2] + mesh.origin[2]]
            };
            assert!(point(&read).iter().zip(point(&far)).all(|(a, b)| (a - b).abs() < 1e-6));
        }
    }
}

const GMSH_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 1 1 0.3\n\
    $EndNodes\n$Elements\n3\n1 2 2 0 1 10 20 30\n2 4 2 0 1 10 20 30 40\n3 4 2 0 1 20 30 40 50\n$EndElements\n\
    $NodeData\n1\n\"heat flow\"\n1\n0.5\n3\n0\n1\n5\n10 1\n20 2\n30 3\n40 4\n50 5\n$EndNodeData\n";
const GMSH_4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n$Nodes\n1 5 1 5\n\
    3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 0.3\n$EndNodes\n$Elements\n1 2 1 2\n3 1 4 2\n1 1 2 3 4\n2 2 3 4 5\n\
    $EndElements\n";
const MEDIT: &str = "MeshVersionFormatted 2\nDimension\n3\n# a comment\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 0.3 1\n\
    Triangles\n1\n1 2 3 7\nTetrahedra\n2\n1 2 3 4 1\n2 3 4 5 2\nEnd\n";
const VTK_TEXT: &str = "# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 0.3\n\
    CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\nCELL_DATA 2\nSCALARS part int 1\nLOOKUP_TABLE default\n1 2\n\
    POINT_DATA 5\nSCALARS heat double\nLOOKUP_TABLE default\n1 2 3 4 5\nVECTORS flow float\n1 0 0 1 0 0 1 0 0 1 0 0 1 0 0\n";
const VTK_5: &str = "# vtk DataFile Version 5.1\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 0.3\n\
    METADATA\nINFORMATION 0\n\nCELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n0 1 2 3 1 2 3 4\n\
    CELL_TYPES 2\n10\n10\n";
const VTU_TEXT: &str = "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\
    <UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"2\"><PointData><DataArray type=\"Int64\" Name=\"id\" \
    format=\"ascii\">1 2 3 4 5</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">\
    0 0 0 1 0 0 0 1 0 0 0 1 1 1 0.3</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\
    0 1 2 3 1 2 3 4</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4 8</DataArray>\
    <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
/// The same points and cells with one scalar, compressed by zlib and in base64, as VTK writes them.
const VTU_ZLIB: &str = include_str!("samples/two_tetrahedra_zlib.vtu");

fn text_files() -> [(&'static str, VolumeFormat, &'static str); 7] {
    [
        ("Gmsh 2.2", VolumeFormat::Gmsh, GMSH_2),
        ("Gmsh 4.1", VolumeFormat::Gmsh, GMSH_4),
        ("MEDIT", VolumeFormat::Medit, MEDIT),
        ("VTK text", VolumeFormat::Vtk, VTK_TEXT),
        ("VTK 5.1", VolumeFormat::Vtk, VTK_5),
        ("VTU text", VolumeFormat::Vtu, VTU_TEXT),
        ("VTU zlib", VolumeFormat::Vtu, VTU_ZLIB),
    ]
}

#[test]
fn every_text_gives_the_same_two_tetrahedra() {
    let expected = two_tetrahedra();
    for (name, format, text) in text_files() {
        assert_eq!(VolumeFormat::detect(text.as_bytes(), None), Some(format), "{name}");
        let (mesh, _) = read_volume_bytes(text.as_bytes(), format).unwrap();
        assert_eq!(
            (&mesh.positions, &mesh.tetrahedra),
            (&expected.positions, &expected.tetrahedra),
            "{name}"
        );
    }
    let (gmsh, report) = read_volume_bytes(GMSH_2.as_bytes(), VolumeFormat::Gmsh).unwrap();
    assert_eq!(gmsh.attribute("heat flow").unwrap().values().collect::<Vec<_>>(), [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(report.n_cells_ignored, 1);
    let (vtk, report) = read_volume_bytes(VTK_TEXT.as_bytes(), VolumeFormat::Vtk).unwrap();
    assert_eq!((vtk.attributes[0].scalar, vtk.attributes[1].n_components), (ScalarType::F64, 3));
    assert_eq!(report.notes().len(), 1);
    let (vtu, report) = read_volume_bytes(VTU_TEXT.as_bytes(), VolumeFormat::Vtu).unwrap();
    assert_eq!((vtu.attributes[0].scalar, report.notes().len()), (ScalarType::I32, 1));
}

#[test]
fn pieces_of_a_vtu_file_become_one_volume() {
    let whole = VTU_TEXT.replace("Int64", "Int32");
    let start = whole.find("<Piece").unwrap();
    let end = whole.find("</UnstructuredGrid>").unwrap();
    let piece = whole[start..end].to_owned();
    let with = |pieces: &[&str]| {
        let text = format!("{}{}{}", &whole[..start], pieces.concat(), &whole[end..]);
        read_volume_bytes(text.as_bytes(), VolumeFormat::Vtu)
    };
    let (mesh, report) = with(&[&piece, &piece.replace("1 2 3 4 5<", "6 7 8 9 10<")]).unwrap();
    assert_eq!(mesh.tetrahedra, [[0, 1, 2, 3], [1, 2, 3, 4], [5, 6, 7, 8], [6, 7, 8, 9]]);
    assert_eq!(mesh.positions[..5], mesh.positions[5..]);
    let ids: Vec<f64> = mesh.attribute("id").unwrap().values().collect();
    assert_eq!(ids, (1..=10).map(f64::from).collect::<Vec<_>>());
    assert!(report.notes().is_empty());
    // A field that a piece lacks, or has with another type or length, is not a field of the whole.
    for other in
        [("\"id\"", "\"name\""), ("Int32\" Name=\"id\"", "Float32\" Name=\"id\""), ("1 2 3 4 5<", "1 2 3 4<")]
    {
        let (mesh, report) = with(&[&piece, &piece.replace(other.0, other.1)]).unwrap();
        assert!(mesh.attributes.is_empty() && !report.notes().is_empty(), "{other:?}");
    }
    assert!(matches!(with(&[]), Err(MeshError::Missing { .. })));
    // Indices count from the first point of their own piece, and must be within it.
    let beyond = with(&[&piece, &piece.replace("0 1 2 3 1 2 3 4", "0 1 2 3 1 2 3 5")]);
    assert!(matches!(beyond, Err(MeshError::IndexOutOfRange { .. })), "{beyond:?}");
    assert!(with(&[&piece.replace("0 1 2 3 1 2 3 4", "0 1 2 3 1 2 3 5"), &piece]).is_err());
}

#[test]
fn two_files_of_tetgen_belong_together() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(
        path("t.node"),
        "# nodes\n5 3 1 1\n1 0 0 0 7 0\n2 1 0 0 8 0\n3 0 1 0 9 0\n4 0 0 1 10 0\n5 1 1 0.3 11 0\n",
    )
    .unwrap();
    assert!(read_volume(path("t.node")).is_err());
    std::fs::write(path("t.ele"), "2 4 0\n1 1 2 3 4\n2 2 3 4 5\n").unwrap();
    for name in ["t.node", "t.ele"] {
        let (mesh, _) = read_volume(path(name)).unwrap();
        assert_eq!(mesh.tetrahedra, two_tetrahedra().tetrahedra);
        assert_eq!(mesh.attribute("attribute_1").unwrap().values().next(), Some(7.0));
    }
}

#[test]
fn cells_of_other_kinds_are_cut_straightened_counted_or_refused() {
    let grid = |cells: &str, n_cells: usize, n_numbers: usize, types: &str| {
        let points: Vec<String> = (0..12).map(|i| format!("{} {} {}", i & 1, i >> 1 & 1, i >> 2)).collect();
        let text = format!(
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 float\n{}\nCELLS {n_cells} {n_numbers}\n{cells}\n\
             CELL_TYPES {n_cells}\n{types}\n",
            points.join("\n")
        );
        read_volume_bytes(text.as_bytes(), VolumeFormat::Vtk)
    };
    // A hexahedron and a voxel on it, a triangle, and a tetrahedron with nodes on its edges.
    let cells = "8 0 1 3 2 4 5 7 6\n8 4 5 6 7 8 9 10 11\n3 0 1 2\n10 0 1 2 4 5 6 7 8 9 10";
    let (mesh, report) = grid(cells, 4, 33, "12 11 5 24").unwrap();
    assert_eq!((report.n_solids_cut, report.n_cells_ignored, report.n_cells_straightened), (2, 1, 1));
    assert_eq!(mesh.tetrahedra.len(), 13);
    assert!((mesh.volume() - 2.0 - 1.0 / 6.0).abs() < 1e-9);
    assert!(matches!(grid("4 0 1 2 12", 1, 5, "10"), Err(MeshError::IndexOutOfRange { index: 12, .. })));
    assert!(matches!(grid("4 0 1 2 4", 1, 5, "42"), Err(MeshError::Unsupported { .. })));
    assert!(matches!(grid("3 0 1 2", 1, 4, "5"), Err(MeshError::NoTetrahedra { n_vertices: 12 })));
    assert!(matches!(grid("2 0 1", 1, 3, "10"), Err(MeshError::Missing { .. })));
}

#[test]
fn a_binary_file_in_the_wrong_byte_order_is_refused() {
    let mut bytes = written(&two_tetrahedra(), VolumeFormat::Vtk);
    let cells = bytes.windows(6).position(|window| window == b"CELLS ").unwrap();
    let start = cells + bytes[cells..].iter().position(|&byte| byte == b'\n').unwrap() + 1;
    for word in bytes[start..start + 40].chunks_exact_mut(4) {
        word.reverse();
    }
    let error = read_volume_bytes(&bytes, VolumeFormat::Vtk).unwrap_err();
    assert!(error.to_string().contains("big-endian"), "{error}");
}

#[test]
fn a_field_of_the_wrong_length_is_left_out_and_named() {
    let text = VTU_TEXT.replace("1 2 3 4 5<", "1 2 3 4<");
    let (mesh, report) = read_volume_bytes(text.as_bytes(), VolumeFormat::Vtu).unwrap();
    assert!(mesh.attributes.is_empty());
    let note = "field \"id\" is left out: it has 4 values for 5 vertices";
    assert_eq!(report.notes(), [note]);
}

#[test]
fn damaged_files_end_in_a_mesh_or_an_error() {
    let use_it = |bytes: &[u8], format| match read_volume_bytes(bytes, format) {
        Ok((mesh, _)) => mesh.check().unwrap(),
        Err(error) => assert!(!error.to_string().is_empty()),
    };
    let binary =
        [VolumeFormat::Vtu, VolumeFormat::Vtk].map(|format| (format, written(&two_tetrahedra(), format)));
    let texts = text_files().map(|(_, format, text)| (format, text.as_bytes().to_vec()));
    for (format, bytes) in texts.into_iter().chain(binary) {
        (0..bytes.len()).for_each(|length| use_it(&bytes[..length], format));
        let mut edited = bytes.clone();
        for at in 0..bytes.len() {
            for value in [bytes[at] ^ 1, bytes[at] ^ 0x80, 0, 0xff, b'9', b'-', b' ', b'<'] {
                edited[at] = value;
                use_it(&edited, format);
            }
            edited[at] = bytes[at];
        }
    }
}

#[test]
fn real_volumes_have_their_known_counts() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/volume");
    if !folder.is_dir() {
        println!("skipped: there are no real volumes at {}", folder.display());
        return;
    }
    let known = [
        ("spx.vtk", 2896, 12936, 1),
        ("post_small_8750.vtk", 2288, 8750, 1),
        ("bluntfin_tets.vtk", 40960, 187_395, 6),
        ("Armadillo13K.msh", 13230, 54985, 0),
        ("indheat.asc.v22.msh", 4949, 29176, 0),
        ("bunny.mesh", 5433, 34055, 0),
        ("tinyBoxt.mesh", 11866, 63434, 0),
        ("raptorTetra_19409.vtu", 5992, 19409, 0),
    ];
    for (file, n_vertices, n_tetrahedra, n_fields) in known {
        let (mesh, _) = read_volume(folder.join(file)).unwrap();
        let found = (mesh.positions.len(), mesh.tetrahedra.len(), mesh.attributes.len());
        assert_eq!(found, (n_vertices, n_tetrahedra, n_fields), "{file}");
    }
    let (grid, report) = read_plot3d(folder.join("combxyz.bin"), &[folder.join("combq.bin")]).unwrap();
    let (tetrahedra, _) = read_volume(folder.join("comb_tets.vtk")).unwrap();
    assert_eq!((grid.tetrahedra.len(), report.n_solids_cut), (tetrahedra.tetrahedra.len(), 43008));
    assert_eq!(grid.positions, tetrahedra.positions);
    assert_eq!(grid.attribute("density").unwrap().bytes, tetrahedra.attribute("density").unwrap().bytes);
    assert!((grid.volume() / tetrahedra.volume() - 1.0).abs() < 1e-3);
}
