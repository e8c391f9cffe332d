//! Finds the format of a volume file and calls its reader or writer. Contents count more than
//! extensions.

use std::fmt;
use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{gmsh, medit, meshb, mfem, plot3d, tetgen, vtk, vtu};
use crate::files::error::Place;
use crate::files::foreign;
use crate::files::input::read_input;
use crate::publish::publish;
use crate::{FileReport, Kind, MeshError, TetrahedronMesh};

/// A volume file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum VolumeFormat {
    /// VTK's XML format, arrays as text, base64 or raw, plain or compressed by zlib, LZ4 or LZMA;
    /// also `.pvtu`, which names the pieces of a grid, and `.pvd`, which names a grid at several
    /// times.
    Vtu,
    /// Legacy VTK, text or binary.
    Vtk,
    /// Gmsh 1, 2.2 and 4.1, text or binary.
    Gmsh,
    /// MEDIT, text or binary.
    Medit,
    /// MFEM meshes, text; also under the extension `mesh`.
    Mfem,
    /// TetGen: a `.node` and an `.ele` file of one name.
    Tetgen,
    /// PLOT3D: a curvilinear grid, with solutions in files of their own.
    Plot3d,
}

impl VolumeFormat {
    /// All formats.
    pub const ALL: [Self; 7] =
        [Self::Vtu, Self::Vtk, Self::Gmsh, Self::Medit, Self::Mfem, Self::Tetgen, Self::Plot3d];

    /// The file extensions, in lower case and without the dot; the first is the one written.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Vtu => &["vtu", "pvtu", "pvd"],
            Self::Vtk => &["vtk"],
            Self::Gmsh => &["msh"],
            Self::Medit => &["mesh", "meshb"],
            Self::Mfem => &["mfem"],
            Self::Tetgen => &["ele", "node"],
            Self::Plot3d => &["p3d", "x", "bin"],
        }
    }

    /// The format that a path's extension names, whatever its case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        let is_named = |name: &&str| name.eq_ignore_ascii_case(extension);
        Self::ALL.into_iter().find(|format| format.extensions().iter().any(is_named))
    }

    /// The format of a file's contents; `extension` if the contents do not tell it.
    pub fn detect(bytes: &[u8], extension: Option<Self>) -> Option<Self> {
        if bytes.starts_with(b"# vtk DataFile") {
            return Some(Self::Vtk);
        }
        let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start();
        if text.starts_with(b"$MeshFormat") || text.starts_with(b"$NOD") {
            return Some(Self::Gmsh);
        }
        if text.starts_with(mfem::MAGIC) {
            return Some(Self::Mfem);
        }
        if is_medit(text) {
            return Some(Self::Medit);
        }
        if text.starts_with(b"<VTKFile") || (text.starts_with(b"<?xml") && extension.is_none()) {
            return Some(Self::Vtu);
        }
        if meshb::is_meshb(bytes) && matches!(extension, None | Some(Self::Medit)) {
            return Some(Self::Medit);
        }
        extension
    }

    /// Whether [`write_volume`] writes it.
    pub fn is_written(self) -> bool {
        matches!(self, Self::Vtu | Self::Vtk)
    }
}

/// Whether text begins as MEDIT does, in any case.
fn is_medit(text: &[u8]) -> bool {
    const KEYWORD: &[u8] = b"MeshVersionFormatted";
    text.get(..KEYWORD.len()).is_some_and(|start| start.eq_ignore_ascii_case(KEYWORD))
}

impl fmt::Display for VolumeFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Vtu => "VTU",
            Self::Vtk => "legacy VTK",
            Self::Gmsh => "Gmsh",
            Self::Medit => "MEDIT",
            Self::Mfem => "MFEM",
            Self::Tetgen => "TetGen",
            Self::Plot3d => "PLOT3D",
        })
    }
}

