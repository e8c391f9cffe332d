//! The program `nephrite`: one mesh in, any level of detail out.
//!
//! Results go to stdout, progress and notes to stderr. Exit status 0 is done, 1 a failure told in one line, 2 wrong
//! usage, 130 an interrupt.

mod arguments;
mod commands;
mod failure;
mod figures;
mod files;
mod interrupt;
mod length;
mod plot;
mod progress;
mod ramp;
mod report;
mod stopwatch;
mod threads;

use std::process::ExitCode;

use clap::Parser;

use crate::arguments::Arguments;
use crate::failure::Failure;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let printed = arguments.command.run().and_then(|report| {
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
