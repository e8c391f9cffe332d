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

use super::build::{Arguments, Input};
use super::manifest::{Facts, Line, Manifest};
use crate::failure::Failure;
use crate::report::{self, Report};
use crate::{figures, files, interrupt, panics};

/// Points of a part's curve that its line keeps.
const MAX_CURVE_POINTS: usize = 32;

/// Builds every part that is new or has changed.
pub(super) fn run(arguments: &Arguments, folder: &Path) -> Result<Report, Failure> {
    let start = Instant::now();
    // Told before a folder is made.
    arguments.options(1.0)?;
    let listed = Parts::list(arguments.parts(), folder)?;
    fs::create_dir_all(folder).map_err(|source| Failure::file(folder, source))?;
    let parts = &listed.parts;
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
            "{}: {} parts, {} of them unchanged, {} triangles{volumes}, {}\n{}",
            folder.display(),
            figures::count(lines.len()),
            figures::count(n_unchanged),
            figures::count(triangles),
            figures::time(seconds),
            listed.left_out_text()
        ),
        json: json!({
            "parts": lines.len(),
            "parts_unchanged": n_unchanged,
            "triangles_in": triangles,
            "tetrahedra_in": tetrahedra,
            "left_out": listed.left_out.iter().map(|path| path.to_string_lossy()).collect::<Vec<_>>(),
            "seconds": seconds.as_secs_f64(),
        }),
    })
}

/// What was named: the parts, each with the name of its file, and other files of the folders.
struct Parts {
    parts: Vec<(PathBuf, String)>,
    left_out: Vec<PathBuf>,
}

impl Parts {
    /// A folder stands for all meshes and volumes in it and in its folders. The database itself, `db`, is
    /// none of them.
    fn list<'a>(named: impl Iterator<Item = &'a PathBuf>, db: &Path) -> Result<Self, Failure> {
        // Not there yet, it holds nothing that could be taken for a part.
        let db = fs::canonicalize(db).unwrap_or_default();
        let (mut parts, mut left_out) = (Vec::new(), Vec::new());
        for path in named {
            if !path.is_dir() {
                parts.push(path.clone());
                continue;
            }
            let n_before = parts.len();
            list_folder(path, &db, &mut parts, &mut left_out)?;
            if parts.len() == n_before {
                return Err(Failure::NoParts { folder: path.clone() });
            }
        }
        parts.sort();
        parts.dedup();
        left_out.sort();
        left_out.dedup();
        let names = names(&parts);
        Ok(Self { parts: parts.into_iter().zip(names).collect(), left_out })
    }

    /// Files that are left out, in words; empty if there are none.
    fn left_out_text(&self) -> String {
        const SHOWN: usize = 8;
        let names = self.left_out.iter().take(SHOWN).map(|path| path.display().to_string());
        let names = names.collect::<Vec<_>>().join(", ");
        match self.left_out.len() {
            0 => String::new(),
            n if n <= SHOWN => format!("  left out, as they are no meshes by their names: {names}\n"),
            n => format!(
                "  left out, as they are no meshes by their names: {names} and {} more\n",
                figures::count(n - SHOWN)
            ),
        }
    }
}

/// Adds the parts of a folder and of all folders in it. Links to folders are not followed: they may lead
/// back.
fn list_folder(
    named: &Path,
    db: &Path,
    parts: &mut Vec<PathBuf>,
    left_out: &mut Vec<PathBuf>,
) -> Result<(), Failure> {
    let mut folders = vec![named.to_owned()];
    while let Some(folder) = folders.pop() {
        let failed = |source| Failure::file(&folder, source);
        let is_db = fs::canonicalize(&folder).map_err(failed)? == db;
        if is_db && folder != named {
            continue;
        }
        for entry in fs::read_dir(&folder).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let path = entry.path();
            if entry.file_type().map_err(failed)?.is_dir() {
                folders.push(path);
            } else if path.is_file() && is_part(&path) {
                parts.push(path);
            } else if !(is_companion(&path) || is_db && is_of_database(&path)) {
                left_out.push(path);
            }
        }
    }
    Ok(())
}

/// A file name for each part: its own, where several have the same told apart by their paths, and by
/// numbers where a name looks like that.
fn names(parts: &[PathBuf]) -> Vec<String> {
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    parts.iter().for_each(|part| *uses.entry(stem(part)).or_default() += 1);
    let mut taken = HashSet::new();
    let mut name = |part: &PathBuf| {
        let stem = stem(part);
        let path = neph::checksum(part.as_os_str().as_encoded_bytes());
        let plain = (uses.get(&stem) == Some(&1)).then(|| format!("{stem}.neph"));
        let numbered = (2_u64..).map(|number| format!("{stem}-{path:016x}-{number}.neph"));
        let names = plain.into_iter().chain([format!("{stem}-{path:016x}.neph")]).chain(numbered);
        names.into_iter().find(|name| taken.insert(name.clone())).unwrap_or_default()
    };
    parts.iter().map(&mut name).collect()
}

/// True for what `build` writes into a database.
fn is_of_database(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "neph" || extension == "jsonl")
}

/// True for files that belong to a mesh beside them: the nodes of TetGen, materials and buffers.
fn is_companion(path: &Path) -> bool {
    let Some(extension) = path.extension().and_then(|extension| extension.to_str()) else { return false };
    let has_beside = |other: &str| path.with_extension(other).is_file();
    match extension.to_ascii_lowercase().as_str() {
        "node" => has_beside("ele"),
        "mtl" => has_beside("obj"),
        "bin" => has_beside("gltf"),
        _ => false,
    }
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
    let options = format!("{:016x}", neph::checksum(arguments.key().as_bytes()));
    let facts = Facts { output: output.to_string_lossy().into_owned(), content, options };
    if let Some(known) = known {
        let file_bytes = fs::metadata(output).map(|metadata| metadata.len()).ok();
        if known.facts.as_ref() == Some(&facts) && file_bytes.is_some() && file_bytes == known.file_bytes {
            return Some(known.clone());
        }
    }
    match panics::catch(|| build_one(&arguments.for_part(part, output), bytes)) {
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
    let options = arguments.options(input.bounding_diagonal)?;
    let build = nephrite::build_with(mesh, &options, &go_on)
        .map_err(|source| Failure::build(arguments.mesh(), source))?;
    let stored = build.write(arguments.output(), &arguments.stored());
    let stored = stored.map_err(|source| Failure::file(arguments.output(), source))?;
    Ok(json!({
        "triangles_in": input.n_triangles,
        "vertices_in": input.n_vertices,
        "levels": stored.n_levels,
        "coarsest_triangles": stored.n_coarsest,
        "file_bytes": stored.file_bytes,
        "curve": curve(arguments, build.history())?,
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
    let lod = files::open_file(arguments.output())?;
    let stride = lod.curve().len().div_ceil(MAX_CURVE_POINTS).max(1);
    let last = lod.curve().len() - 1;
    let shown = lod.curve().enumerate().filter(|(at, _)| at % stride == 0 || *at == last);
    built["curve"] = shown.map(|(_, point)| figures::curve_point(point, Simplex::Tetrahedron)).collect();
    Ok(built)
}
