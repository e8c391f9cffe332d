//! `nephrite plot`: the error-triangle curve of files as a picture.

use std::path::{Path, PathBuf};

use clap::Args;
use nephrite::Lod;
use serde_json::json;

use crate::curve::{self, Curve};
use crate::failure::Failure;
use crate::report::Report;
use crate::{figures, files};

/// Draw how the error rises as triangles go, as an SVG picture with logarithmic axes.
///
/// Errors are in percent of each mesh's bounding box diagonal, so that several files fit one picture. A line is drawn in steps: with so many
/// triangles to spend, the error is that of the finest level that needs no more.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Files that `build` wrote
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Picture to write
    #[arg(short, long, value_name = "OUT.svg")]
    output: PathBuf,

    /// Words above the picture [default: the name of the file, if it is one]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let inputs: Vec<&Path> = arguments.files.iter().map(PathBuf::as_path).collect();
    files::check_output(&arguments.output, &inputs)?;
    let lods = inputs.iter().map(|path| files::open_lod(path)).collect::<Result<Vec<_>, _>>()?;
    let curves: Vec<_> = inputs.iter().zip(&lods).map(|(path, lod)| curve_of(path, lod)).collect();
    let first = lods.first().map(Lod::simplex);
    let is_uniform = lods.iter().all(|lod| Some(lod.simplex()) == first);
    let simplices =
        first.filter(|_| is_uniform).map_or("simplices".to_owned(), |simplex| simplex.to_string());
    let title = arguments.title.clone().unwrap_or_else(|| match &curves[..] {
        [curve] => format!("{}: error against {simplices}", curve.name),
        _ => format!("Error against {simplices}"),
    });
    let picture = curve::svg(&title, &simplices, &curves);
    nephrite_formats::publish(&arguments.output, |out| out.write_all(picture.as_bytes()))
        .map_err(|source: std::io::Error| Failure::file(&arguments.output, source))?;
    let n_levels: usize = curves.iter().map(|curve| curve.points.len()).sum();
    Ok(Report {
        text: format!(
            "{}: {} of {}\n",
            arguments.output.display(),
            figures::counted(n_levels, "level"),
            figures::counted(curves.len(), "file")
        ),
        json: json!({ "files": curves.len(), "levels": n_levels, "bytes": picture.len() }),
    })
}

fn curve_of(path: &Path, lod: &Lod) -> Curve {
    let points = lod
        .curve()
        .map(|point| (f64::from(point.simplices), figures::share(point.error, lod.bounding_diagonal())));
    Curve {
        name: path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        points: points.collect(),
    }
}
