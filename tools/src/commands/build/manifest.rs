//! The manifest of a database: a file of JSON lines, one for each part. It grows while parts are
//! built and is put in order at the end.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use crate::failure::Failure;

/// Name of the manifest in the folder of the database.
const MANIFEST: &str = "manifest.jsonl";

/// What decides whether a part must be built again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Facts {
    /// File made of the part.
    pub(super) output: String,
    /// Checksum of the bytes of the part.
    pub(super) content: String,
    /// Checksum of the options.
    pub(super) options: String,
}

/// A line of the manifest: its place and the few values that are needed. Its long text stays in the
/// file.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// `None` for a part that failed.
    pub(super) facts: Option<Facts>,
    pub(super) file_bytes: Option<u64>,
    pub(super) n_triangles: u64,
    pub(super) n_tetrahedra: u64,
    pub(super) is_failed: bool,
    /// True if an earlier run wrote the line.
    pub(super) is_unchanged: bool,
    start: u64,
    len: usize,
}

impl Line {
    fn new(value: &Value, start: u64, len: usize) -> Self {
        let text = |key: &str| Some(value[key].as_str()?.to_owned());
        let facts =
            || Some(Facts { output: text("output")?, content: text("content")?, options: text("options")? });
        Self {
            facts: facts(),
            file_bytes: value["file_bytes"].as_u64(),
            n_triangles: value["triangles_in"].as_u64().unwrap_or(0),
            n_tetrahedra: value["tetrahedra_in"].as_u64().unwrap_or(0),
            is_failed: !value["reason"].is_null(),
            is_unchanged: false,
            start,
            len,
        }
    }
}

/// The manifest while it grows.
pub(super) struct Manifest {
    path: PathBuf,
    /// The file and its length.
    file: Mutex<(File, u64)>,
}

impl Manifest {
    /// Opens the manifest of a folder. Returns it with the last line of each part from earlier
    /// runs. Lines behind one that is cut off are left out. The file is locked where locks are
    /// known to work, as two builds of one database would mix their lines.
    ///
    /// # Errors
    ///
    /// The file cannot be read or written, another process writes it, or it does not begin with a
    /// line of a manifest.
    pub(super) fn open(folder: &Path) -> Result<(Self, BTreeMap<PathBuf, Line>), Failure> {
        let path = folder.join(MANIFEST);
        let opened = open(&path).map_err(|source| Failure::file(&path, source))?;
        let (file, len, known) = opened;
        Ok((Self { path, file: Mutex::new((file, len)) }, known))
    }

    /// Adds a line at once. If that fails, the part is built again next time.
    pub(super) fn append(&self, value: &Value) -> Line {
        let text = format!("{value}\n");
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let start = file.1;
        // One write per line, so that lines of several threads never mix.
        if file.0.write_all(text.as_bytes()).is_err() {
            // What of it is there would spoil the next line.
            let _ = file.0.set_len(start).and_then(|()| file.0.seek(SeekFrom::Start(start)));
            return Line::new(value, start, 0);
        }
        file.1 = start + text.len() as u64;
        Line::new(value, start, text.len())
    }

    /// Replaces the manifest by these lines, in their order.
    ///
    /// # Errors
    ///
    /// The manifest cannot be read or replaced.
    pub(super) fn replace(self, lines: &[Line]) -> Result<(), Failure> {
        let (mut file, _) = self.file.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut text = Vec::new();
        let replaced = nephrite_formats::publish(&self.path, |out| {
            lines.iter().try_for_each(|line| {
                text.resize(line.len, 0);
                file.seek(SeekFrom::Start(line.start))?;
                file.read_exact(&mut text)?;
                out.write_all(&text)
            })
        });
        replaced.map_err(|source| Failure::file(&self.path, source))
    }
}

/// The file at its end, its length, and what it holds.
fn open(path: &Path) -> io::Result<(File, u64, BTreeMap<PathBuf, Line>)> {
    // A link would have another file cut, wherever that is.
    if fs::symlink_metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        return Err(io::Error::new(ErrorKind::InvalidInput, "is not a regular file"));
    }
    let mut file = File::options().create(true).truncate(false).read(true).write(true).open(path)?;
    if cfg!(unix) && matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
        return Err(io::Error::new(ErrorKind::WouldBlock, "is being written by another build"));
    }
    let mut known = BTreeMap::new();
    let (mut start, mut text) = (0_u64, Vec::new());
    let mut reader = BufReader::new(&file);
    while reader.read_until(b'\n', &mut text)? > 0 {
        if let (Ok(value), Some(b'\n')) = (serde_json::from_slice::<Value>(&text), text.last()) {
            if let Some(part) = value["part"].as_str() {
                let line = Line { is_unchanged: true, ..Line::new(&value, start, text.len()) };
                known.insert(PathBuf::from(part), line);
            }
        } else if start == 0 && !text.starts_with(b"{") {
            return Err(io::Error::new(ErrorKind::InvalidData, "is not the manifest of a database"));
        } else {
            break;
        }
        start += text.len() as u64;
        text.clear();
    }
    // Behind the last whole line may be the beginning of one whose run was stopped.
    file.seek(SeekFrom::Start(start))?;
    file.set_len(start)?;
    Ok((file, start, known))
}