/// Reads a volume file of any known format.
///
/// Costs one read of the file and a few passes over its bytes; memory stays within a constant times
/// its size. Of TetGen's two files `path` is either; the other one of the same name is read as
/// well. Files that a `.pvtu` or `.pvd` names are read if they are in its folder or below.
///
/// # Errors
///
/// [`MeshError::InFile`] with the file's name and the error inside.
pub fn read_volume(path: impl AsRef<Path>) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let path = path.as_ref();
    let read = || {
        let bytes = read_input(path)?;
        if let Some(name) = foreign::name_of(&bytes) {
            return Err(MeshError::FormatNotRead { name });
        }
        let format =
            VolumeFormat::detect(&bytes, VolumeFormat::from_path(path)).ok_or(MeshError::UnknownFormat)?;
        if format == VolumeFormat::Vtu {
            return vtu::read(&bytes, path.parent());
        }
        if format != VolumeFormat::Tetgen {
            return read_volume_bytes(&bytes, format);
        }
        let is_node = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("node"));
        let other = path.with_extension(if is_node { "ele" } else { "node" });
        let other_bytes = read_input(&other).map_err(|error| MeshError::from(error).in_file(&other))?;
        if is_node { tetgen::read(&bytes, &other_bytes) } else { tetgen::read(&other_bytes, &bytes) }
    };
    read().map_err(|error: MeshError| error.in_file(path))
}

/// Reads a volume from the bytes of a file in a known format.
///
/// # Errors
///
/// Any [`MeshError`] about contents; [`MeshError::Unsupported`] for TetGen, which is two files.
pub fn read_volume_bytes(
    bytes: &[u8],
    format: VolumeFormat,
) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    match format {
        VolumeFormat::Vtu => vtu::read(bytes, None),
        VolumeFormat::Vtk => vtk::read(bytes),
        VolumeFormat::Gmsh => gmsh::read(bytes),
        VolumeFormat::Medit if meshb::is_meshb(bytes) => meshb::read(bytes),
        VolumeFormat::Medit => medit::read(bytes),
        VolumeFormat::Mfem => mfem::read(bytes),
        VolumeFormat::Plot3d => plot3d::read(bytes, &[]),
        VolumeFormat::Tetgen => {
            let feature = "TetGen in less than two files".to_owned();
            Err(MeshError::Unsupported { place: Place::File, feature })
        }
    }
}

/// Reads a PLOT3D grid and the solutions on it, such as several time steps.
///
/// # Errors
///
/// [`MeshError::InFile`] with the grid's name and the error inside.
pub fn read_plot3d(
    grid: impl AsRef<Path>,
    solutions: &[impl AsRef<Path>],
) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let read = |path: &Path| read_input(path).map_err(|error| MeshError::from(error).in_file(path));
    let bytes = read(grid.as_ref())?;
    let solutions: Vec<Vec<u8>> =
        solutions.iter().map(|path| read(path.as_ref())).collect::<Result<_, _>>()?;
    let solutions: Vec<&[u8]> = solutions.iter().map(Vec::as_slice).collect();
    plot3d::read(&bytes, &solutions).map_err(|error| error.in_file(grid.as_ref()))
}

/// Writes a volume in the format that the path's extension names. The file appears whole or not at
/// all. The report tells what the format has no place for.
///
/// # Errors
///
/// [`MeshError::InFile`] with the file's name around [`MeshError::UnknownExtension`],
/// [`MeshError::InconsistentMesh`] or [`MeshError::Io`].
pub fn write_volume(path: impl AsRef<Path>, mesh: &TetrahedronMesh) -> Result<FileReport, MeshError> {
    let path = path.as_ref();
    let write = || {
        let Some(format) = VolumeFormat::from_path(path).filter(|format| format.is_written()) else {
            let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            return Err(MeshError::UnknownVolumeExtension { extension });
        };
        publish(path, |out| write_volume_to(out, mesh, format))
    };
    write().map_err(|error| error.in_file(path))
}

/// Writes a volume in a format to any writer, which should be buffered.
///
/// # Errors
///
/// As [`write_volume`], without the file's name.
pub fn write_volume_to(
    out: &mut dyn Write,
    mesh: &TetrahedronMesh,
    format: VolumeFormat,
) -> Result<FileReport, MeshError> {
    mesh.check()?;
    let mut report = FileReport::of_attributes(format, Kind::Field, &mesh.attributes);
    match format {
        VolumeFormat::Vtu => vtu::write(mesh, out, &mut report)?,
        VolumeFormat::Vtk => vtk::write(mesh, out, &mut report)?,
        VolumeFormat::Gmsh
        | VolumeFormat::Medit
        | VolumeFormat::Mfem
        | VolumeFormat::Tetgen
        | VolumeFormat::Plot3d => {
            return Err(MeshError::UnknownVolumeExtension { extension: format.extensions()[0].into() });
        }
    }
    Ok(report)
}
