//! `nephrite build PARTS... --output-dir DB`: a database of parts, each with all of its levels.
//!
//! Parts are built side by side, one thread each. `manifest.jsonl` gets a line as soon as a part is done, so that a run that
//! was stopped goes on where it was; a part is skipped while its bytes, the options and the file made of it are what that line says.
//! A part that cannot be read or built is listed with its reason and stops nobody. Of a part that is done nothing stays in memory but
//! where its line is.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use nephrite::TriangleMesh;
use nephrite::history::{History, Levels};
use nephrite::query::{CurvePoint, Simplex};
use nephrite::store::check_attributes;
use nephrite_formats::{FileReport, MeshFormat, VolumeFormat, neph, read_input};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::build::{Arguments, Input, write};
use super::manifest::{Facts, Line, Manifest};
use crate::failure::Failure;
use crate::report::{self, Report};
use crate::{figures, files, interrupt};

/// Points of a part's curve that its line keeps.
const MAX_CURVE_POINTS: usize = 32;

/// Builds every part that is new or has changed.
pub(super) fn run(arguments: &Arguments, folder: &Path) -> Result<Report, Failure> {
    let start = Instant::now();
    fs::create_dir_all(folder).map_err(|source| Failure::file(folder, source))?;
    let parts = list_parts(arguments.parts())?;
    let (manifest, known) = Manifest::open(folder)?;
    let lines: Vec<Line> = parts
        .par_iter()
        .filter(|_| !interrupt::is_requested())
        .filter_map(|(part, output)| {
            build_part(arguments, part, &folder.join(output), known.get(part), &manifest)
        })
        .collect();
    let n_failed = lines.iter().filter(|line| line.is_failed).count();
    if interrupt::is_requested() {
        let n_done = lines.len() - n_failed;
        return Err(Failure::InterruptedParts { folder: folder.to_owned(), n_done, n_parts: parts.len() });
    }
    manifest.replace(&lines)?;
    if n_failed > 0 {
        return Err(Failure::Parts { folder: folder.to_owned(), n_failed, n_parts: lines.len() });
    }
    let n_unchanged = lines.iter().filter(|line| line.is_unchanged).count();
    let sum = |count: fn(&Line) -> u64| lines.iter().map(count).sum::<u64>();
    let (triangles, tetrahedra) = (sum(|line| line.n_triangles), sum(|line| line.n_tetrahedra));
    let seconds = start.elapsed();
    let volumes =
        if tetrahedra > 0 { format!(", {} tetrahedra", figures::count(tetrahedra)) } else { String::new() };
    Ok(Report {
        text: format!(
            "{}: {} parts, {} of them unchanged, {} triangles{volumes}, {}\n",
            folder.display(),
            figures::count(lines.len()),
            figures::count(n_unchanged),
            figures::count(triangles),
            figures::time(seconds)
        ),
        json: json!({
            "parts": lines.len(),
            "parts_unchanged": n_unchanged,
            "triangles_in": triangles,
            "tetrahedra_in": tetrahedra,
            "seconds": seconds.as_secs_f64(),
        }),
    })
}

/// Parts and the names of their files; a folder stands for the meshes and volumes in it.
fn list_parts<'a>(named: impl Iterator<Item = &'a PathBuf>) -> Result<Vec<(PathBuf, String)>, Failure> {
    let mut parts = Vec::new();
    for path in named {
        if path.is_dir() {
            let entries = fs::read_dir(path).map_err(|source| Failure::file(path, source))?;
            let inside = entries.filter_map(|entry| Some(entry.ok()?.path()));
            parts.extend(inside.filter(|path| path.is_file() && is_part(path)));
        } else {
            parts.push(path.clone());
        }
    }
    parts.sort();
    parts.dedup();
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    parts.iter().for_each(|part| *uses.entry(stem(part)).or_default() += 1);
    let mut taken = HashSet::new();
    let mut name = |part: &Path| {
        let stem = stem(part);
        let path = neph::checksum(part.as_os_str().as_encoded_bytes());
        // Parts of one name in several folders are told apart by their paths, and by numbers where a name looks like that.
        let plain = (uses.get(&stem) == Some(&1)).then(|| format!("{stem}.neph"));
        let numbered = (2_u64..).map(|number| format!("{stem}-{path:016x}-{number}.neph"));
        let names = plain.into_iter().chain([format!("{stem}-{path:016x}.neph")]).chain(numbered);
        names.into_iter().find(|name| taken.insert(name.clone())).unwrap_or_default()
    };
    Ok(parts.iter().map(|part| (part.clone(), name(part))).collect())
}

/// Whether a file in a folder is a part by its name. Of TetGen's two files one stands for both; PLOT3D's extensions say too little.
fn is_part(path: &Path) -> bool {
    let is_elements = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ele"));
    match VolumeFormat::from_path(path) {
        None => MeshFormat::from_path(path).is_some(),
        Some(VolumeFormat::Plot3d) => false,
        Some(VolumeFormat::Tetgen) => is_elements,
        Some(_) => true,
    }
}

