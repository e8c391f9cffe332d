//! Publishing: a file appears at its path whole and checked, or not at all.

use super::integrity::check_integrity;
use super::{Provenance, StoreOptions, StoreReport, VerifyError, Vertices, WriteError, write_to_with};
use crate::History;
use nephrite_formats::neph::{Directory, MAX_HEAD_BYTES};
use nephrite_formats::publish::{Disk, Storage, publish_in};
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Writes a file to `path`: to a temporary file beside it, which is synced, read back against its checksums, renamed into
/// place, and the folder synced. At any moment `path` holds what it held before or the whole new file; a map of the old
/// file stays valid. A link at `path` stays and its target is replaced. What a killed write of the same file has left is
/// removed.
///
/// # Errors
///
/// [`WriteError`]; the temporary file is removed and `path` is as it was. When only the last sync of the folder fails,
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
/// assert_eq!(lod.at_error(0.7).n_simplices(), 1);
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
    write_in(&Disk, path.as_ref(), |file| write_to_with(file, mesh, history, provenance, options, operations))
}

/// What [`write()`] does, on any [`Storage`], with what `write` puts into the temporary file, such as
/// [`write_to`](super::write_to). The tests come in here with a disk that fails.
///
/// # Errors
///
/// As [`write()`].
pub fn write_in<S: Storage, T>(
    storage: &S,
    path: &Path,
    write: impl FnOnce(&mut S::File) -> Result<T, WriteError>,
) -> Result<T, WriteError> {
    let write = |file: &mut S::File| {
        write(file).map_err(|error| match error {
            WriteError::Stream(source) => WriteError::Io { action: "write", path: path.to_owned(), source },
            other => other,
        })
    };
    let check = |file: &mut S::File, temporary: &Path| {
        let damaged = |source| WriteError::Damaged { path: temporary.to_owned(), source };
        check_written(file).map_err(damaged)
    };
    publish_in(storage, path, write, check)
}

/// Reads a file just written: head and all checksums. That what was hashed has the right structure is the writer's promise
/// and its tests'.
fn check_written(file: &mut (impl Read + Seek)) -> Result<(), VerifyError> {
    let file_bytes = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(0))?;
    let mut head = Vec::new();
    file.by_ref().take(MAX_HEAD_BYTES as u64).read_to_end(&mut head)?;
    let directory = Directory::read(&head, file_bytes)?;
    check_integrity(file, &directory)
}
