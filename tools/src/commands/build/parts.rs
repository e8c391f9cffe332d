//! The parts of a database: the meshes that were named, and those in the folders that were named.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use nephrite_formats::{FileFormat, VolumeFormat, neph};

use crate::failure::Failure;
use crate::{figures, meshes};

/// What was named: the parts, each with the name of its file, and other files of the folders.
pub(super) struct Parts {
    pub(super) parts: Vec<(PathBuf, String)>,
    pub(super) left_out: Vec<PathBuf>,
}

impl Parts {
    /// A folder stands for all meshes and volumes in it and in its folders. The database itself,
    /// `db`, is not one of them.
    pub(super) fn list<'a>(named: impl Iterator<Item = &'a PathBuf>, db: &Path) -> Result<Self, Failure> {
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
    pub(super) fn left_out_text(&self) -> String {
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

/// Adds the parts of a folder and of all folders in it. Links to folders are not followed: they may
/// lead back.
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

/// A file name for each part: its own, where several have the same told apart by their paths, and
/// by numbers where a name looks like that.
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

/// True for a file in a folder that is a part by its name. Of TetGen's two files one stands for
/// both; the extensions of PLOT3D say too little.
fn is_part(path: &Path) -> bool {
    let is_elements = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ele"));
    match meshes::format_of_name(path) {
        None | Some(FileFormat::Volume(VolumeFormat::Plot3d)) => false,
        Some(FileFormat::Volume(VolumeFormat::Tetgen)) => is_elements,
        Some(_) => true,
    }
}
