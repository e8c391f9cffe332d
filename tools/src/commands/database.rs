//! `nephrite build PARTS... --output-dir DB`: a database of parts, each with all of its levels.
//!
//! Parts are built side by side, one thread each. `manifest.jsonl` gets a line as soon as a part is done, so that a run that
//! was stopped goes on where it was; a part is skipped while its bytes, the options and the file made of it are what that line says.
//! A part that cannot be read or built is listed with its reason and stops nobody.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use nephrite_formats::{MeshFormat, neph};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::build::{Arguments, write};
use crate::failure::Failure;
use crate::report::{self, Report};
use crate::{figures, files, interrupt};

/// Name of the list of parts in the database's folder.
const MANIFEST: &str = "manifest.jsonl";
/// Points of a part's curve that its line keeps.
const MAX_CURVE_POINTS: usize = 32;

/// A line of the manifest.
#[derive(Clone)]
struct Line {
    facts: Value,
    /// As it stands in the file: numbers that are read and written again may lose their last digit.
    text: String,
    is_unchanged: bool,
}

impl From<Value> for Line {
    fn from(facts: Value) -> Self {
        Self { text: facts.to_string(), facts, is_unchanged: false }
    }
}

/// Builds every part that is new or has changed.
pub(super) fn run(arguments: &Arguments, folder: &Path) -> Result<Report, Failure> {
    let start = Instant::now();
    fs::create_dir_all(folder).map_err(|source| Failure::file(folder, source))?;
    let parts = list_parts(arguments.parts())?;
    let known = read_manifest(&folder.join(MANIFEST))?;
    let manifest = File::options().create(true).append(true).open(folder.join(MANIFEST));
    let manifest = Mutex::new(manifest.map_err(|source| Failure::file(folder.join(MANIFEST), source))?);
    let lines: Vec<Line> = parts
        .par_iter()
        .filter(|_| !interrupt::is_requested())
        .map(|(part, output)| {
            let line = build_part(arguments, part, &folder.join(output), known.get(part));
            append(&manifest, &line);
            line
        })
        .collect();
    drop(manifest);
    interrupt::check()?;
    replace_manifest(folder, &lines)?;
    let n_failed = lines.iter().filter(|line| !line.facts["reason"].is_null()).count();
    let n_unchanged = lines.iter().filter(|line| line.is_unchanged).count();
    let triangles: u64 = lines.iter().filter_map(|line| line.facts["triangles_in"].as_u64()).sum();
    if n_failed > 0 {
        return Err(Failure::Parts { folder: folder.to_owned(), n_failed, n_parts: lines.len() });
    }
    let seconds = start.elapsed();
    Ok(Report {
        text: format!(
            "{}: {} parts, {} of them unchanged, {} triangles, {}\n",
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
            "seconds": seconds.as_secs_f64(),
        }),
    })
}

/// Parts and the names of their files; a folder stands for the meshes in it.
fn list_parts<'a>(named: impl Iterator<Item = &'a PathBuf>) -> Result<Vec<(PathBuf, String)>, Failure> {
    let mut parts = Vec::new();
    for path in named {
        if path.is_dir() {
            let entries = fs::read_dir(path).map_err(|source| Failure::file(path, source))?;
            let inside = entries.filter_map(|entry| Some(entry.ok()?.path()));
            parts.extend(inside.filter(|path| path.is_file() && MeshFormat::from_path(path).is_some()));
        } else {
            parts.push(path.clone());
        }
    }
    parts.sort();
    parts.dedup();
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    parts.iter().for_each(|part| *uses.entry(stem(part)).or_default() += 1);
    let name = |part: &Path| match stem(part) {
        stem if uses.get(&stem) == Some(&1) => format!("{stem}.neph"),
        // Parts of one name in several folders are told apart by their paths.
        stem => format!("{stem}-{:016x}.neph", neph::checksum(part.as_os_str().as_encoded_bytes())),
    };
    Ok(parts.iter().map(|part| (part.clone(), name(part))).collect())
}

