//! Files to be read as a whole.

use std::fs::{self, FileType};
use std::io;
use std::path::{Component, Path, PathBuf};

/// The bytes of a file or pipe.
///
/// # Errors
///
/// Those of the system, and [`io::ErrorKind::InvalidInput`] for a device, which may have no end.
pub fn read_input(path: &Path) -> io::Result<Vec<u8>> {
    if is_device(fs::metadata(path)?.file_type()) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "is a device, neither a file nor a pipe"));
    }
    fs::read(path)
}

#[cfg(unix)]
fn is_device(kind: FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    kind.is_char_device() || kind.is_block_device()
}

#[cfg(not(unix))]
fn is_device(_: FileType) -> bool {
    false
}

/// The path that a file writes for another one, if it stays below the folder it starts from.
///
/// # Errors
///
/// Why it is refused, as a clause.
pub(crate) fn path_below(text: &str) -> Result<PathBuf, &'static str> {
    if text.contains(['\\', ':', '\0']) {
        return Err("is not a plain relative path");
    }
    let mut path = PathBuf::new();
    for component in Path::new(text).components() {
        match component {
            Component::Normal(name) => path.push(name),
            Component::CurDir => {}
            Component::ParentDir => return Err("leads out of the folder"),
            Component::RootDir | Component::Prefix(_) => return Err("is an absolute path"),
        }
    }
    if path.as_os_str().is_empty() { Err("is empty") } else { Ok(path) }
}

/// The bytes of a regular file in a folder or below it. Links are followed as far as they stay
/// there: an archive can hold a link to anywhere.
///
/// # Errors
///
/// Why it is not read, as a clause.
pub(crate) fn read_below(folder: Option<&Path>, path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |error: io::Error| format!("cannot be read: {error}");
    let folder = folder.ok_or("needs a folder to be looked for in")?;
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let target = fs::canonicalize(folder.join(path)).map_err(unreadable)?;
    if !target.starts_with(fs::canonicalize(folder).map_err(unreadable)?) {
        return Err("is a link out of the folder".into());
    }
    if !fs::metadata(&target).map_err(unreadable)?.is_file() {
        return Err("is not a regular file".into());
    }
    fs::read(&target).map_err(unreadable)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_end_is_refused() {
        for device in ["/dev/zero", "/dev/null"] {
            assert_eq!(read_input(device.as_ref()).unwrap_err().kind(), io::ErrorKind::InvalidInput);
        }
        let folder = tempfile::tempdir().unwrap();
        assert!(read_input(folder.path()).is_err());
        let path = folder.path().join("a");
        fs::write(&path, b"abc").unwrap();
        assert_eq!(read_input(&path).unwrap(), b"abc");
    }
}
