//! The program `nephrite`: builds files of all levels of detail of a mesh, and uses them.
//!
//! Results go to standard output, progress and notes to standard error. Exit status: 0 success, 1 a
//! failure with one line that says why, 2 wrong usage, 130 an interrupt.

mod allocator;
mod arguments;
mod commands;
mod curve;
mod failure;
mod figures;
mod files;
mod interrupt;
mod length;
mod meshes;
#[cfg(feature = "view")]
mod page;
mod panics;
mod plot;
mod progress;
mod ramp;
mod report;
#[cfg(feature = "view")]
mod serve;
mod stopwatch;
mod streams;
mod threads;
mod words;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};

use crate::arguments::Arguments;
use crate::failure::Failure;

fn main() -> ExitCode {
    allocator::return_what_is_freed();
    panics::note_silently();
    let matches = Arguments::command().get_matches();
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    let done = panics::catch(|| {
        let report = arguments.command.run(arguments.form())?;
        let stream = arguments.command.report_stream();
        let printed = report.print(arguments.form(), stream);
        printed.map_err(|source| Failure::system(stream.name(), source))
    });
    let Err(failure) = done else { return ExitCode::SUCCESS };
    match &failure {
        Failure::Usage { message } => arguments::print_wrong_usage(&matches, message),
        failure => report::note(&failure.line()),
    }
    ExitCode::from(failure.status())
}
