//! Promise: memory and time follow what a volume file holds, not what it claims.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod capped;

use capped::{alone, within};
use nephrite_formats::{
    FileReport, MeshError, TetrahedronMesh, VolumeFormat, read_volume, read_volume_bytes,
};

fn read_volume_within(
    bytes: &[u8],
    format: VolumeFormat,
) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    within(bytes.len(), format, || read_volume_bytes(bytes, format))
}

/// Two tetrahedra in every text format of volumes, and in binary where it is written here.
fn volumes() -> Vec<(VolumeFormat, Vec<u8>)> {
    let mesh = TetrahedronMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.3]],
        tetrahedra: vec![[0, 1, 2, 3], [1, 2, 3, 4]],
        ..TetrahedronMesh::default()
    };
    let written = |format| {
        let mut bytes = Vec::new();
        nephrite_formats::write_volume_to(&mut bytes, &mesh, format).unwrap();
        (format, bytes)
    };
    let points = "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
    let gmsh_2 = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{points}$EndNodes\n\
         $Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n$NodeData\n1\nf\n0\n3\n0\n1\n4\n1 1\n2 1\n3 1\n4 1\n$EndNodeData\n"
    );
    let gmsh_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n\
                  $Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";
    let medit = "MeshVersionFormatted 2\nDimension\n3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n\
                 Triangles\n1\n1 2 3 0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n";
    let vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n\
               4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS a int 1\nLOOKUP_TABLE default\n1 2 3 4\nFIELD b 1\nc 1 4 int\n1 2 3 4\n";
    let vtk_5 = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 2 4\n\
                 OFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\n";
    let texts = [
        (VolumeFormat::Gmsh, gmsh_2.as_str()),
        (VolumeFormat::Gmsh, gmsh_4),
        (VolumeFormat::Medit, medit),
        (VolumeFormat::Vtk, vtk),
        (VolumeFormat::Vtk, vtk_5),
    ];
    let mut files = vec![written(VolumeFormat::Vtu), written(VolumeFormat::Vtk)];
    files.extend(texts.map(|(format, text)| (format, text.as_bytes().to_vec())));
    files
}

#[test]
fn numbers_in_volumes_that_claim_more_are_refused_or_cost_nothing() {
    let _guard = alone();
    for (format, bytes) in volumes() {
        read_volume_within(&bytes, format).unwrap();
        let mut at = 0;
        while at < bytes.len() {
            let n_digits = bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
            for giant in ["0", "1000000", "2147483648", "4000000000", "18446744073709551615", "-1"] {
                let edited = [&bytes[..at], giant.as_bytes(), &bytes[at + n_digits..]].concat();
                // Any outcome is accepted, within the limit of memory.
                let _ = read_volume_within(&edited, format);
            }
            at += n_digits.max(1);
        }
    }
}

/// Whole files of the corpus, each in both byte orders.
const BINARY: [(VolumeFormat, &str); 6] = [
    (VolumeFormat::Gmsh, "binary-2-whole.msh"),
    (VolumeFormat::Gmsh, "binary-2-big-endian.msh"),
    (VolumeFormat::Gmsh, "binary-4-whole.msh"),
    (VolumeFormat::Gmsh, "binary-4-big-endian.msh"),
    (VolumeFormat::Medit, "binary-whole.meshb"),
    (VolumeFormat::Medit, "binary-big-endian.meshb"),
];

#[test]
fn binary_numbers_that_claim_more_are_refused_or_cost_nothing() {
    let _guard = alone();
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/bad_volumes/files");
    let giants: [&[u8]; 6] = [
        &[0xFF; 8],
        &[0xFF; 4],
        &[0xFF, 0xFF, 0xFF, 0x7F],
        &[0x7F, 0xFF, 0xFF, 0xFF],
        &[0, 0, 0, 1],
        &[1, 0, 0, 0],
    ];
    for (format, name) in BINARY {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        read_volume_within(&bytes, format).unwrap();
        for at in 0..bytes.len() {
            for giant in giants {
                let rest = bytes.get(at + giant.len()..).unwrap_or_default();
                // Any outcome is accepted, within the limit of memory.
                let _ = read_volume_within(&[&bytes[..at], giant, rest].concat(), format);
            }
        }
    }
}

#[test]
fn dimensions_of_plot3d_that_claim_more_are_refused() {
    let _guard = alone();
    for dimensions in [[u32::MAX; 3], [65536, 65536, 2], [1 << 31, 2, 2], [0, 0, 0], [1, 1, 1]] {
        for is_big_endian in [true, false] {
            let word = |value: u32| if is_big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
            let bytes = [dimensions.map(word).concat(), vec![0; 96]].concat();
            assert!(read_volume_within(&bytes, VolumeFormat::Plot3d).is_err());
        }
    }
}

#[test]
fn files_of_tetgen_that_claim_more_are_refused() {
    let _guard = alone();
    let folder = tempfile::tempdir().unwrap();
    let (node, ele) = (folder.path().join("t.node"), folder.path().join("t.ele"));
    for (nodes, elements) in [
        ("4000000000 3 0 0\n1 0 0 0\n", "1 4 0\n1 1 1 1 1\n"),
        ("1 3 64 0\n1 0 0 0\n", "1 4 0\n1 1 1 1 1\n"),
        ("1 3 0 0\n1 0 0 0\n", "4000000000 4 0\n1 1 1 1 1\n"),
        ("1 3 0 0\n1 0 0 0\n", "1 4 4000000000\n1 1 1 1 1\n"),
    ] {
        std::fs::write(&node, nodes).unwrap();
        std::fs::write(&ele, elements).unwrap();
        assert!(within(nodes.len() + elements.len(), "TetGen", || read_volume(&node)).is_err());
    }
}

