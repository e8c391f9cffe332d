//! `nephrite plot`: draws the curve of error against simplices of files.

use std::path::Path;

use clap::Args;
use nephrite::Lod;
use serde_json::json;

use crate::curve::{self, Curve};
use crate::failure::Failure;
use crate::report::Report;
use crate::streams::{Source, Target};
use crate::{figures, files};

/// Draw the error against the number of triangles, as an SVG picture with logarithmic axes.
///
/// Errors are in percent of the bounding box diagonal of each mesh, so that several files fit one
/// picture. A line has steps: with a budget of N triangles the error is that of the finest level
/// that has at most N.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Files that `build` wrote; - is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<Source>,

    /// Picture to write, or - for standard output
    #[arg(short, long, value_name = "OUT.svg")]
    output: Target,

    /// Title of the picture [default: the name of the file if there is one only]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
}

impl Arguments {
    /// Where the picture goes.
    pub(super) fn target(&self) -> &Target {
        &self.output
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let inputs: Vec<&Path> = arguments.files.iter().filter_map(Source::path).collect();
    if arguments.files.len() > inputs.len() + 1 {
        return Err(Failure::usage("standard input can be read once, - is given several times"));
    }
    files::check_is_svg(&arguments.output)?;
    files::check_target(&arguments.output, &inputs)?;
    let lods = arguments.files.iter().map(files::open_lod).collect::<Result<Vec<_>, _>>()?;
    let curves: Vec<_> = arguments.files.iter().zip(&lods).map(|(file, lod)| curve_of(file, lod)).collect();
    let first = lods.first().map(Lod::simplex);
    let is_uniform = lods.iter().all(|lod| Some(lod.simplex()) == first);
    let simplices =
        first.filter(|_| is_uniform).map_or("simplices".to_owned(), |simplex| simplex.to_string());
    let title = arguments.title.clone().unwrap_or_else(|| match &curves[..] {
        [curve] => format!("{}: error against {simplices}", curve.name),
        _ => format!("Error against {simplices}"),
    });
    let picture = curve::svg(&title, &simplices, &curves);
    let written = arguments.output.publish(|out| out.write_all(picture.as_bytes()));
    written.map_err(|source: std::io::Error| Failure::file(arguments.output.to_string(), source))?;
    let n_levels: usize = curves.iter().map(|curve| curve.points.len()).sum();
    Ok(Report {
        text: format!(
            "{}: {} of {}\n",
            arguments.output,
            figures::counted(n_levels, "level"),
            figures::counted(curves.len(), "file")
        ),
        json: json!({ "files": curves.len(), "levels": n_levels, "bytes": picture.len() }),
    })
}

fn curve_of(file: &Source, lod: &Lod) -> Curve {
    let points = lod
        .curve()
        .map(|point| (f64::from(point.simplices), figures::share(point.error, lod.bounding_diagonal())));
    let name = file.path().and_then(Path::file_stem);
    Curve {
        name: name.map_or(file.to_string(), |name| name.to_string_lossy().into_owned()),
        points: points.collect(),
    }
}
