//! The command line; the arguments of each command are in its file in [`crate::commands`].

use clap::error::ErrorKind;
use clap::{ArgMatches, CommandFactory, Parser};

use crate::commands::Command;
use crate::report::{self, Form};

const EXAMPLE: &str = "\
Example:
  nephrite build bunny.ply -o bunny.neph
  nephrite extract bunny.neph --error 0.2% -o lod.ply";

/// Build one file that holds every level of detail of a mesh, each with a bounded error, and use
/// it.
///
/// Lengths are in the units of the mesh; with a trailing % they are in percent of its bounding box
/// diagonal. A mesh or file named - is standard input or output.
#[derive(Debug, Parser)]
#[command(name = "nephrite", version, max_term_width = 100, after_help = EXAMPLE)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// Print the result as one JSON object
    #[arg(long, global = true)]
    json: bool,
}

/// Prints on standard error that the arguments of a command are wrong, in the form of clap: the
/// message, the usage of the command, and where to find help.
pub(crate) fn print_wrong_usage(matches: &ArgMatches, message: &str) {
    let mut command = Arguments::command();
    command.build();
    let mut matches = matches;
    while let Some((name, inner)) = matches.subcommand() {
        matches = inner;
        command = match command.find_subcommand(name) {
            Some(found) => found.clone(),
            None => break,
        };
    }
    // A line that nobody can read is not worth failing for.
    let _ = command.error(ErrorKind::ArgumentConflict, report::printable(message)).print();
}

impl Arguments {
    /// Form in which to print the result.
    pub(crate) fn form(&self) -> Form {
        if self.json { Form::Json } else { Form::Text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_consistent() {
        Arguments::command().debug_assert();
    }
}