#[test]
fn thousands_of_fields_of_one_name() {
    let _guard = alone();
    let tetrahedron = "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>\
        <Cells><DataArray type=\"Int8\" Name=\"connectivity\">0 1 2 3</DataArray>\
        <DataArray type=\"Int8\" Name=\"offsets\">4</DataArray><DataArray type=\"Int8\" Name=\"types\">10</DataArray></Cells>";
    let fields = "<DataArray type=\"Int8\">1 2 3 4</DataArray>".repeat(30_000);
    let vtu = format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece><PointData>{fields}</PointData>{tetrahedron}</Piece>\
         </UnstructuredGrid></VTKFile>"
    );
    let (mesh, report) = read_volume_within(vtu.as_bytes(), VolumeFormat::Vtu).unwrap();
    assert_eq!((mesh.attributes.len(), report.items().len()), (30_000, 30_000));
    assert_eq!(mesh.attributes[29_999].name, "field_30000");
    let scalars = "SCALARS a int 1\nLOOKUP_TABLE default\n1 2 3 4\n".repeat(30_000);
    let vtk = format!(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n\
         4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\n{scalars}"
    );
    let (mesh, _) = read_volume_within(vtk.as_bytes(), VolumeFormat::Vtk).unwrap();
    assert_eq!(mesh.attributes[29_999].name, "a_30000");
}

#[test]
fn thousands_of_arrays_that_are_the_same_bytes() {
    let _guard = alone();
    // 100,000 points and 1,000 fields, all over the same array of the appended data.
    let data = vec![0; 1_200_000];
    let array = |name: &str, n_components| {
        format!(
            "<DataArray type=\"Float32\" Name=\"{name}\" NumberOfComponents=\"{n_components}\" format=\"appended\" offset=\"0\"/>"
        )
    };
    let fields: String = (0..1000).map(|i| array(&format!("f{i}"), 3)).collect();
    let xml = format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece><Points>{}</Points><Cells>\
         <DataArray type=\"Int8\" Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int8\" Name=\"offsets\">4</DataArray>\
         <DataArray type=\"Int8\" Name=\"types\">10</DataArray></Cells><PointData>{fields}</PointData></Piece>\
         </UnstructuredGrid><AppendedData encoding=\"raw\">_",
        array("points", 3)
    );
    let bytes = [xml.as_bytes(), &1_200_000_u32.to_le_bytes(), &data].concat();
    let error = read_volume_within(&bytes, VolumeFormat::Vtu).unwrap_err();
    assert!(matches!(error, MeshError::CountTooLarge { .. }), "{error}");
}

#[test]
fn thousands_of_empty_values_at_nodes() {
    let _guard = alone();
    let n_nodes = 50_000;
    let nodes: String = (1..=n_nodes).map(|i| format!("{i} 0 0 {i}\n")).collect();
    let data = "$NodeData\n0\n0\n3\n0\n9\n0\n$EndNodeData\n".repeat(20_000);
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{n_nodes}\n{nodes}$EndNodes\n\
         $Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n{data}"
    );
    let (mesh, report) = read_volume_within(text.as_bytes(), VolumeFormat::Gmsh).unwrap();
    assert_eq!((mesh.attributes.len(), report.items().len()), (0, 20_000));
}

#[test]
fn xml_nested_deeply() {
    let _guard = alone();
    let nested = format!("<VTKFile type=\"UnstructuredGrid\">{}", "<a>".repeat(300_000));
    assert!(read_volume_within(nested.as_bytes(), VolumeFormat::Vtu).is_err());
    let closed = format!("{nested}{}</VTKFile>", "</a>".repeat(300_000));
    assert!(read_volume_within(closed.as_bytes(), VolumeFormat::Vtu).is_err());
    let entities = "<!DOCTYPE a [<!ENTITY b \"bbbbbbbbbb\"><!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;\">]><VTKFile>&c;</VTKFile>";
    assert!(read_volume_within(entities.as_bytes(), VolumeFormat::Vtu).is_err());
}

#[test]
fn one_line_of_many_megabytes_in_volumes() {
    let _guard = alone();
    let word = "x".repeat(10_000_000);
    let heads = [
        (VolumeFormat::Vtk, "# vtk DataFile Version 3.0\nx\nASCII\n"),
        (VolumeFormat::Vtk, "# vtk DataFile Version 3.0\n"),
        (VolumeFormat::Vtu, "<VTKFile "),
        (VolumeFormat::Gmsh, "$MeshFormat\n"),
        (VolumeFormat::Gmsh, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$"),
        (VolumeFormat::Medit, "MeshVersionFormatted 2\n"),
        (VolumeFormat::Plot3d, ""),
    ];
    for (format, head) in heads {
        assert!(read_volume_within(format!("{head}{word}").as_bytes(), format).is_err());
    }
}
