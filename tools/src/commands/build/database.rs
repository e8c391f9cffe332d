//! `nephrite build MESHES... --output-dir DB`: a database of parts, each with all of its levels.
//!
//! Parts are built side by side, one thread each. `manifest.jsonl` gets a line as soon as a part is
//! done, so that a run that was stopped goes on where it was. A part is skipped while its bytes,
//! the options and the file made of it are what its line says. A part that cannot be read or built,
//! or whose build panics, is listed with the reason, and the others go on. Of a part that is done
//! only the place of its line stays in memory.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use nephrite_formats::{FileFormat, MeshFormat, neph, read_input};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::arguments::Arguments;
use super::decimate;
use super::job::{Job, Watch};
use super::manifest::{Facts, Line, Manifest};
use super::parts::Parts;
use super::scope::{self, InputKind};
use crate::failure::Failure;
use crate::meshes::{self, Read};
use crate::report::{self, Report};
use crate::streams::{Source, Target};
use crate::{figures, files, interrupt, panics};

/// Points of the curve of a part that its line keeps.
const MAX_CURVE_POINTS: usize = 32;

/// Builds every part that is new or has changed.
pub(super) fn run(arguments: &Arguments, folder: &Path) -> Result<Report, Failure> {
    let start = Instant::now();
    let listed = Parts::list(named(arguments)?.into_iter(), folder)?;
    let kinds: Vec<InputKind> = listed.parts.iter().flat_map(|(part, _)| possible_kinds(part)).collect();
    scope::check(arguments, &kinds)?;
    fs::create_dir_all(folder).map_err(|source| Failure::file(folder, source))?;
    let (manifest, known) = Manifest::open(folder)?;
    let lines: Vec<Line> = listed
        .parts
        .par_iter()
        .filter(|_| !interrupt::is_requested())
        .filter_map(|(part, output)| {
            build_part(arguments, part, &folder.join(output), known.get(part), &manifest)
        })
        .collect();
    let n_failed = lines.iter().filter(|line| line.is_failed).count();
    if interrupt::is_requested() {
        let n_done = lines.len() - n_failed;
        let n_parts = listed.parts.len();
        return Err(Failure::InterruptedParts { folder: folder.to_owned(), n_done, n_parts });
    }
    manifest.replace(&lines)?;
    if n_failed > 0 {
        return Err(Failure::Parts { folder: folder.to_owned(), n_failed, n_parts: lines.len() });
    }
    Ok(report(folder, &lines, &listed, start))
}

/// All paths that were named.
fn named(arguments: &Arguments) -> Result<Vec<&PathBuf>, Failure> {
    let Source::File(first) = &arguments.mesh else {
        return Err(Failure::usage("a database is built from files, - needs -o"));
    };
    if arguments.input_format.is_some() {
        return Err(Failure::usage("--input-format is for one mesh, not for a database"));
    }
    if !arguments.fusion.solution.is_empty() {
        return Err(Failure::usage("--solution is for one PLOT3D grid, not for a database"));
    }
    Ok(std::iter::once(first).chain(&arguments.more).collect())
}

/// The kind of a part by its name; any if the name says nothing.
fn possible_kinds(part: &Path) -> Vec<InputKind> {
    let named = meshes::format_of_name(part);
    named.map_or(InputKind::ALL.to_vec(), |format| vec![InputKind::of(format)])
}