/// Lines of an earlier run by part, the last of each; lines that are cut off or something else are left out.
fn read_manifest(path: &Path) -> Result<BTreeMap<PathBuf, Line>, Failure> {
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
        Err(source) => return Err(Failure::file(path, source)),
    };
    let lines = BufReader::new(file).split(b'\n').map_while(Result::ok);
    let lines = lines.filter_map(|line| {
        let facts: Value = serde_json::from_slice(&line).ok()?;
        let part = PathBuf::from(facts["part"].as_str()?);
        Some((part, Line { text: String::from_utf8(line).ok()?, facts, is_unchanged: true }))
    });
    Ok(lines.collect())
}

/// The line of a part: built, unchanged, or failed.
fn build_part(arguments: &Arguments, part: &Path, output: &Path, known: Option<&Line>) -> Line {
    let part_name = part.to_string_lossy();
    let fail = |reason: String| {
        report::note(&format!("{}: {reason}", part.display()));
        json!({ "part": part_name, "reason": reason }).into()
    };
    let content = match fs::read(part) {
        Ok(bytes) => format!("{:016x}", neph::checksum(&bytes)),
        Err(error) => return fail(error.to_string()),
    };
    let options = format!("{} {:?}", json!(arguments.options(1.0)), arguments.stored());
    let options = format!("{:016x}", neph::checksum(options.as_bytes()));
    let mut line = json!({ "part": part_name, "output": output, "content": content, "options": options });
    if let Some(known) = known {
        let is_same = ["output", "content", "options"].iter().all(|key| known.facts[key] == line[key]);
        let file_bytes = fs::metadata(output).map(|metadata| metadata.len()).ok();
        if is_same && file_bytes.is_some() && file_bytes == known.facts["file_bytes"].as_u64() {
            return known.clone();
        }
    }
    match build_one(&arguments.for_part(part, output)) {
        Ok(Value::Object(facts)) => {
            if let Some(line) = line.as_object_mut() {
                line.extend(facts);
            }
            line.into()
        }
        Ok(_) => line.into(),
        Err(failure) => fail(failure.line()),
    }
}

/// Builds one part and says what became of it.
fn build_one(arguments: &Arguments) -> Result<Value, Failure> {
    let start = Instant::now();
    let (mesh, _) = nephrite_formats::read_mesh(arguments.mesh())?;
    let diagonal = nephrite::bounding_diagonal(&mesh);
    let go_on = |_: &nephrite::Progress| {
        if interrupt::is_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let build = nephrite::build(&mesh, &arguments.options(diagonal), &go_on)
        .map_err(|source| Failure::build(arguments.mesh(), source))?;
    let stored = write(arguments, &mesh, &build, diagonal)?;
    let lod = files::open_lod(arguments.output())?;
    let n_points = lod.curve().len();
    let step = n_points.div_ceil(MAX_CURVE_POINTS).max(1);
    let curve: Vec<_> = lod
        .curve()
        .enumerate()
        .filter(|(at, _)| at % step == 0 || at + 1 == n_points)
        .map(|(_, point)| point)
        .collect();
    Ok(json!({
        "triangles_in": mesh.triangles.len(),
        "vertices_in": mesh.positions.len(),
        "levels": stored.n_levels,
        "coarsest_triangles": stored.n_coarsest,
        "file_bytes": stored.file_bytes,
        "curve": curve,
        "seconds": start.elapsed().as_secs_f64(),
    }))
}

/// Adds a line at once; where that fails, the part is built again next time.
fn append(manifest: &Mutex<File>, line: &Line) {
    let mut manifest = manifest.lock().unwrap_or_else(PoisonError::into_inner);
    // One write per line, so that lines of several threads never mix.
    let _ = manifest.write_all(format!("{}\n", line.text).as_bytes());
}

/// Puts a manifest in order of parts, one line each, in the place of the one that grew.
fn replace_manifest(folder: &Path, lines: &[Line]) -> Result<(), Failure> {
    let path = folder.join(MANIFEST);
    nephrite_formats::publish(&path, |out| lines.iter().try_for_each(|line| writeln!(out, "{}", line.text)))
        .map_err(|source| Failure::file(&path, source))
}
