//! Paths a command is given: checked before hours of work go towards them.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use nephrite::{Lod, TetrahedronMesh, TriangleMesh};
use nephrite_formats::{FileReport, MeshError, MeshFormat, VolumeFormat};

use crate::failure::Failure;
use crate::report;

/// Reads a mesh.
///
/// # Errors
///
/// Whatever is wrong with the file.
pub(crate) fn read_mesh(path: &Path) -> Result<(TriangleMesh, FileReport), Failure> {
    Ok(nephrite_formats::read_mesh(path)?)
}

/// Reads a volume, PLOT3D with its solutions.
///
/// # Errors
///
/// Whatever is wrong with the files.
pub(crate) fn read_volume(
    path: &Path,
    solutions: &[PathBuf],
) -> Result<(TetrahedronMesh, FileReport), Failure> {
    Ok(match solutions {
        [] => nephrite_formats::read_volume(path)?,
        solutions => nephrite_formats::read_plot3d(path, solutions)?,
    })
}

/// Prints to stderr what a file held that was left out or changed.
pub(crate) fn tell(path: &Path, report: &FileReport) {
    for note in report.notes() {
        report::note(&format!("{}: {note}", path.display()));
    }
}

/// Whether a path names a volume by its extension.
pub(crate) fn is_volume(path: &Path) -> bool {
    VolumeFormat::from_path(path).is_some()
}

/// Opens a file that `build` wrote. It is read, not mapped: nobody vouches for a path from a command line.
///
/// # Errors
///
/// Whatever is wrong with its head.
pub(crate) fn open_lod(path: &Path) -> Result<Lod, Failure> {
    Lod::open(path).map_err(|source| Failure::file(path, source))
}

/// Checks that a file can be put where `output` says and that it is none of the `inputs`.
///
/// # Errors
///
/// A folder that is missing, a folder in the file's place, or an output that would replace an input.
pub(crate) fn check_output(output: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    let folder = match output.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let metadata = fs::metadata(folder).map_err(|source| Failure::file(folder, source))?;
    if !metadata.is_dir() {
        return Err(Failure::file(folder, io::Error::from(io::ErrorKind::NotADirectory)));
    }
    if output.is_dir() {
        return Err(Failure::file(output, io::Error::from(io::ErrorKind::IsADirectory)));
    }
    let same = |input: &&&Path| matches!((fs::canonicalize(input), fs::canonicalize(output)), (Ok(a), Ok(b)) if a == b);
    match inputs.iter().find(same) {
        Some(input) => Err(Failure::OutputIsInput { path: input.to_path_buf() }),
        None => Ok(()),
    }
}

/// As [`check_output`], and that the extension names a mesh format that can be written.
///
/// # Errors
///
/// As [`check_output`], or an extension without a writer.
pub(crate) fn check_mesh_output(output: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    if MeshFormat::from_path(output).is_none_or(|format| format == MeshFormat::Gltf) {
        let extension = output.extension().unwrap_or_default().to_string_lossy().into_owned();
        return Err(MeshError::UnknownExtension { extension }.in_file(output).into());
    }
    check_output(output, inputs)
}

/// As [`check_output`], and that the extension names a volume format that can be written.
///
/// # Errors
///
/// As [`check_output`], or an extension without a writer.
pub(crate) fn check_volume_output(output: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    if VolumeFormat::from_path(output).is_none_or(|format| !format.is_written()) {
        let extension = output.extension().unwrap_or_default().to_string_lossy().into_owned();
        return Err(MeshError::UnknownVolumeExtension { extension }.in_file(output).into());
    }
    check_output(output, inputs)
}
