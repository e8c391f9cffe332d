//! `nephrite verify`: checks every checksum and every invariant of a file.

use std::num::NonZeroU32;
use std::time::Instant;

use clap::Args;
use nephrite::{ErrorTable, Lod, ReproveError};
use serde_json::json;

use crate::failure::Failure;
use crate::report::Report;
use crate::streams::Source;
use crate::threads::Threads;
use crate::{figures, files, progress};

/// Check every checksum and every invariant of a file; with --bound, prove its errors again.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File that `build` wrote, or - for standard input
    file: Source,

    /// Prove from the file alone that the distance of every level from level 0, in both directions,
    /// is at most its stated error
    #[arg(long)]
    bound: bool,

    /// With --bound: prove N evenly spread levels instead of all
    #[arg(long, value_name = "N", requires = "bound")]
    bound_levels: Option<NonZeroU32>,

    #[command(flatten)]
    threads: Threads,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let start = Instant::now();
    let lod = files::open_lod(&arguments.file)?;
    arguments
        .threads
        .run(|| lod.verify())?
        .map_err(|source| Failure::file(arguments.file.to_string(), source))?;
    let n_proven = if arguments.bound {
        let prove = || prove_errors(&lod, arguments.bound_levels);
        Some(
            arguments
                .threads
                .run(prove)?
                .map_err(|source| Failure::file(arguments.file.to_string(), source))?,
        )
    } else {
        None
    };
    let seconds = start.elapsed();
    let proven =
        n_proven.map_or(String::new(), |n| format!(", the errors of {} proven again", figures::count(n)));
    let simplex = lod.simplex();
    Ok(Report {
        text: format!(
            "{}: valid, {} in {} levels{proven}, {}\n",
            arguments.file,
            figures::simplices(lod.n_lifetimes(), simplex),
            figures::count(lod.n_levels()),
            figures::time(seconds)
        ),
        json: json!({
            "ok": true,
            "levels": lod.n_levels(),
            "levels_proven": n_proven,
            (format!("{simplex}_stored")): lod.n_lifetimes(),
            "file_bytes": lod.file_bytes(),
            "seconds": seconds.as_secs_f64(),
        }),
    })
}

/// Proves the errors of all certified levels, or of `n_wanted` evenly spread ones. Returns their
/// number.
fn prove_errors(lod: &Lod, n_wanted: Option<NonZeroU32>) -> Result<u32, ReproveError> {
    let table = ErrorTable::new(lod)?;
    let last = table.last_certified();
    let n_levels = n_wanted.map_or(last, NonZeroU32::get).min(last);
    let bar = progress::levels(n_levels);
    for i in 1..=n_levels {
        let level = u64::from(last) * u64::from(i) / u64::from(n_levels);
        table.prove(u32::try_from(level).unwrap_or(last))?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(n_levels)
}
