//! Which format a file is in, and the way to its reader or writer.
//!
//! Contents are believed before extensions: a PLY file named `.obj` is read as PLY, and the report
//! says so.

use std::borrow::Cow;
use std::fmt;
use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{foreign, gltf, obj, off, ply, stl};
use crate::files::input::read_input;
use crate::files::text::{BYTE_ORDER_MARK, Scanner, Style, as_utf8};
use crate::publish::publish;
use crate::{FileReport, Kind, MeshError, TriangleMesh};

/// A mesh file format.
///
/// ```
/// use nephrite_formats::MeshFormat;
///
/// assert_eq!(MeshFormat::from_path("scan.PLY".as_ref()), Some(MeshFormat::Ply));
/// // Contents are believed before the extension.
/// assert_eq!(MeshFormat::detect(b"OFF\n3 1 0\n", Some(MeshFormat::Obj)), Some(MeshFormat::Off));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum MeshFormat {
    /// Polygon file format, text or binary.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// Stereolithography, text or binary.
    Stl,
    /// Geomview's object file format, text.
    Off,
    /// glTF 2.0 with its JSON in a text file.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
}

impl MeshFormat {
    /// All formats.
    pub const ALL: [Self; 6] = [Self::Ply, Self::Obj, Self::Stl, Self::Off, Self::Gltf, Self::Glb];

    /// The file extension, in lower case and without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
        }
    }

    /// The format that a path's extension names, whatever its case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL.into_iter().find(|format| format.extension().eq_ignore_ascii_case(extension))
    }

    /// The format of a file's contents, with the format that its extension names where the contents
    /// leave it open.
    ///
    /// Looks at no more than the beginning and the length.
    pub fn detect(bytes: &[u8], extension: Option<Self>) -> Option<Self> {
        let is_sized_stl = stl::length_of_binary(bytes) == Some(bytes.len() as u64);
        if is_sized_stl && extension == Some(Self::Stl) {
            return extension;
        }
        let beginning = as_utf8(beginning(bytes));
        let bytes = beginning.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&beginning);
        let magic = if bytes.starts_with(b"glTF") {
            Some(Self::Glb)
        } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else {
            first_word_format(bytes)
        };
        magic.or(extension).or(is_sized_stl.then_some(Self::Stl)).or_else(|| guess_text(bytes))
    }
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ply => "PLY",
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Off => "OFF",
            Self::Gltf => "glTF",
            Self::Glb => "GLB",
        })
    }
}

/// Reads a mesh file of any known format.
///
/// Costs one read of the file and a few passes over its bytes; memory stays within a constant times
/// its size.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = tempfile::tempdir()?;
/// let path = folder.path().join("square.obj");
/// std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// let (mesh, report) = nephrite_formats::read_mesh(&path)?;
/// assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
/// assert_eq!(report.n_polygons_triangulated, 1);
/// nephrite_formats::write_mesh(path.with_extension("glb"), &mesh)?;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// [`MeshError::InFile`] with the file's name and the error inside.
pub fn read_mesh(path: impl AsRef<Path>) -> Result<(TriangleMesh, FileReport), MeshError> {
    let path = path.as_ref();
    read_file(path).map_err(|error| error.in_file(path))
}

fn read_file(path: &Path) -> Result<(TriangleMesh, FileReport), MeshError> {
    let bytes = read_input(path)?;
    let extension = MeshFormat::from_path(path);
    let bytes = in_utf8(&bytes);
    let by_contents = MeshFormat::detect(&bytes, None);
    if by_contents.is_none()
        && extension != Some(MeshFormat::Stl)
        && let Some(name) = foreign::name_of(&bytes)
    {
        return Err(MeshError::FormatNotRead { name });
    }
    let format = MeshFormat::detect(&bytes, extension).ok_or_else(|| foreign::unread(&bytes))?;
    let (mesh, mut report) = read_bytes(&bytes, format, path.parent())?;
    if let Some(extension) = extension.filter(|&extension| extension != format) {
        report.remark(format!("the extension says {extension}, the contents are {format}"));
    }
    Ok((mesh, report))
}

/// The contents of a file, text in UTF-16 as UTF-8. The header of a binary STL file may begin with
/// any bytes.
fn in_utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    if stl::length_of_binary(bytes) == Some(bytes.len() as u64) {
        Cow::Borrowed(bytes)
    } else {
        as_utf8(bytes)
    }
}

