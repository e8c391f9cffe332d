//! `nephrite completions`: a script that lets a shell complete command lines.

use clap::CommandFactory;
use clap_complete::Shell;
use serde_json::json;

use crate::report::Report;

/// Print a script that lets a shell complete command lines.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Shell that is to run the script
    shell: Shell,
}

pub(crate) fn run(arguments: &Arguments) -> Report {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut crate::Arguments::command(), "nephrite", &mut script);
    let text = String::from_utf8_lossy(&script).into_owned();
    Report { json: json!({ "shell": arguments.shell.to_string(), "script": text }), text }
}
