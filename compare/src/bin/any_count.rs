//! Does the progressive decimator reach every triangle count of every mesh, and is every mesh on
//! the way valid?
//!
//! Each mesh is decimated to nothing and its history checked step by step. Then its operation
//! stream is read and played to triangle counts from the input's to 0: all of them for meshes up to
//! a limit, evenly spread ones above it.

use clap::Parser;
use nephrite::ProgressiveMesh;
use nephrite_compare::{decimate_progressively, load};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[path = "../../../tests/support/every_step.rs"]
#[allow(unreachable_pub, reason = "shared with the tests")]
mod every_step;

#[derive(Debug, Parser)]
#[command(about = "Runs meshes to nothing and checks every step and every count")]
struct Arguments {
    /// Meshes, or folders of them
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Counts asked for of each stream
    #[arg(long, default_value_t = 2000)]
    counts: usize,

    /// Split along feature edges before anything else
    #[arg(long)]
    pre_split: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let mut paths = Vec::new();
    arguments.meshes.iter().for_each(|path| list(path, &mut paths));
    let (mut n_good, mut n_bad, mut n_unreadable) = (0, 0, 0);
    for path in &paths {
        match check(path, &arguments) {
            Ok(Some(what)) => {
                println!("{}: {what}", path.display());
                n_good += 1;
            }
            Ok(None) => n_unreadable += 1,
            Err(faults) => {
                println!("{}: WRONG: {}", path.display(), faults.join("; "));
                n_bad += 1;
            }
        }
    }
    println!("{n_good} meshes in order, {n_bad} not, {n_unreadable} files without a mesh");
    if n_bad == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Files under a path, in order.
fn list(path: &Path, paths: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(path) else {
        paths.push(path.to_owned());
        return;
    };
    let mut inside: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    inside.sort();
    inside.iter().for_each(|path| list(path, paths));
}

/// The result for a mesh; `None` for a file without one.
fn check(path: &Path, arguments: &Arguments) -> Result<Option<String>, Vec<String>> {
    let Ok(mesh) = load(path) else { return Ok(None) };
    let Ok(build) = decimate_progressively(&mesh, 1.0, arguments.pre_split) else { return Ok(None) };
    let faults = std::cell::RefCell::new(Vec::new());
    let fail = |what: String| {
        if faults.borrow().len() < 5 {
            faults.borrow_mut().push(what);
        }
    };
    let n_steps = every_step::check(&build, fail);
    let n_in = build.history().n_alive(0);
    match build.operations().and_then(|encoded| ProgressiveMesh::from_bytes(&encoded.bytes)) {
        Ok(mut stream) => ask_for_counts(&mut stream, n_in, arguments.counts, fail),
        Err(error) => fail(error.to_string()),
    }
    let faults = faults.into_inner();
    if faults.is_empty() { Ok(Some(format!("{n_in} triangles, {n_steps} steps"))) } else { Err(faults) }
}

fn ask_for_counts(stream: &mut ProgressiveMesh, n_in: usize, n_counts: usize, fail: impl Fn(String)) {
    let stride = (n_in / n_counts.max(1)).max(1);
    for n in (0..=n_in).rev().step_by(stride).chain([0, n_in]) {
        let found = stream.seek(n);
        if found > n || found + 2 <= n {
            fail(format!("{found} triangles for {n}"));
        }
        let n_vertices = stream.positions().len();
        let distinct: HashSet<&[u32; 3]> = stream.triangles().iter().collect();
        if distinct.len() != found
            || stream.triangles().as_flattened().iter().any(|&v| v as usize >= n_vertices)
        {
            fail(format!("the mesh of {n} triangles is not a surface"));
        }
    }
}
