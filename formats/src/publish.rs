//! Files that appear whole or not at all.
//!
//! Writing in place leaves half a file after a full disk or an interrupt, and has already lost the old one. Here the bytes go
//! to a temporary file in the same folder, reach the disk, and take the name by one rename; a failure removes them.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

const BUFFER_BYTES: usize = 256 * 1024;

/// Lets `write` fill the file `path`, replacing what was there only once everything is written.
///
/// A link at `path` stays and its target is replaced. What is not a regular file (a pipe, `/dev/stdout`) is written directly,
/// as renaming over it would destroy it.
///
/// # Errors
///
/// Those of `write` and of the file system. `path` is then as it was.
pub fn publish<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), E>,
) -> Result<(), E> {
    let existing = fs::metadata(path);
    if existing.as_ref().is_ok_and(|metadata| !metadata.is_file()) {
        let mut writer = BufWriter::with_capacity(BUFFER_BYTES, File::options().write(true).open(path)?);
        write(&mut writer)?;
        return Ok(writer.flush()?);
    }
    let target = if existing.is_ok() { fs::canonicalize(path)? } else { path.to_path_buf() };
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut temporary = new_file().tempfile_in(folder)?;
    let mut writer = BufWriter::with_capacity(BUFFER_BYTES, temporary.as_file_mut());
    write(&mut writer)?;
    writer.flush()?;
    drop(writer);
    temporary.as_file().sync_all()?;
    temporary.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

/// A temporary file that, once renamed, has the permissions of any other new file.
fn new_file() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".nephrite-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
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
        publish::<io::Error>(&path, |out| out.write_all(b"old")).unwrap();
        let failed = publish::<io::Error>(&path, |out| {
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
        assert!(publish::<io::Error>(&folder.path().join("none/mesh.ply"), |_| Ok(())).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_and_devices_are_written_to() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        publish::<io::Error>(&link, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().file_type().is_symlink());
        publish::<io::Error>(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
    }
}
