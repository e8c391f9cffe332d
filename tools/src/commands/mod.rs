//! The commands, one file or folder each: arguments, and a function from them to a report.

mod bench;
mod build;
mod completions;
mod demo;
mod extract;
mod generate;
mod info;
mod measure;
mod plot;
mod verify;
#[cfg(feature = "view")]
mod view;

use clap::Subcommand;

use crate::failure::Failure;
use crate::report::{Form, Report, Stream};
use crate::streams::Target;

/// The commands.
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
    /// Where to print the result: not among the bytes of a mesh or file that goes to standard
    /// output.
    pub(crate) fn report_stream(&self) -> Stream {
        let target = match self {
            Self::Generate(arguments) => Some(arguments.target()),
            Self::Build(arguments) => arguments.target(),
            Self::Extract(arguments) => Some(arguments.target()),
            Self::Measure(arguments) => arguments.target(),
            Self::Plot(arguments) => Some(arguments.target()),
            _ => None,
        };
        if target == Some(&Target::Stdout) { Stream::Stderr } else { Stream::Stdout }
    }

    /// Runs the command and returns its result. A server prints its result when it starts, in
    /// `form`.
    ///
    /// # Errors
    ///
    /// Whatever stops it. No output file is left half-written.
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
