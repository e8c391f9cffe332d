//! The command line as a whole; each command's own arguments stand beside it in [`crate::commands`].

use clap::Parser;

use crate::commands::Command;
use crate::report::Form;

const EXAMPLE: &str = "\
Example:
  nephrite build bunny.ply -o bunny.neph
  nephrite extract bunny.neph --error 0.2% -o lod.ply";

/// Every level of detail of a mesh, each with an error bound, from one file.
///
/// Lengths are in the mesh's own units; with a trailing % they are in percent of its bounding box diagonal.
#[derive(Debug, Parser)]
#[command(name = "nephrite", version, max_term_width = 100, after_help = EXAMPLE)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// Print the result as one JSON object
    #[arg(long, global = true)]
    json: bool,
}

impl Arguments {
    /// Form in which to print the result.
    pub(crate) fn form(&self) -> Form {
        if self.json { Form::Json } else { Form::Text }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn arguments_are_consistent() {
        Arguments::command().debug_assert();
    }
}
