//! Files to be read as a whole.

use std::fs::{self, FileType};
use std::io;
use std::path::Path;

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
