//! What publishing asks of a file system.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::path::Path;

/// The operations by which a file is published: those of [`Disk`], or of a disk that fails where a test wants it to.
pub trait Storage {
    /// An open file.
    type File: Read + Write + Seek;

    /// Creates a file that is not there and marks it as being written for as long as it is open.
    ///
    /// # Errors
    ///
    /// `AlreadyExists`, or what the system says.
    fn create(&self, path: &Path) -> io::Result<Self::File>;

    /// Opens a file for reading.
    ///
    /// # Errors
    ///
    /// What the system says.
    fn open(&self, path: &Path) -> io::Result<Self::File>;

    /// Waits until a file's bytes have reached the disk.
    ///
    /// # Errors
    ///
    /// What the system says.
    fn sync(&self, file: &mut Self::File) -> io::Result<()>;

    /// Gives a file another name, in place of what has that name.
    ///
    /// # Errors
    ///
    /// What the system says; both names are then as they were.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Removes a file.
    ///
    /// # Errors
    ///
    /// What the system says.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Waits until the names in a folder have reached the disk.
    ///
    /// # Errors
    ///
    /// What the system says.
    fn sync_folder(&self, folder: &Path) -> io::Result<()>;

    /// Names in a folder.
    ///
    /// # Errors
    ///
    /// What the system says.
    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>>;

    /// Removes a file unless somebody is writing it.
    ///
    /// # Errors
    ///
    /// What the system says.
    fn remove_if_abandoned(&self, path: &Path) -> io::Result<()>;
}

/// The file system of the machine.
///
/// A file being written is locked (`flock`), a lock that ends with the process however that ends. So a temporary file without
/// a lock belongs to nobody. Systems other than Unix lock out readers too; there nothing is locked and nothing is taken for
/// abandoned.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Storage for Disk {
    type File = File;

    fn create(&self, path: &Path) -> io::Result<File> {
        // With the permissions of any new file, less what the process's mask takes away.
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(path)?;
        if cfg!(unix) && file.lock().is_ok() && path.try_exists().is_ok_and(|is_there| !is_there) {
            // Between creation and lock it was taken for abandoned: the next name will do.
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

    /// Systems other than Unix give no handle to sync a folder by.
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