/// Reads a mesh from the bytes of a file in a known format.
///
/// # Errors
///
/// Any [`MeshError`] about contents; also for glTF that refers to other files, as there is no
/// folder to look in.
pub fn read_mesh_bytes(bytes: &[u8], format: MeshFormat) -> Result<(TriangleMesh, FileReport), MeshError> {
    read_bytes(bytes, format, None)
}

fn read_bytes(
    bytes: &[u8],
    format: MeshFormat,
    folder: Option<&Path>,
) -> Result<(TriangleMesh, FileReport), MeshError> {
    let bytes = &in_utf8(bytes);
    match format {
        MeshFormat::Ply => ply::read(bytes),
        MeshFormat::Obj => obj::read(bytes),
        MeshFormat::Stl => stl::read(bytes),
        MeshFormat::Off => off::read(bytes),
        MeshFormat::Gltf | MeshFormat::Glb => gltf::read(bytes, format, folder),
    }
}

/// Writes a mesh in the format that the path's extension names (`ply`, `obj`, `stl`, `off` or
/// `glb`).
///
/// The file appears whole or not at all. The report tells what the format has no place for.
///
/// # Errors
///
/// [`MeshError::InFile`] with the file's name around [`MeshError::UnknownExtension`],
/// [`MeshError::InconsistentMesh`], [`MeshError::TooLargeForFormat`] or [`MeshError::Io`].
pub fn write_mesh(path: impl AsRef<Path>, mesh: &TriangleMesh) -> Result<FileReport, MeshError> {
    let path = path.as_ref();
    write_file(path, mesh).map_err(|error| error.in_file(path))
}

fn write_file(path: &Path, mesh: &TriangleMesh) -> Result<FileReport, MeshError> {
    let Some(format) = MeshFormat::from_path(path).filter(|&format| format != MeshFormat::Gltf) else {
        let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        return Err(MeshError::UnknownExtension { extension });
    };
    publish(path, |out| write_mesh_to(out, mesh, format))
}

/// Writes a mesh in a format to any writer, which should be buffered.
///
/// # Errors
///
/// As [`write_mesh`], without the file's name.
pub fn write_mesh_to(
    out: &mut dyn Write,
    mesh: &TriangleMesh,
    format: MeshFormat,
) -> Result<FileReport, MeshError> {
    mesh.check()?;
    let mut report = FileReport::of_attributes(format, Kind::Attribute, &mesh.attributes);
    match format {
        MeshFormat::Ply => ply::write(mesh, out, &mut report)?,
        MeshFormat::Obj => obj::write(mesh, out, &mut report)?,
        MeshFormat::Stl => stl::write(mesh, out, &mut report)?,
        MeshFormat::Off => off::write(mesh, out, &mut report)?,
        MeshFormat::Glb => gltf::write(mesh, out, &mut report)?,
        MeshFormat::Gltf => {
            return Err(MeshError::UnknownExtension { extension: format.extension().into() });
        }
    }
    Ok(report)
}

/// The format whose first word, after comments, stands at the beginning.
fn first_word_format(bytes: &[u8]) -> Option<MeshFormat> {
    let word =
        Scanner::new(beginning(bytes), Style { hash_comments: true, continued_lines: false }).word()?;
    if word.starts_with(b"{") {
        return Some(MeshFormat::Gltf);
    }
    off::Keyword::parse(word).map(|_| MeshFormat::Off)
}

/// STL or OBJ by the words that text in them begins with.
fn guess_text(bytes: &[u8]) -> Option<MeshFormat> {
    let word =
        Scanner::new(beginning(bytes), Style { hash_comments: true, continued_lines: false }).word()?;
    match word {
        b"solid" => Some(MeshFormat::Stl),
        b"v" | b"vt" | b"vn" | b"vp" | b"f" | b"o" | b"g" | b"s" | b"mtllib" | b"usemtl" => {
            Some(MeshFormat::Obj)
        }
        _ => None,
    }
}

/// As much of a file as is searched for its first word.
fn beginning(bytes: &[u8]) -> &[u8] {
    const SEARCHED_BYTES: usize = 64 * 1024;
    bytes.get(..SEARCHED_BYTES).unwrap_or(bytes)
}