fn report(folder: &Path, lines: &[Line], listed: &Parts, start: Instant) -> Report {
    let n_unchanged = lines.iter().filter(|line| line.is_unchanged).count();
    let sum = |count: fn(&Line) -> u64| lines.iter().map(count).sum::<u64>();
    let (triangles, tetrahedra) = (sum(|line| line.n_triangles), sum(|line| line.n_tetrahedra));
    let volumes =
        if tetrahedra > 0 { format!(", {} tetrahedra", figures::count(tetrahedra)) } else { String::new() };
    Report {
        text: format!(
            "{}: {}, {} of them unchanged, {} triangles{volumes}, {}\n{}",
            folder.display(),
            figures::counted(lines.len(), "part"),
            figures::count(n_unchanged),
            figures::count(triangles),
            figures::time(start.elapsed()),
            listed.left_out_text()
        ),
        json: json!({
            "parts": lines.len(),
            "parts_unchanged": n_unchanged,
            "triangles_in": triangles,
            "tetrahedra_in": tetrahedra,
            "left_out": listed.left_out.iter().map(|path| path.to_string_lossy()).collect::<Vec<_>>(),
            "seconds": start.elapsed().as_secs_f64(),
        }),
    }
}

/// Builds a part unless that is done, and writes its line. `None` if a stop was asked for
/// meanwhile.
fn build_part(
    arguments: &Arguments,
    part: &Path,
    output: &Path,
    known: Option<&Line>,
    manifest: &Manifest,
) -> Option<Line> {
    let part_name = part.to_string_lossy();
    let fail = |reason: String| {
        report::note(&format!("{}: {reason}", part.display()));
        manifest.append(&json!({ "part": part_name, "reason": reason }))
    };
    if let Err(failure) = files::check_output(output, &[part]) {
        return Some(fail(failure.line()));
    }
    let bytes = match read_input(part) {
        Ok(bytes) => bytes,
        Err(error) => return Some(fail(error.to_string())),
    };
    let content = format!("{:016x}", neph::checksum(&bytes));
    let options = format!("{:016x}", neph::checksum(arguments.key().as_bytes()));
    let facts = Facts { output: output.to_string_lossy().into_owned(), content, options };
    if let Some(known) = known {
        let file_bytes = fs::metadata(output).map(|metadata| metadata.len()).ok();
        if known.facts.as_ref() == Some(&facts) && file_bytes.is_some() && file_bytes == known.file_bytes {
            return Some(known.clone());
        }
    }
    match panics::catch(|| build_one(arguments, part, output, bytes)) {
        Ok(built) => {
            let mut line = json!({
                "part": part_name,
                "output": facts.output,
                "content": facts.content,
                "options": facts.options,
            });
            for (key, value) in built.as_object().into_iter().flatten() {
                line[key] = value.clone();
            }
            Some(manifest.append(&line))
        }
        Err(Failure::Interrupted) => None,
        Err(failure) => Some(fail(failure.line())),
    }
}

/// Builds one part and says what became of it.
fn build_one(arguments: &Arguments, part: &Path, output: &Path, bytes: Vec<u8>) -> Result<Value, Failure> {
    let read = read_part(part, bytes)?;
    let target = Target::File(output.to_owned());
    let job = Job { arguments, name: part.display().to_string(), target: &target, watch: Watch::Nobody };
    let mut built = decimate::run(&job, read)?.json;
    let lod = files::open_file(output)?;
    let stride = lod.curve().len().div_ceil(MAX_CURVE_POINTS).max(1);
    let last = lod.curve().len() - 1;
    let shown = lod.curve().enumerate().filter(|(at, _)| at % stride == 0 || *at == last);
    built["curve"] = shown.map(|(_, point)| figures::curve_point(point, lod.simplex())).collect();
    Ok(built)
}

/// The mesh of a part: of a surface from its bytes, unless its format may refer to other files.
fn read_part(part: &Path, bytes: Vec<u8>) -> Result<Read, Failure> {
    let named = MeshFormat::from_path(part);
    match named.and_then(|named| MeshFormat::detect(&bytes, Some(named))) {
        None | Some(MeshFormat::Gltf) => {
            drop(bytes);
            meshes::read(&Source::File(part.to_owned()), None)
        }
        Some(format) => {
            let read = meshes::read_bytes(&bytes, FileFormat::Surface(format));
            read.map_err(|error| error.in_file(part).into())
        }
    }
}
