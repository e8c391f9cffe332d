//! The operations of a file system that publishing uses.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::path::Path;

/// The operations that publish a file: those of [`Disk`], or of a disk that fails where a test
/// wants it to.
pub trait Storage {
    /// An open file.
    type File: Read + Write + Seek;

    /// Creates a file that does not exist yet, and marks it as being written while it is open.
    ///
    /// # Errors
    ///
    /// `AlreadyExists`, or the error of the system.
    fn create(&self, path: &Path) -> io::Result<Self::File>;

    /// Opens a file for reading.
    ///
    /// # Errors
    ///
    /// The error of the system.
    fn open(&self, path: &Path) -> io::Result<Self::File>;

    /// Waits until the bytes of a file have reached the disk.
    ///
    /// # Errors
    ///
    /// The error of the system.
    fn sync(&self, file: &mut Self::File) -> io::Result<()>;

    /// Renames a file and replaces a file that has the new name.
    ///
    /// # Errors
    ///
    /// The error of the system; both names are then as they were.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Removes a file.
    ///
    /// # Errors
    ///
    /// The error of the system.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Waits until the names in a folder have reached the disk.
    ///
    /// # Errors
    ///
    /// The error of the system.
    fn sync_folder(&self, folder: &Path) -> io::Result<()>;

    /// Names in a folder.
    ///
    /// # Errors
    ///
    /// The error of the system.
    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>>;

    /// Removes a file unless a process is writing it.
    ///
    /// # Errors
    ///
    /// The error of the system.
    fn remove_if_abandoned(&self, path: &Path) -> io::Result<()>;
}

/// The file system of the machine.
///
/// A file being written is locked (`flock`). The lock ends with the process, however that ends, so
/// a temporary file without a lock was abandoned. Systems other than Unix would lock out readers
/// too; there no file is locked and none counts as abandoned.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Storage for Disk {
    type File = File;

    fn create(&self, path: &Path) -> io::Result<File> {
        // With the permissions of any new file, minus the umask of the process.
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(path)?;
        if cfg!(unix) && file.lock().is_ok() && path.try_exists().is_ok_and(|is_there| !is_there) {
            // Between creation and lock another process took it for abandoned; try the next name.
            return Err(io::Error::from(io::ErrorKind::AlreadyExists));
        }
        Ok(file)
    }

    fn open(&self, path: &Path) -> io::Result<File> {
        File::open(path)
    }

    fn sync(&self, file: &mut File) -> io::Result<()> {
        file.sync_all()
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        fs::remove_file(path)
    }

    /// Systems other than Unix give no handle with which to sync a folder.
    fn sync_folder(&self, folder: &Path) -> io::Result<()> {
        if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
    }

    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>> {
        fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.file_name())).collect()
    }

    fn remove_if_abandoned(&self, path: &Path) -> io::Result<()> {
        if cfg!(not(unix)) || !fs::symlink_metadata(path)?.is_file() {
            return Ok(());
        }
        let file = File::open(path)?;
        match file.try_lock() {
            Ok(()) => fs::remove_file(path),
            Err(_) => Ok(()),
        }
    }
}
