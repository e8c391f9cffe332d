//! Files that appear whole or not at all.
//!
//! Writing in place leaves half a file after a full disk or an interrupt, and has already lost the
//! old one. Here the bytes go to a temporary file in the same folder, are synced to the disk and
//! read again, and get the name of the output by one rename. After a failure the temporary file is
//! removed. A killed process cannot remove it; the next write of the same output does.
//!
//! All operations on the disk go through [`Storage`], so that tests can make each one fail.

mod leftovers;
mod storage;

pub use leftovers::{LEFTOVER_PREFIX, LEFTOVER_SUFFIX};
pub use storage::{Disk, Storage};

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

const BUFFER_BYTES: usize = 256 * 1024;

/// A step of publishing that the system refused.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {}", path.display())]
pub struct PublishError {
    /// What was tried: `create a file in`, `write`, `sync`, `check`, `rename a file to` or
    /// `replace`.
    pub action: &'static str,
    /// The file or folder concerned.
    pub path: PathBuf,
    /// Answer of the operating system.
    pub source: io::Error,
}

/// Lets `write` fill the file `path`, and replaces the old file only after everything is written.
///
/// A link at `path` stays and its target is replaced. A file that is not regular (a pipe,
/// `/dev/stdout`) is written directly, because a rename would destroy it.
///
/// # Errors
///
/// Those of `write` and of the file system. `path` is then as it was.
pub fn publish<T, E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<T, E>,
) -> Result<T, E> {
    if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        let mut writer = BufWriter::with_capacity(BUFFER_BYTES, File::options().write(true).open(path)?);
        let written = write(&mut writer)?;
        writer.flush()?;
        return Ok(written);
    }
    let buffered = |file: &mut File| -> Result<T, Failure<E>> {
        let mut writer = BufWriter::with_capacity(BUFFER_BYTES, file);
        let written = write(&mut writer).map_err(Failure::Caller)?;
        writer.flush().map_err(|error| Failure::Caller(error.into()))?;
        Ok(written)
    };
    publish_in(&Disk, path, buffered, |_, _| Ok(())).map_err(|failure| match failure {
        Failure::Caller(error) => error,
        Failure::System(PublishError { source, .. }) => source.into(),
    })
}

/// Which part of [`publish`] failed.
enum Failure<E> {
    Caller(E),
    System(PublishError),
}

impl<E> From<PublishError> for Failure<E> {
    fn from(error: PublishError) -> Self {
        Self::System(error)
    }
}

/// Lets `write` fill a temporary file beside `path`, syncs it, lets `check` read it again by its
/// path, renames it to `path` and syncs the folder. At any moment `path` holds what it held before
/// or the whole new file.
///
/// A link at `path` stays and its target is replaced. Leftovers of killed writes of the same output
/// are removed first.
///
/// # Errors
///
/// Those of `write` and `check`, and [`PublishError`] for everything else, also if `path` is not a
/// regular file. The temporary file is removed and `path` is as it was. If only the last sync of
/// the folder fails, the new file is in place and may be lost if the system crashes.
pub fn publish_in<S: Storage, T, E: From<PublishError>>(
    storage: &S,
    path: &Path,
    write: impl FnOnce(&mut S::File) -> Result<T, E>,
    check: impl FnOnce(&mut S::File, &Path) -> Result<(), E>,
) -> Result<T, E> {
    let failed = |action, path: &Path| {
        let path = path.to_owned();
        move |source| PublishError { action, path, source }
    };
    let target = target(path).map_err(failed("replace", path))?;
    let folder = folder_of(&target);
    leftovers::remove_abandoned(storage, folder, &target);
    let (mut file, temporary) =
        create_beside(storage, folder, &target).map_err(failed("create a file in", folder))?;
    let written = write(&mut file)?;
    storage.sync(&mut file).map_err(failed("sync", &target))?;
    let mut again = storage.open(&temporary.path).map_err(failed("check", &target))?;
    check(&mut again, &temporary.path)?;
    drop(again);
    storage.rename(&temporary.path, &target).map_err(failed("rename a file to", &target))?;
    temporary.keep();
    storage.sync_folder(folder).map_err(failed("sync", folder))?;
    Ok(written)
}

/// The file that a path names, through links.
fn target(path: &Path) -> io::Result<PathBuf> {
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => fs::canonicalize(path),
        Ok(metadata) if metadata.is_dir() => Err(io::Error::from(io::ErrorKind::IsADirectory)),
        Ok(_) => Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file")),
        Err(_) => Ok(path.to_path_buf()),
    }
}

fn folder_of(target: &Path) -> &Path {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A temporary file that is removed unless it is kept.
struct Temporary<'a, S: Storage> {
    storage: &'a S,
    path: PathBuf,
    is_kept: bool,
}

impl<S: Storage> Temporary<'_, S> {
    fn keep(mut self) {
        self.is_kept = true;
    }
}

impl<S: Storage> Drop for Temporary<'_, S> {
    fn drop(&mut self) {
        if !self.is_kept {
            // There is nobody to report to; a file that stays is like one of a killed process.
            let _ = self.storage.remove(&self.path);
        }
    }
}

/// A new file in `folder`, with a name made from that of its output.
fn create_beside<'a, S: Storage>(
    storage: &'a S,
    folder: &Path,
    target: &Path,
) -> io::Result<(S::File, Temporary<'a, S>)> {
    let prefix = leftovers::prefix(target);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(LEFTOVER_SUFFIX);
    let (file, path) = builder.make_in(folder, |path| storage.create(path))?.into_parts();
    // The guard of `tempfile` would bypass the storage.
    let path = path.keep().map_err(|error| error.error)?;
    Ok((file, Temporary { storage, path, is_kept: false }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.ply");
        publish::<_, io::Error>(&path, |out| out.write_all(b"old")).unwrap();
        let failed = publish::<(), io::Error>(&path, |out| {
            out.write_all(&[0; 1 << 20])?;
            Err(io::Error::other("full"))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["mesh.ply"]);
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(publish::<_, io::Error>(&folder.path().join("none/mesh.ply"), |_| Ok(())).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_and_devices_are_written_to() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        publish::<_, io::Error>(&link, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().file_type().is_symlink());
        publish::<_, io::Error>(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_never_replaced() {
        let write = |_: &mut File| -> Result<(), PublishError> { Ok(()) };
        let error = publish_in(&Disk, Path::new("/dev/null"), write, |_, _| Ok(())).unwrap_err();
        assert_eq!((error.action, error.source.kind()), ("replace", io::ErrorKind::InvalidInput));
    }

    #[cfg(unix)]
    #[test]
    fn leftovers_of_the_same_output_are_removed_and_those_in_use_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.ply");
        let leftover = |of: &str, middle: &str| {
            let name = leftovers::prefix(&folder.path().join(of)).to_string_lossy().into_owned();
            folder.path().join(name + middle + LEFTOVER_SUFFIX)
        };
        let (abandoned, others) = (leftover("mesh.ply", "abc"), leftover("other.ply", "abc"));
        fs::write(&abandoned, b"half a").unwrap();
        fs::write(&others, b"half a").unwrap();
        let in_use = leftover("mesh.ply", "def");
        let writer = Disk.create(&in_use).unwrap();
        publish::<_, io::Error>(&path, |out| out.write_all(b"whole")).unwrap();
        assert!(!abandoned.exists() && others.exists() && in_use.exists());
        drop(writer);
        publish::<_, io::Error>(&path, |out| out.write_all(b"whole")).unwrap();
        assert!(!in_use.exists() && others.exists());
    }
}
