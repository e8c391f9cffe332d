//! `nephrite build`: a mesh in, a file with every level of detail out.

mod arguments;
mod database;
mod decimate;
mod facts;
mod job;
mod manifest;
mod parts;
mod scope;
mod surface;
mod volume;

use std::path::{Path, PathBuf};

use nephrite_formats::VolumeFormat;

pub(crate) use self::arguments::Arguments;
use self::job::{Job, Watch};
use self::scope::InputKind;
use crate::failure::Failure;
use crate::meshes::{self, Read};
use crate::report::Report;
use crate::streams::{Source, Target};
use crate::{files, interrupt};

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    interrupt::listen();
    if let Some(folder) = &arguments.output_dir {
        return arguments.threads.run(|| database::run(arguments, folder))?;
    }
    // clap asks for one of the two.
    let Some(target) = &arguments.output else { return Err(Failure::usage("no output is named")) };
    check(arguments, target)?;
    arguments.threads.run(|| {
        let job = Job { arguments, name: arguments.mesh.to_string(), target, watch: Watch::Bar };
        let read = read(arguments)?;
        scope::check(arguments, &[InputKind::of(read.report.format)])?;
        decimate::run(&job, read)
    })?
}

/// Refuses, before anything is read, what cannot be honoured or would replace an input.
fn check(arguments: &Arguments, target: &Target) -> Result<(), Failure> {
    if let Some(second) = arguments.more.first() {
        let message = format!("{}: several meshes need --output-dir, not -o", second.display());
        return Err(Failure::usage(message));
    }
    let inputs = inputs(arguments);
    files::check_target(target, &inputs.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    let format = target.path().and_then(meshes::format_of_name);
    if let Some(format) = format.filter(|&format| InputKind::of(format) != InputKind::Plot3d) {
        let message = format!("-o {target}: the file holds levels and is no {format}, name it OUT.neph");
        return Err(Failure::usage(message));
    }
    let named = arguments.mesh.path().and_then(meshes::format_of_name);
    match arguments.input_format.or(named) {
        Some(format) => scope::check(arguments, &[InputKind::of(format)]),
        None => scope::check(arguments, &InputKind::ALL),
    }
}

/// All files that are read: the mesh, the other file of TetGen, solutions.
fn inputs(arguments: &Arguments) -> Vec<PathBuf> {
    let mesh = arguments.mesh.path().map(Path::to_owned);
    let is_in_two = |path: &&PathBuf| VolumeFormat::from_path(path) == Some(VolumeFormat::Tetgen);
    let two = mesh.iter().filter(is_in_two);
    let two = two.flat_map(|path| ["ele", "node"].map(|extension| path.with_extension(extension)));
    two.chain(mesh.clone()).chain(arguments.fusion.solution.iter().cloned()).collect()
}

fn read(arguments: &Arguments) -> Result<Read, Failure> {
    let read = match (&arguments.mesh, arguments.fusion.solution.as_slice()) {
        (source, []) => meshes::read(source, arguments.input_format)?,
        (Source::File(path), solutions) => nephrite_formats::read_plot3d(path, solutions)?.into(),
        (Source::Stdin, _) => return Err(Failure::usage("--solution needs a grid in a file")),
    };
    interrupt::check()?;
    Ok(read)
}