/// Builds a part unless that is done, and writes its line; nothing where a stop was asked for meanwhile.
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
    let options = format!("{} {:?}", json!(arguments.options(1.0)), arguments.stored());
    let options = format!("{:016x}", neph::checksum(options.as_bytes()));
    let facts = Facts { output: output.to_string_lossy().into_owned(), content, options };
    if let Some(known) = known {
        let file_bytes = fs::metadata(output).map(|metadata| metadata.len()).ok();
        if known.facts.as_ref() == Some(&facts) && file_bytes.is_some() && file_bytes == known.file_bytes {
            return Some(known.clone());
        }
    }
    match build_one(&arguments.for_part(part, output), bytes) {
        Ok(Value::Object(built)) => {
            let mut line = json!({
                "part": part_name,
                "output": facts.output,
                "content": facts.content,
                "options": facts.options,
            });
            if let Some(line) = line.as_object_mut() {
                line.extend(built);
            }
            Some(manifest.append(&line))
        }
        Ok(_) | Err(Failure::Interrupted) => None,
        Err(failure) => Some(fail(failure.line())),
    }
}

/// Builds one part and says what became of it.
fn build_one(arguments: &Arguments, bytes: Vec<u8>) -> Result<Value, Failure> {
    if arguments.is_of_volume() {
        drop(bytes);
        return build_volume(arguments);
    }
    let start = Instant::now();
    let (mesh, read) = read_part(arguments.mesh(), bytes)?;
    check_attributes(&mesh).map_err(|source| Failure::file(arguments.mesh(), source))?;
    let input = Input::of(&mesh);
    let go_on = |_: &nephrite::Progress| {
        if interrupt::is_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let options = arguments.options(input.bounding_diagonal);
    let build = nephrite::build_from(mesh, &options, &go_on)
        .map_err(|source| Failure::build(arguments.mesh(), source))?;
    let stored = write(arguments, input, &build)?;
    Ok(json!({
        "triangles_in": input.n_triangles,
        "vertices_in": input.n_vertices,
        "levels": stored.n_levels,
        "coarsest_triangles": stored.n_coarsest,
        "file_bytes": stored.file_bytes,
        "curve": curve(arguments, &build.history)?,
        "notes": read.notes(),
        "seconds": start.elapsed().as_secs_f64(),
    }))
}

/// The mesh of a part from its bytes, which are let go; glTF may refer to other files and is read from its place.
fn read_part(part: &Path, bytes: Vec<u8>) -> Result<(TriangleMesh, FileReport), Failure> {
    let format = MeshFormat::detect(&bytes, MeshFormat::from_path(part));
    let read = match format.filter(|&format| format != MeshFormat::Gltf) {
        Some(format) => {
            nephrite_formats::read_mesh_bytes(&bytes, format).map_err(|error| error.in_file(part))?
        }
        None => nephrite_formats::read_mesh(part)?,
    };
    drop(bytes);
    Ok(read)
}

/// Some levels of the file that was made of this history.
fn curve(arguments: &Arguments, history: &History) -> Result<Vec<Value>, Failure> {
    let levels = Levels::choose(history, arguments.stored().levels)
        .map_err(|source| Failure::file(arguments.output(), source))?;
    let n_vertices = |step: u32| {
        let births = history.vertex_birth.iter().copied().chain(std::iter::repeat(0));
        history
            .vertex_death
            .iter()
            .zip(births)
            .filter(|&(&death, birth)| birth <= step && step < death)
            .count()
    };
    let levels: Vec<(u32, u32)> =
        levels.steps().iter().copied().zip(levels.simplex_counts().iter().copied()).collect();
    let stride = levels.len().div_ceil(MAX_CURVE_POINTS).max(1);
    let last = levels.len() - 1;
    let shown = levels.iter().enumerate().filter(|(at, _)| at % stride == 0 || *at == last);
    let points = shown.map(|(_, &(step, simplices))| CurvePoint {
        error: history.errors[step as usize],
        simplices,
        vertices: u32::try_from(n_vertices(step)).unwrap_or(u32::MAX),
    });
    Ok(points.map(|point| figures::curve_point(point, Simplex::Triangle)).collect())
}

/// Builds a part that is a volume.
fn build_volume(arguments: &Arguments) -> Result<Value, Failure> {
    let mut built = arguments.volume().run()?.json;
    let lod = files::open_lod(arguments.output())?;
    let stride = lod.curve().len().div_ceil(MAX_CURVE_POINTS).max(1);
    let last = lod.curve().len() - 1;
    let shown = lod.curve().enumerate().filter(|(at, _)| at % stride == 0 || *at == last);
    built["curve"] = shown.map(|(_, point)| figures::curve_point(point, Simplex::Tetrahedron)).collect();
    Ok(built)
}
