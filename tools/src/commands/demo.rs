//! `nephrite demo`: all steps on one surface, in seconds.

use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use nephrite::{Build, BuildOptions, Cut, History, Lod, StoreOptions, generate};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::progress::BuildBar;
use crate::report::Report;
use crate::threads::Threads;
use crate::{figures, files, interrupt, stopwatch};

/// Build, query and extract levels of a built-in surface, in seconds.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder for the file and for some levels as meshes
    #[arg(short, long, value_name = "DIR", default_value = "nephrite-demo")]
    output: PathBuf,

    #[command(flatten)]
    threads: Threads,
}

/// Vertices along each side of the cosine surface, as in the JADE paper.
const SIDE: u32 = 120;
/// Errors of the table, in percent of the diagonal, each with the name of its mesh if one is
/// written.
const ROWS: [(f64, Option<&str>); 8] = [
    (0.0, None),
    (0.02, None),
    (0.05, None),
    (0.1, Some("ripple-0.1-percent.ply")),
    (0.2, None),
    (0.5, Some("ripple-0.5-percent.ply")),
    (1.0, None),
    (2.0, Some("ripple-2-percent.ply")),
];

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let folder = &arguments.output;
    interrupt::listen();
    fs::create_dir_all(folder).map_err(|source| Failure::file(folder, source))?;
    let start = Instant::now();
    let build = arguments.threads.run(build)??;
    let build_time = start.elapsed();
    let file = folder.join("ripple.neph");
    build.write(&file, &StoreOptions::default()).map_err(|source| Failure::file(&file, source))?;
    let lod = files::open_file(&file)?;
    let mut rows = Vec::new();
    for (percent, mesh_name) in ROWS {
        interrupt::check()?;
        let cut = lod.at_error(percent / 100.0 * lod.bounding_diagonal());
        let mesh_path = mesh_name.map(|name| folder.join(name));
        if let Some(path) = &mesh_path {
            let mesh = cut.to_mesh().map_err(|source| Failure::file(&file, source))?;
            nephrite_formats::write_mesh(path, &mesh)?;
        }
        rows.push(Row::measure(percent, cut, build.history(), mesh_path));
    }
    Ok(Report { text: text(&lod, &rows, &file, build_time), json: json(&lod, &rows, build_time) })
}

fn build() -> Result<Build, Failure> {
    let mesh = generate::cosine(SIDE);
    let bar = BuildBar::new(nephrite::bounding_diagonal(&mesh));
    nephrite::build_with(mesh, &BuildOptions::default(), &|progress| bar.observe(progress))
        .map_err(|source| Failure::build("the built-in surface", source))
}

/// One line of the table.
struct Row {
    percent_asked: f64,
    percent: f64,
    n_triangles: usize,
    n_runs: usize,
    seconds: f64,
    naive_seconds: f64,
    mesh: Option<PathBuf>,
}

impl Row {
    /// Measures the time from an error to a filled index buffer, by a cut and by the naive way.
    fn measure(percent_asked: f64, cut: Cut<'_>, history: &History, mesh: Option<PathBuf>) -> Self {
        let (lod, error) = (cut.lod(), cut.error());
        let mut indices = vec![0; cut.n_indices()];
        let mut triangles = Vec::with_capacity(cut.n_simplices());
        let [seconds, naive_seconds] = stopwatch::in_turn(
            || _ = black_box(lod.at_error(black_box(error)).extract_into(black_box(&mut indices))),
            || scan(history, black_box(error), black_box(&mut triangles)),
        );
        let percent = 100.0 * error / lod.bounding_diagonal();
        let (n_triangles, n_runs) = (cut.n_simplices(), cut.n_runs());
        Self { percent_asked, percent, n_triangles, n_runs, seconds, naive_seconds, mesh }
    }

    fn cells(&self) -> [String; 7] {
        let microseconds = |seconds: f64| format!("{:.1}", seconds * 1e6);
        let mesh = self.mesh.as_ref().and_then(|path| path.file_name()).unwrap_or_default();
        [
            self.percent_asked.to_string(),
            figures::significant(self.percent),
            figures::count(self.n_triangles),
            self.n_runs.to_string(),
            microseconds(self.seconds),
            microseconds(self.naive_seconds),
            mesh.to_string_lossy().into_owned(),
        ]
    }

    fn json(&self) -> Value {
        json!({
            "percent_asked": self.percent_asked,
            "percent": self.percent,
            "triangles": self.n_triangles,
            "runs": self.n_runs,
            "seconds": self.seconds,
            "naive_seconds": self.naive_seconds,
        })
    }
}

/// The naive way: examines every triangle that ever lived and keeps those that are alive.
fn scan(history: &History, error: f64, triangles: &mut Vec<[u32; 3]>) {
    triangles.clear();
    let step = history.errors.partition_point(|&stated| stated <= error).saturating_sub(1);
    triangles.extend(history.alive(u32::try_from(step).unwrap_or(u32::MAX)));
}

fn text(lod: &Lod, rows: &[Row], file: &Path, build_time: Duration) -> String {
    let headings = ["error asked %", "stated %", "triangles", "runs", "us", "scan us", "written"];
    let cells: Vec<_> = rows.iter().map(Row::cells).collect();
    format!(
        "The surface z = cos(r) / (r + 0.001): {} triangles. All {} levels of it took {} to build\n\
         and {} to keep, in {}.\n\n\
         Any of them is a few runs of one index buffer. Errors are in percent of the diagonal; times\n\
         are from the error to a filled index buffer, in microseconds, beside a scan of all triangles.\n\n{}\n\
         Next: nephrite extract {} --error 0.3% -o lod.ply\n",
        figures::count(lod.at_level(0).n_simplices()),
        figures::count(lod.n_levels()),
        figures::time(build_time),
        figures::bytes(lod.file_bytes()),
        file.display(),
        figures::table(headings, &cells),
        file.display(),
    )
}

fn json(lod: &Lod, rows: &[Row], build_time: Duration) -> Value {
    let written: Vec<_> =
        rows.iter().filter_map(|row| row.mesh.as_ref()).map(|path| path.to_string_lossy()).collect();
    json!({
        "triangles_in": lod.at_level(0).n_simplices(),
        "levels": lod.n_levels(),
        "bounding_diagonal": lod.bounding_diagonal(),
        "seconds": build_time.as_secs_f64(),
        "cuts": rows.iter().map(Row::json).collect::<Vec<_>>(),
        "written": written,
    })
}
