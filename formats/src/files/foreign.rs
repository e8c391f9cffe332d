//! Well-known kinds of files that are not read, told by how they begin, so that a message can name
//! them.

use crate::MeshError;
use crate::files::text::{Scanner, Style};

/// Files that begin with certain bytes, and what they are called.
const MAGICS: [(&[u8], &str); 42] = [
    (b"version https://git-lfs", "a pointer of Git LFS to the file itself"),
    (b"ISO-10303-21", "STEP"),
    (b"CDF\x01", "netCDF, as Exodus is"),
    (b"CDF\x02", "netCDF, as Exodus is"),
    (b"CDF\x05", "netCDF, as Exodus is"),
    (b"@(#)ADF", "CGNS"),
    (b"MFEM NURBS", "MFEM with NURBS"),
    (b"MFEM INLINE", "MFEM of an inline mesh"),
    (b"MFEM NC", "MFEM with hanging nodes"),
    (b"mesh3d", "Netgen"),
    (b"(0 ", "Fluent"),
    (b"(1 ", "Fluent"),
    (b"(2 ", "Fluent"),
    (b"/COM", "Ansys"),
    (b"/PREP7", "Ansys"),
    (b"BEGIN BULK", "Nastran"),
    (b"#!TDV", "Tecplot"),
    (b"C Binary", "EnSight"),
    (b"DRACO", "Draco"),
    (b"Kaydara FBX", "FBX"),
    (b"; FBX", "FBX"),
    (b"PXR-USDC", "USD"),
    (b"#usda", "USD"),
    (b"#VRML", "VRML"),
    (b"#X3D", "X3D"),
    (b"<COLLADA", "COLLADA"),
    (b"<X3D", "X3D"),
    (b"<Xdmf", "XDMF"),
    (b"<amf", "AMF"),
    (b"<dolfin", "FEniCS XML"),
    (b"BLENDER", "Blender"),
    (b"3D Geometry File Format", "Rhino 3DM"),
    (b"LASF", "LAS, a cloud of points"),
    (b"ASTM-E57", "E57, a cloud of points"),
    (b"# .PCD", "PCD, a cloud of points"),
    (b"PK\x03\x04", "a zip archive"),
    (b"\x89PNG", "a picture (PNG)"),
    (b"\xFF\xD8\xFF", "a picture (JPEG)"),
    (b"%PDF", "PDF"),
    (b"Ogawa", "Alembic"),
    (b"xof ", "DirectX X"),
    (b"\x1F\x8B\x08", "compressed by gzip"),
];

/// What VTK's XML calls grids that are not read, and what their files are called.
const OF_VTK: [(&[u8], &str); 9] = [
    (b"PolyData", "VTP, VTK's PolyData"),
    (b"ImageData", "VTI, VTK's ImageData"),
    (b"RectilinearGrid", "VTR, VTK's RectilinearGrid"),
    (b"StructuredGrid", "VTS, VTK's StructuredGrid"),
    (b"PPolyData", "PVTP, VTK's PPolyData"),
    (b"PImageData", "PVTI, VTK's PImageData"),
    (b"PRectilinearGrid", "PVTR, VTK's PRectilinearGrid"),
    (b"PStructuredGrid", "PVTS, VTK's PStructuredGrid"),
    (b"vtkMultiBlockDataSet", "VTM, VTK's vtkMultiBlockDataSet"),
];

/// The name of a kind of file that is not read; `None` if the bytes are of another kind.
pub(crate) fn name_of(bytes: &[u8]) -> Option<&'static str> {
    const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
    if bytes.starts_with(HDF5) {
        let is_cgns = contains(beginning(bytes), b"CGNS");
        return Some(if is_cgns { "CGNS" } else { "HDF5, as CGNS, Exodus and MED are" });
    }
    if is_utf_16(bytes) {
        return Some("text in UTF-16");
    }
    if bytes.starts_with(b"PK\x03\x04") && contains(beginning(bytes), b"3D/") {
        return Some("3MF");
    }
    let text = root_element(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start());
    if text.starts_with(b"<VTKFile") {
        return vtk_grid(text);
    }
    let of_magic = MAGICS.iter().find(|(magic, _)| text.starts_with(magic)).map(|&(_, name)| name);
    of_magic.or_else(|| keyword_file(text))
}

/// The error for a file whose kind nothing tells, or which is of a kind that is not read.
pub(crate) fn unread(bytes: &[u8]) -> MeshError {
    name_of(bytes).map_or(MeshError::UnknownFormat, |name| MeshError::FormatNotRead { name })
}

