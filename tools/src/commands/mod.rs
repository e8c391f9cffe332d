//! One file per command: its arguments and what it does with them.

mod bench;
mod build;
mod completions;
mod demo;
mod extract;
mod generate;
mod info;
mod measure;
mod verify;

use clap::Subcommand;

use crate::failure::Failure;
use crate::report::Report;

/// What the program can do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Demo(demo::Arguments),
    Generate(generate::Arguments),
    Build(build::Arguments),
    Extract(extract::Arguments),
    Info(info::Arguments),
    Verify(verify::Arguments),
    Measure(measure::Arguments),
    Bench(bench::Arguments),
    Completions(completions::Arguments),
}

impl Command {
    /// Runs the command.
    ///
    /// # Errors
    ///
    /// Whatever stops it; no output file is left half-written.
    pub(crate) fn run(&self) -> Result<Report, Failure> {
        match self {
            Self::Demo(arguments) => demo::run(arguments),
            Self::Generate(arguments) => generate::run(arguments),
            Self::Build(arguments) => build::run(arguments),
            Self::Extract(arguments) => extract::run(arguments),
            Self::Info(arguments) => info::run(arguments),
            Self::Verify(arguments) => verify::run(arguments),
            Self::Measure(arguments) => measure::run(arguments),
            Self::Bench(arguments) => bench::run(arguments),
            Self::Completions(arguments) => Ok(completions::run(arguments)),
        }
    }
}
