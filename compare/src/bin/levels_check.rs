//! Is the stated error of a level ever exceeded, and how close is it?
//!
//! Each mesh is simplified to the end, and levels spread over its range are measured against the
//! input. A level is a violation if its proven *lower* bound is above the stated error; then the
//! program ends with status 1. With `--write` the levels are also written as PLY files beside a
//! `levels.json` with their stated errors, so that other programs can measure them:
//! `metro_check.py` does it with PyMeshLab's Metro.

use clap::Parser;
use nephrite::measure::{MeasureOptions, measure};
use nephrite::{BuildOptions, JadeOptions, Placement, TriangleMesh};
use nephrite_compare::statistics::{median, percentile};
use nephrite_compare::{CompareError, KeptLevels, Table, build_lod, load, spread_levels};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(about = "Hold the stated errors of levels against measured distances")]
struct Arguments {
    /// Meshes to simplify
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Levels of each mesh
    #[arg(long, default_value_t = 8)]
    levels: u32,

    /// Samples on the edges, and as many in the triangles, of each surface
    #[arg(long, default_value_t = 200_000)]
    samples: usize,

    /// Let vertices move to where the error is least
    #[arg(long)]
    best_placement: bool,

    /// Folder for the levels as PLY files, and levels.json
    #[arg(long, value_name = "FOLDER")]
    write: Option<PathBuf>,
}

/// A level that states less than this part of the diagonal counts as exact and has no ratio.
const EXACT: f64 = 1e-6;

/// One level, measured. Lengths are in mesh units.
struct Checked {
    level: u32,
    n_triangles: usize,
    stated: f64,
    max: f64,
    lower_bound: f64,
    upper_bound: f64,
    bounding_diagonal: f64,
    file: Option<PathBuf>,
}

impl Checked {
    fn is_violation(&self) -> bool {
        self.lower_bound > self.stated
    }

    /// The measured part of the stated error; `None` for an exact level.
    fn ratio(&self) -> Option<f64> {
        (self.stated > EXACT * self.bounding_diagonal).then(|| self.max / self.stated)
    }

    fn row(&self, name: &str) -> [String; 7] {
        let percent = |length: f64| format!("{:.6}", 100.0 * length / self.bounding_diagonal);
        [
            name.to_owned(),
            self.n_triangles.to_string(),
            percent(self.stated),
            percent(self.max),
            percent(self.upper_bound),
            self.ratio().map_or("exact".to_owned(), |ratio| format!("{ratio:.3}")),
            if self.is_violation() { "VIOLATION" } else { "holds" }.to_owned(),
        ]
    }

    fn json(&self, reference: &Path) -> Value {
        json!({
            "reference": reference, "mesh": self.file, "level": self.level, "triangles": self.n_triangles,
            "stated": self.stated, "max": self.max, "bounding_diagonal": self.bounding_diagonal,
        })
    }
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("levels_check: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<ExitCode, CompareError> {
    if let Some(folder) = &arguments.write {
        std::fs::create_dir_all(folder)?;
    }
    let mut records = vec![];
    let mut ratios = vec![];
    let mut n_violations = 0;
    for path in &arguments.meshes {
        let checked = match check_mesh(path, arguments) {
            Ok(checked) => checked,
            Err(error) => {
                eprintln!("{}: skipped: {error}", path.display());
                continue;
            }
        };
        print_levels(path, &checked);
        records.extend(checked.iter().map(|level| level.json(path)));
        ratios.extend(checked.iter().filter_map(Checked::ratio));
        n_violations += checked.iter().filter(|level| level.is_violation()).count();
    }
    if let Some(folder) = &arguments.write {
        std::fs::write(folder.join("levels.json"), json!(records).to_string())?;
    }
    println!(
        "{} levels, {n_violations} violations; measured / stated: median {:.3}, tenth percentile {:.3}, least {:.3}",
        records.len(),
        median(&ratios),
        percentile(&ratios, 0.1),
        percentile(&ratios, 0.0),
    );
    Ok(if n_violations == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn check_mesh(path: &Path, arguments: &Arguments) -> Result<Vec<Checked>, CompareError> {
    let mesh = load(path)?;
    let placement = if arguments.best_placement { Placement::Best } else { Placement::Original };
    let options = BuildOptions::with(JadeOptions::certified(placement));
    let build = build_lod(&mesh, &options, KeptLevels::Usual)?;
    let options = MeasureOptions { n_samples: arguments.samples, ..MeasureOptions::default() };
    let levels = spread_levels(&build.lod, arguments.levels).into_iter();
    levels
        .map(|level| {
            let cut = build.lod.at_level(level);
            let surface = TriangleMesh { attributes: vec![], ..cut.to_mesh()? };
            let distance = measure(&mesh, &surface, &options)?;
            let file = match &arguments.write {
                Some(folder) => Some(write_level(folder, path, level, &surface)?),
                None => None,
            };
            Ok(Checked {
                level,
                n_triangles: surface.triangles.len(),
                stated: cut.error(),
                max: distance.max,
                lower_bound: distance.lower_bound,
                upper_bound: distance.upper_bound,
                bounding_diagonal: distance.bounding_diagonal,
                file,
            })
        })
        .collect()
}

fn write_level(
    folder: &Path,
    reference: &Path,
    level: u32,
    surface: &TriangleMesh,
) -> Result<PathBuf, CompareError> {
    let name = reference.file_name().unwrap_or_default().to_string_lossy();
    let path = folder.join(format!("{name}.{level}.ply"));
    nephrite_formats::write_mesh(&path, surface)?;
    Ok(path)
}

fn print_levels(path: &Path, levels: &[Checked]) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let headings =
        ["mesh", "triangles", "stated %", "measured %", "proven upper %", "measured / stated", "bound"];
    let mut table = Table::new(headings);
    for level in levels {
        table.push(level.row(&name));
    }
    println!("{table}");
}