/// As much of a file as is searched.
fn beginning(bytes: &[u8]) -> &[u8] {
    const SEARCHED_BYTES: usize = 64 * 1024;
    bytes.get(..SEARCHED_BYTES).unwrap_or(bytes)
}

fn contains(bytes: &[u8], wanted: &[u8]) -> bool {
    bytes.windows(wanted.len()).any(|window| window == wanted)
}

/// A byte order mark, and a first character that every text format begins with.
fn is_utf_16(bytes: &[u8]) -> bool {
    match bytes {
        [0xFF, 0xFE, low, 0, ..] => *low > 0,
        [0xFE, 0xFF, 0, low, ..] => *low > 0,
        _ => false,
    }
}

/// XML from its first element on; anything else as it is.
fn root_element(text: &[u8]) -> &[u8] {
    let mut rest = text;
    while let Some(b'?' | b'!') = rest.get(1).filter(|_| rest.first() == Some(&b'<')) {
        let end: &[u8] = if rest.starts_with(b"<!--") { b"-->" } else { b">" };
        let Some(at) = beginning(rest).windows(end.len()).position(|window| window == end) else { break };
        rest = rest[at + end.len()..].trim_ascii_start();
    }
    rest
}

/// What kind of grid a `VTKFile` says that it has.
fn vtk_grid(text: &[u8]) -> Option<&'static str> {
    let tag = beginning(text).split(|&byte| byte == b'>').next()?;
    let at = tag.windows(6).position(|window| window == b"type=\"")?;
    let kind = tag[at + 6..].split(|&byte| byte == b'"').next()?;
    OF_VTK.iter().find(|(known, _)| *known == kind).map(|&(_, name)| name)
}

/// Abaqus and LS-DYNA, whose lines begin with keywords behind a star.
fn keyword_file(text: &[u8]) -> Option<&'static str> {
    let mut scanner = Scanner::new(beginning(text), Style::default());
    let mut word = scanner.word()?;
    while word.starts_with(b"**") || word.starts_with(b"$") {
        // A comment up to the end of its line.
        if !scanner.next_line() {
            return None;
        }
        word = scanner.word()?;
    }
    let keyword = word.strip_prefix(b"*")?.to_ascii_lowercase();
    let keyword = keyword.split(|&byte| byte == b',').next()?;
    match keyword {
        b"keyword" => Some("LS-DYNA"),
        b"heading" | b"node" | b"part" | b"element" | b"include" | b"preprint" | b"assembly" => {
            Some("Abaqus")
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_told_by_how_they_begin() {
        let expected: [(&[u8], &str); 15] = [
            (b"ISO-10303-21;\nHEADER;\n", "STEP"),
            (b"\x89HDF\r\n\x1a\n\0\0\0 CGNSLibraryVersion", "CGNS"),
            (b"\x89HDF\r\n\x1a\n\0\0\0", "HDF5"),
            (b"CDF\x01\0\0", "Exodus"),
            (b"MFEM INLINE mesh v1.0\n", "MFEM"),
            (b"<?xml version=\"1.0\"?>\n<!-- made <by> x -->\n<COLLADA>", "COLLADA"),
            (b"\xEF\xBB\xBF <VTKFile version=\"1\" type=\"PolyData\">", "PolyData"),
            (b"<?xml?><VTKFile type=\"ImageData\">", "ImageData"),
            (b"*Heading\n phys.inp\n*NODE\n", "Abaqus"),
            (b"** a comment\n*NODE, NSET=all\n", "Abaqus"),
            (b"$ a comment\n*KEYWORD\n", "LS-DYNA"),
            (b"(0 \"a mesh\")\n", "Fluent"),
            (b"\xFF\xFEv\0 \0", "UTF-16"),
            (b"PK\x03\x04\0\0", "zip"),
            (b"PK\x03\x04\0\0 3D/3dmodel.model", "3MF"),
        ];
        for (bytes, name) in expected {
            let message = unread(bytes).to_string();
            assert!(message.contains(name), "{name}: {message}");
        }
    }

    #[test]
    fn other_files_are_of_no_known_kind() {
        let others: [&[u8]; 9] = [
            b"",
            b"*",
            b"**",
            b"<",
            b"<!--",
            b"<VTKFile type=\"UnstructuredGrid\">",
            b"# vtk DataFile Version 3.0\n",
            b"v 0 0 0\n",
            &[42, 0, 0, 0, 7, 0, 0, 0],
        ];
        for bytes in others {
            assert_eq!(name_of(bytes), None, "{bytes:?}");
        }
        let message = unread(b"nothing").to_string();
        for format in ["PLY", "GLB", "VTU", "MEDIT", "PLOT3D"] {
            assert!(message.contains(format), "{message}");
        }
    }
}
