//! Paths that a command is given, checked before hours of work.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use nephrite::{Lod, OpenError};
use nephrite_formats::neph::{Directory, MAGIC, MAX_HEAD_BYTES};

use crate::failure::Failure;
use crate::meshes;
use crate::report;
use crate::streams::{Source, Target};

/// Opens a file that `build` wrote. The file is read and not mapped, as others may change it
/// meanwhile.
///
/// # Errors
///
/// [`Failure::NotBuilt`] for a mesh, and those of the system and of a damaged head.
pub(crate) fn open_lod(source: &Source) -> Result<Lod, Failure> {
    match source {
        Source::Stdin => {
            let failed = |error| Failure::system("standard input", error);
            let bytes = source.read().map_err(failed)?;
            Lod::from_bytes(&bytes).map_err(|error| Failure::file(source.to_string(), error))
        }
        Source::File(path) => open_file(path),
    }
}

/// As [`open_lod`], for a path.
///
/// # Errors
///
/// As [`open_lod`].
pub(crate) fn open_file(path: &Path) -> Result<Lod, Failure> {
    Lod::open(path).map_err(|error| not_built(path, error))
}

/// A mesh is told as such, anything else by what is wrong with it.
fn not_built(path: &Path, error: OpenError) -> Failure {
    let is_refused = matches!(error, OpenError::Format(_));
    if is_refused && !starts_with_magic(path) && meshes::looks_like_mesh(path).is_some() {
        return Failure::NotBuilt { path: path.to_owned() };
    }
    Failure::file(path, error)
}

fn starts_with_magic(path: &Path) -> bool {
    let mut start = [0; MAGIC.len()];
    fs::File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == MAGIC
}

/// Checks that a file is one that `build` wrote, whole by its length. Reads its head only.
///
/// # Errors
///
/// As [`open_lod`].
pub(crate) fn check_head(path: &Path) -> Result<(), Failure> {
    let failed = |error: io::Error| Failure::file(path, error);
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(failed(io::Error::other("is not a file")));
    }
    let mut head = Vec::new();
    let file = fs::File::open(path).map_err(failed)?;
    file.take(MAX_HEAD_BYTES as u64).read_to_end(&mut head).map_err(failed)?;
    Directory::read(&head, metadata.len()).map(drop).map_err(|error| not_built(path, error.into()))
}

/// Checks that a file can be put where `target` says and that it is none of the `inputs`.
///
/// # Errors
///
/// A folder that is missing, a folder in the file's place, or an output that would replace an
/// input.
pub(crate) fn check_target(target: &Target, inputs: &[&Path]) -> Result<(), Failure> {
    target.path().map_or(Ok(()), |path| check_output(path, inputs))
}

/// As [`check_target`], for a file.
///
/// # Errors
///
/// As [`check_target`].
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

/// Refuses a picture under a name that says it is something else than SVG.
///
/// # Errors
///
/// [`Failure::Usage`].
pub(crate) fn check_is_svg(target: &Target) -> Result<(), Failure> {
    let extension = target.path().and_then(Path::extension);
    match extension.filter(|extension| !extension.eq_ignore_ascii_case("svg")) {
        Some(_) => Err(Failure::usage(format!("{target} must end in .svg: the picture is an SVG"))),
        None => Ok(()),
    }
}

/// Prints on standard error what a reader or writer left out or changed.
pub(crate) fn tell(name: &str, notes: &[String]) {
    for note in notes {
        report::note(&format!("{name}: {note}"));
    }
}
