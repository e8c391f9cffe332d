//! `nephrite verify`: every checksum and every invariant of a file.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use serde_json::json;

use crate::failure::Failure;
use crate::report::Report;
use crate::threads::Threads;
use crate::{figures, files};

/// Check every checksum and every invariant of a file.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File that `build` wrote
    file: PathBuf,

    #[command(flatten)]
    threads: Threads,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let start = Instant::now();
    let lod = files::open_lod(&arguments.file)?;
    arguments.threads.run(|| lod.verify())?.map_err(|source| Failure::file(&arguments.file, source))?;
    let seconds = start.elapsed();
    Ok(Report {
        text: format!(
            "{}: in order, {} triangles in {} levels, {}\n",
            arguments.file.display(),
            figures::count(lod.n_lifetimes()),
            figures::count(lod.n_levels()),
            figures::time(seconds)
        ),
        json: json!({
            "ok": true,
            "levels": lod.n_levels(),
            "triangles_stored": lod.n_lifetimes(),
            "file_bytes": lod.file_bytes(),
            "seconds": seconds.as_secs_f64(),
        }),
    })
}
