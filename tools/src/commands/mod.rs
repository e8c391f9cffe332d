//! One file per command: its arguments and what it does with them.

mod bench;
mod build;
mod build_volume;
mod completions;
mod database;
mod demo;
mod extract;
mod generate;
mod info;
mod manifest;
mod measure;
mod plot;
mod verify;
#[cfg(feature = "view")]
mod view;

use clap::Subcommand;

use crate::failure::Failure;
use crate::report::{Form, Report};

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
    Plot(plot::Arguments),
    #[cfg(feature = "view")]
    View(view::Arguments),
    Completions(completions::Arguments),
}

impl Command {
    /// Runs the command. What it has to say at the end it returns; `form` is for what a server must say at its start.
    ///
    /// # Errors
    ///
    /// Whatever stops it; no output file is left half-written.
    pub(crate) fn run(&self, form: Form) -> Result<Report, Failure> {
        match self {
            Self::Demo(arguments) => demo::run(arguments),
            Self::Generate(arguments) => generate::run(arguments),
            Self::Build(arguments) => build::run(arguments),
            Self::Extract(arguments) => extract::run(arguments),
            Self::Info(arguments) => info::run(arguments),
            Self::Verify(arguments) => verify::run(arguments),
            Self::Measure(arguments) => measure::run(arguments),
            Self::Bench(arguments) => bench::run(arguments),
            Self::Plot(arguments) => plot::run(arguments),
            #[cfg(feature = "view")]
            Self::View(arguments) => view::run(arguments, form),
            Self::Completions(arguments) => Ok(completions::run(arguments)),
        }
    }
}
