//! `nephrite extract`: one level of detail out of a file, as a mesh.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use nephrite::{Cut, Lod};
use serde_json::json;

use crate::failure::Failure;
use crate::length::Length;
use crate::report::{self, Report};
use crate::{figures, files, interrupt};

/// Write one level of detail as a mesh.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File that `build` wrote
    file: PathBuf,

    /// Mesh to write; its extension chooses the format: ply, obj, stl, off or glb
    #[arg(short, long, value_name = "MESH")]
    output: PathBuf,

    #[command(flatten)]
    selector: Selector,
}

/// Which level: exactly one of these.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct Selector {
    /// The coarsest level with at most this error (a length, or with % in percent of the diagonal)
    #[arg(long, value_name = "E")]
    error: Option<Length>,

    /// The finest level with at most this many triangles; the coarsest one where none is that small
    #[arg(long, value_name = "N")]
    triangles: Option<u32>,

    /// This level: 0 is the input
    #[arg(long, value_name = "L")]
    level: Option<u32>,
}

impl Selector {
    /// The cut that the selector asks for.
    fn cut<'a>(&self, file: &Path, lod: &'a Lod) -> Result<Cut<'a>, Failure> {
        if let Some(error) = self.error {
            let error = error.in_mesh_units(lod.bounding_diagonal());
            let cut = lod.at_error(error);
            if cut.error() > error {
                let found = figures::significant(cut.error());
                report::note(&format!("{}: the finest level has error {found} already", file.display()));
            }
            return Ok(cut);
        }
        if let Some(n_triangles) = self.triangles {
            let cut = lod.at_triangles(n_triangles as usize);
            if cut.n_triangles() > n_triangles as usize {
                let found = figures::count(cut.n_triangles());
                report::note(&format!("{}: the coarsest level has {found} triangles still", file.display()));
            }
            return Ok(cut);
        }
        let level = self.level.unwrap_or(0);
        if level < lod.n_levels() {
            Ok(lod.at_level(level))
        } else {
            Err(Failure::Level { path: file.to_owned(), level, n_levels: lod.n_levels() })
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let Arguments { file, output, selector } = arguments;
    let start = Instant::now();
    interrupt::listen();
    files::check_mesh_output(output, &[file])?;
    let lod = files::open_lod(file)?;
    let cut = selector.cut(file, &lod)?;
    let mesh = cut.to_mesh().map_err(|source| Failure::file(file, source))?;
    interrupt::check()?;
    nephrite_formats::write_mesh(output, &mesh)?;
    let seconds = start.elapsed();
    Ok(Report {
        text: format!(
            "{}: {} triangles, {} vertices, error {}, level {}, {}\n",
            output.display(),
            figures::count(mesh.triangles.len()),
            figures::count(mesh.positions.len()),
            figures::error(cut.error(), lod.bounding_diagonal()),
            cut.level(),
            figures::time(seconds)
        ),
        json: json!({
            "triangles": mesh.triangles.len(),
            "vertices": mesh.positions.len(),
            "error": cut.error(),
            "level": cut.level(),
            "runs": cut.n_runs(),
            "bounding_diagonal": lod.bounding_diagonal(),
            "seconds": seconds.as_secs_f64(),
        }),
    })
}
