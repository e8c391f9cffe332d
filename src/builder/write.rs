//! Writing what was built: a build states its method, its bound and its counts itself.

use super::{Build, VolumeBuild};
use crate::store::{Bound, Metadata, Method, Source, StoreOptions, StoreReport, WriteError};
use nephrite_formats::publish::{Disk, Storage};
use serde_json::{Value, json};
use std::io::{Seek, Write};
use std::path::Path;

impl Build {
    /// Writes all levels to a file at `path`, with what the build was asked for and what its errors
    /// mean.
    ///
    /// The file is written beside `path`, synced, read back against its checksums, renamed into
    /// place, and the folder synced. At any moment `path` holds what it held before or the whole
    /// new file; a map of the old file stays valid. A link at `path` stays and its target is
    /// replaced. The next write of the same file removes what a killed one has left.
    ///
    /// # Errors
    ///
    /// [`WriteError`]; the temporary file is removed and `path` is as it was. When only the last
    /// sync of the folder fails, the new file is in place and may be lost by a crash of the system.
    ///
    /// ```
    /// use nephrite::{Bound, StoreOptions};
    /// use nephrite::{BuildOptions, Lod, build, generate};
    /// let path = std::env::temp_dir().join("nephrite-torus.neph");
    /// let torus = build(&generate::torus(16, 8), &BuildOptions::default())?;
    /// let report = torus.write(&path, &StoreOptions::default())?;
    /// let lod = Lod::open(&path)?;
    /// assert_eq!(lod.n_levels(), report.n_levels);
    /// assert_eq!(lod.metadata()?.bound, Bound::Certified);
    /// # std::fs::remove_file(path)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn write(&self, path: impl AsRef<Path>, options: &StoreOptions) -> Result<StoreReport, WriteError> {
        self.write_in(&Disk, path.as_ref(), options)
    }

    /// As [`write`](Self::write), on any storage, such as one that fails in a test.
    ///
    /// # Errors
    ///
    /// As [`write`](Self::write).
    pub fn write_in<S: Storage>(
        &self,
        storage: &S,
        path: &Path,
        options: &StoreOptions,
    ) -> Result<StoreReport, WriteError> {
        self.source(options)?.write_in(storage, path, options)
    }

    /// As [`write`](Self::write), to an empty stream.
    ///
    /// # Errors
    ///
    /// [`WriteError`]; what the stream holds then is no file.
    pub fn write_to(
        &self,
        stream: &mut (impl Write + Seek),
        options: &StoreOptions,
    ) -> Result<StoreReport, WriteError> {
        self.source(options)?.write_to(stream, options)
    }

    fn source(&self, options: &StoreOptions) -> Result<Source<'_, 3>, WriteError> {
        let operations = if options.operations { self.operations()?.bytes } else { Vec::new() };
        Ok(Source {
            vertices: self.vertices(),
            history: self.history(),
            metadata: self.metadata(),
            operations,
        })
    }

    fn metadata(&self) -> Metadata {
        Metadata {
            method: self.options.method(),
            bound: self.options.bound(),
            max_error: self.options.max_error,
            n_vertices_in: self.n_vertices_in as u64,
            n_simplices_in: self.n_triangles_in as u64,
            options: self.options.to_json(),
            repairs: json!(self.repairs),
            certified_simplices: self.n_certified_triangles().map(|n| n as u64),
            topology: self.progressive.as_ref().map_or(Value::Null, |report| json!(report.events)),
            ..Metadata::new()
        }
    }
}

impl VolumeBuild {
    /// Writes all levels to a file at `path`, as [`Build::write`] does.
    ///
    /// # Errors
    ///
    /// [`WriteError`]; `path` is as it was.
    pub fn write(&self, path: impl AsRef<Path>, options: &StoreOptions) -> Result<StoreReport, WriteError> {
        self.source().write_in(&Disk, path.as_ref(), options)
    }

    /// As [`write`](Self::write), to an empty stream.
    ///
    /// # Errors
    ///
    /// [`WriteError`]; what the stream holds then is no file.
    pub fn write_to(
        &self,
        stream: &mut (impl Write + Seek),
        options: &StoreOptions,
    ) -> Result<StoreReport, WriteError> {
        self.source().write_to(stream, options)
    }

    fn source(&self) -> Source<'_, 4> {
        let metadata = self.metadata();
        Source { vertices: self.vertices(), history: self.history(), metadata, operations: Vec::new() }
    }

    fn metadata(&self) -> Metadata {
        Metadata {
            method: Method::Fusion,
            bound: Bound::Boundary,
            max_error: self.options.max_error,
            n_vertices_in: self.n_vertices_in as u64,
            n_simplices_in: self.n_tetrahedra_in as u64,
            options: self.options.to_json(),
            repairs: json!(self.repairs),
            ..Metadata::new()
        }
    }
}
