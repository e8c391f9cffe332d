//! One mesh that is built: alone or as a part of a database.

use std::io::{Cursor, Write};

use nephrite::{Build, StoreReport, VolumeBuild, WriteError};

use super::arguments::Arguments;
use crate::failure::Failure;
use crate::progress::BuildBar;
use crate::streams::Target;

/// One mesh to build.
pub(super) struct Job<'a> {
    pub(super) arguments: &'a Arguments,
    /// Name of the mesh in messages.
    pub(super) name: String,
    /// Where the file goes.
    pub(super) target: &'a Target,
    pub(super) watch: Watch,
}

/// Who watches a build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Watch {
    /// A person, by a progress bar.
    Bar,
    /// Nobody: parts are built side by side.
    Nobody,
}

/// What is written: the result of one of the decimators.
pub(super) enum Built<'a> {
    Surface(&'a Build),
    Volume(&'a VolumeBuild),
}

impl Job<'_> {
    /// A failure that concerns the mesh.
    pub(super) fn failed(&self, source: impl std::error::Error + Send + Sync + 'static) -> Failure {
        Failure::file(&self.name, source)
    }

    /// What shows the progress of the build and carries an interrupt to it.
    pub(super) fn bar(&self, bounding_diagonal: f64) -> BuildBar {
        match self.watch {
            Watch::Bar => BuildBar::new(bounding_diagonal),
            Watch::Nobody => BuildBar::hidden(bounding_diagonal),
        }
    }

    /// Writes the file. Standard output cannot be written twice in one place, as the head of the
    /// file is: for it the file is made in memory.
    pub(super) fn write(&self, built: &Built<'_>) -> Result<StoreReport, Failure> {
        let failed = |error: WriteError| Failure::file(self.target.to_string(), error);
        let options = self.arguments.stored();
        let Some(path) = self.target.path() else {
            let mut stream = Cursor::new(Vec::new());
            let stored = match built {
                Built::Surface(build) => build.write_to(&mut stream, &options),
                Built::Volume(build) => build.write_to(&mut stream, &options),
            };
            let stored = stored.map_err(failed)?;
            let written = self.target.publish(|out: &mut dyn Write| out.write_all(stream.get_ref()));
            written.map_err(|error: std::io::Error| Failure::file(self.target.to_string(), error))?;
            return Ok(stored);
        };
        let stored = match built {
            Built::Surface(build) => build.write(path, &options),
            Built::Volume(build) => build.write(path, &options),
        };
        stored.map_err(failed)
    }
}
