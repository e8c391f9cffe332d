//! Publishing: a file appears at its path whole and checked, or not at all.

use super::integrity::check_integrity;
use super::{Provenance, StoreOptions, StoreReport, VerifyError, Vertices, WriteError, write_to_with};
use crate::History;
use nephrite_formats::neph::{Directory, MAX_HEAD_BYTES};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use tempfile::NamedTempFile;

/// Writes a file to `path`: to a temporary file beside it, which is synced, read back against its checksums, renamed into
/// place, and the directory synced. At any moment `path` holds what it held before or the whole new file; a map of the old
/// file stays valid.
///
/// # Errors
///
/// [`WriteError`]; the temporary file is removed and `path` is as it was. When only the last sync of the directory fails,
/// the new file is in place and may be lost by a crash of the system.
///
/// ```
/// use nephrite::history::{History, NEVER};
/// use nephrite::store::{Provenance, StoreOptions, write};
/// let mesh = nephrite::TriangleMesh {
///     positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     triangles: vec![[0, 1, 2], [0, 2, 3]],
///     ..Default::default()
/// };
/// let history = History {
///     simplices: vec![[0, 1, 2], [0, 2, 3], [0, 1, 3]],
///     birth: vec![0, 0, 1],
///     death: vec![1, 1, NEVER],
///     vertex_birth: vec![],
///     vertex_death: vec![NEVER, NEVER, 1, NEVER],
///     errors: vec![0.0, 0.5],
///     deviations: vec![],
/// };
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("quad.neph");
/// let report = write(&path, &mesh, &history, &Provenance::default(), &StoreOptions::default())?;
/// assert_eq!(report.n_levels, 2);
/// let lod = nephrite::Lod::open(&path)?;
/// assert_eq!(lod.at_error(0.7).n_triangles(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write<'a, const CORNERS: usize>(
    path: impl AsRef<Path>,
    mesh: impl Into<Vertices<'a>>,
    history: &History<CORNERS>,
    provenance: &Provenance,
    options: &StoreOptions,
) -> Result<StoreReport, WriteError> {
    write_with(path, mesh, history, provenance, options, &[])
}

/// As [`write()`], with an [operation stream](crate::progressive_mesh) as a section of its own; none where it is empty.
///
/// # Errors
///
/// As [`write()`].
pub fn write_with<'a, const CORNERS: usize>(
    path: impl AsRef<Path>,
    mesh: impl Into<Vertices<'a>>,
    history: &History<CORNERS>,
    provenance: &Provenance,
    options: &StoreOptions,
    operations: &[u8],
) -> Result<StoreReport, WriteError> {
    let path = path.as_ref();
    let directory = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let failed = |action, path: &Path| {
        let path = path.to_owned();
        move |source| WriteError::Io { action, path, source }
    };
    let mut temporary = create_beside(directory).map_err(failed("create a file in", directory))?;
    let report = write_to_with(temporary.as_file_mut(), mesh, history, provenance, options, operations)
        .map_err(|error| match error {
            WriteError::Stream(source) => failed("write", path)(source),
            other => other,
        })?;
    temporary.as_file().sync_all().map_err(failed("sync", path))?;
    check_written(temporary.path())
        .map_err(|source| WriteError::Damaged { path: temporary.path().to_owned(), source })?;
    temporary.persist(path).map_err(|error| failed("rename a file to", path)(error.error))?;
    sync_directory(directory).map_err(failed("sync", directory))?;
    Ok(report)
}

/// A temporary file in `directory` with the permissions of an ordinary new file.
fn create_beside(directory: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".nephrite-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Less what the process's mask takes away; temporary files are private otherwise.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
}

/// Reads a file just written: head and all checksums. That what was hashed has the right structure is the writer's promise
/// and its tests'.
fn check_written(path: &Path) -> Result<(), VerifyError> {
    let mut file = File::open(path)?;
    let file_bytes = file.metadata()?.len();
    let mut head = Vec::new();
    (&mut file).take(MAX_HEAD_BYTES as u64).read_to_end(&mut head)?;
    let directory = Directory::read(&head, file_bytes)?;
    check_integrity(&mut file, &directory)
}

/// Makes a rename in `directory` durable.
#[cfg(unix)]
fn sync_directory(directory: &Path) -> io::Result<()> {
    File::open(directory)?.sync_all()
}

/// Other systems give no handle to sync a directory by.
#[cfg(not(unix))]
fn sync_directory(_directory: &Path) -> io::Result<()> {
    Ok(())
}
