//! Publishing: a file appears at its path whole and checked, or not at all.

use super::integrity::check_integrity;
use super::{Metadata, Source, StoreOptions, StoreReport, VerifyError, Vertices, WriteError};
use crate::History;
use nephrite_formats::neph::{Directory, MAX_HEAD_BYTES};
use nephrite_formats::publish::{Disk, Storage, publish_in};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

impl<const CORNERS: usize> Source<'_, CORNERS> {
    /// Writes a file to `path`: to a temporary file beside it, which is synced, read back against
    /// its checksums, renamed into place, and the folder synced. At any moment `path` holds what it
    /// held before or the whole new file; a map of the old file stays valid. A link at `path` stays
    /// and its target is replaced. The next write of the same file removes what a killed one has
    /// left.
    ///
    /// # Errors
    ///
    /// [`WriteError`]; the temporary file is removed and `path` is as it was. When only the last
    /// sync of the folder fails, the new file is in place and may be lost by a crash of the system.
    pub(crate) fn write_in<S: Storage>(
        &self,
        storage: &S,
        path: &Path,
        options: &StoreOptions,
    ) -> Result<StoreReport, WriteError> {
        let write = |file: &mut S::File| {
            self.write_to(file, options).map_err(|error| match error {
                WriteError::Stream(source) => {
                    WriteError::Io { action: "write", path: path.to_owned(), source }
                }
                other => other,
            })
        };
        let check = |file: &mut S::File, temporary: &Path| {
            let damaged = |source| WriteError::Damaged { path: temporary.to_owned(), source };
            check_written(file).map_err(damaged)
        };
        publish_in(storage, path, write, check)
    }
}

impl<const CORNERS: usize> History<CORNERS> {
    /// Writes a history that no build of this crate has made. The file states
    /// [`Method::Other`](crate::Method::Other) and [`Bound::Unstated`](crate::Bound::Unstated): the
    /// caller knows what its errors mean.
    ///
    /// The file appears at `path` whole or not at all, see [`Build::write`](crate::Build::write).
    ///
    /// # Errors
    ///
    /// [`WriteError`]; `path` is as it was.
    ///
    /// ```
    /// use nephrite::{History, NEVER};
    /// use nephrite::StoreOptions;
    /// let mesh = nephrite::TriangleMesh {
    ///     positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
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
    /// let path = std::env::temp_dir().join("nephrite-quad.neph");
    /// let report = history.write(&path, &mesh, &StoreOptions::default())?;
    /// assert_eq!(report.n_levels, 2);
    /// let lod = nephrite::Lod::open(&path)?;
    /// assert_eq!(lod.at_error(0.7).n_simplices(), 1);
    /// # std::fs::remove_file(path)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn write<'a>(
        &'a self,
        path: impl AsRef<Path>,
        vertices: impl Into<Vertices<'a>>,
        options: &StoreOptions,
    ) -> Result<StoreReport, WriteError> {
        self.unstated(vertices).write_in(&Disk, path.as_ref(), options)
    }

    /// As [`write`](Self::write), to an empty stream.
    ///
    /// # Errors
    ///
    /// [`WriteError`]; what the stream holds then is no file.
    pub fn write_to<'a>(
        &'a self,
        stream: &mut (impl Write + Seek),
        vertices: impl Into<Vertices<'a>>,
        options: &StoreOptions,
    ) -> Result<StoreReport, WriteError> {
        self.unstated(vertices).write_to(stream, options)
    }

    fn unstated<'a>(&'a self, vertices: impl Into<Vertices<'a>>) -> Source<'a, CORNERS> {
        let (vertices, metadata) = (vertices.into(), Metadata::new());
        Source { vertices, history: self, metadata, operations: Vec::new() }
    }
}

/// Reads a file just written: head and all checksums. That what was hashed has the right structure
/// is the writer's promise and its tests'.
fn check_written(file: &mut (impl Read + Seek)) -> Result<(), VerifyError> {
    let file_bytes = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(0))?;
    let mut head = Vec::new();
    file.by_ref().take(MAX_HEAD_BYTES as u64).read_to_end(&mut head)?;
    let directory = Directory::read(&head, file_bytes)?;
    check_integrity(file, &directory)
}
