//! The program `nephrite`: one mesh in, any level of detail out.
//!
//! Results go to stdout, progress and notes to stderr. Exit status 0 is done, 1 a failure told in one line, 2 wrong
//! usage, 130 an interrupt.

mod allocator;
mod arguments;
mod commands;
mod curve;
mod failure;
mod figures;
mod files;
mod interrupt;
mod length;
#[cfg(feature = "view")]
mod page;
mod plot;
mod progress;
mod ramp;
mod report;
#[cfg(feature = "view")]
mod serve;
mod stopwatch;
mod threads;
mod words;

use std::process::ExitCode;

use clap::Parser;

use crate::arguments::Arguments;
use crate::failure::Failure;

fn main() -> ExitCode {
    allocator::return_what_is_freed();
    let arguments = Arguments::parse();
    let printed = arguments.command.run(arguments.form()).and_then(|report| {
        report.print(arguments.form()).map_err(|source| Failure::system("standard output", source))
    });
    match printed {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::note(&failure.line());
            ExitCode::from(failure.status())
        }
    }
}
