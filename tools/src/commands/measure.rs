//! `nephrite measure`: how far two surfaces are apart, sampled and proven.

use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use nephrite::measure::{self, Distance, FieldDistance, Histogram, MeasureOptions, OneSided};
use nephrite::{Attribute, ScalarType, TriangleMesh};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::plot::{self, Panel};
use crate::report::{self, Report};
use crate::threads::Threads;
use crate::{figures, files, ramp};

/// Bars of the histogram.
const N_BINS: usize = 128;

/// Measure the two-sided distance between two surfaces, or between those around two volumes, with a proven bracket.
///
/// Mean and rms count what Metro counts: vertices, samples on edges and samples in triangles, each once. The bracket is
/// a proof: the Hausdorff distance lies between its ends.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Mesh to compare with
    reference: PathBuf,

    /// Mesh to judge
    mesh: PathBuf,

    /// Samples on the edges, and as many in the triangles, of each mesh
    #[arg(long, value_name = "N", default_value_t = MeasureOptions::default().n_samples, value_parser = n_samples)]
    samples: usize,

    /// Width of the proven bracket to reach, as a part of the distance or, with %, in percent of it
    #[arg(long, value_name = "T", default_value = "1%", value_parser = tolerance)]
    tolerance: f64,

    /// Pieces of each mesh that the proof may look at before it stops with the bracket it has
    #[arg(long, value_name = "N", default_value_t = MeasureOptions::default().max_pieces)]
    max_pieces: usize,

    /// Write MESH with the distance of every vertex from REFERENCE, and a colour for it: dark blue for none, yellow for
    /// the largest distance of MESH
    #[arg(long, visible_alias = "color", value_name = "OUT.ply")]
    colour: Option<PathBuf>,

    /// Write a histogram of the distances, by area, in both directions
    #[arg(long, value_name = "OUT.svg")]
    plot: Option<PathBuf>,

    #[command(flatten)]
    threads: Threads,
}

fn n_samples(text: &str) -> Result<usize, &'static str> {
    text.parse().ok().filter(|&n| n > 0).ok_or("expected a number of samples, at least 1")
}

fn tolerance(text: &str) -> Result<f64, &'static str> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |percent| (percent.trim_end(), 0.01));
    let value = number.parse().map(|value: f64| value * unit).ok();
    value
        .filter(|value| value.is_finite() && *value > 0.0)
        .ok_or("expected a number above 0, with % for percent")
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let start = Instant::now();
    let inputs = [arguments.reference.as_path(), arguments.mesh.as_path()];
    if let Some(colour) = &arguments.colour {
        files::check_mesh_output(colour, &inputs)?;
    }
    if let Some(plot) = &arguments.plot {
        files::check_output(plot, &inputs)?;
    }
    arguments.threads.run(|| {
        let inputs_read = Inputs::read(inputs)?;
        let Inputs { surfaces: [reference, mesh], fields, volumes } = inputs_read;
        let failed =
            |source| Failure::file(format!("{} and {}", inputs[0].display(), inputs[1].display()), source);
        let options = MeasureOptions {
            n_samples: arguments.samples,
            tolerance: arguments.tolerance,
            max_pieces: arguments.max_pieces,
        };
        let distance = measure::measure(&reference, &mesh, &options).map_err(failed)?;
        let seconds = start.elapsed();
        if !distance.is_within_tolerance {
            report::note("the bracket is wider than asked for: --max-pieces stopped the proof");
        }
        if let Some(path) = &arguments.colour {
            let distances = measure::vertex_distances(&mesh, &reference).map_err(failed)?;
            nephrite_formats::write_mesh(path, &coloured(mesh.clone(), &distances, distance.backward.max))?;
        }
        if let Some(path) = &arguments.plot {
            let picture = picture(arguments, [&reference, &mesh], &distance).map_err(failed)?;
            write(path, &picture).map_err(|source| Failure::file(path, source))?;
        }
        let n_triangles = [&reference, &mesh].map(|mesh| mesh.triangles.len());
        let mut report = Report {
            text: text(inputs, n_triangles, &distance, seconds) + &fields_text(&fields),
            json: json(&distance, n_triangles, seconds),
        };
        if let Some([volume_reference, volume]) = volumes {
            report.json["volume_reference"] = json!(volume_reference);
            report.json["volume"] = json!(volume);
            report.json["fields"] = json!(fields);
        }
        Ok(report)
    })?
}

/// Two surfaces, or what is measured of two volumes: the surfaces around them and their fields.
struct Inputs {
    surfaces: [TriangleMesh; 2],
    fields: Vec<FieldDistance>,
    /// The contents of volumes, in cubic mesh units.
    volumes: Option<[f64; 2]>,
}

impl Inputs {
    fn read([reference, mesh]: [&Path; 2]) -> Result<Self, Failure> {
        if !files::is_volume(reference) || !files::is_volume(mesh) {
            let read = |path: &Path| {
                let (mesh, report) = files::read_mesh(path)?;
                files::tell(path, &report);
                Ok::<_, Failure>(mesh)
            };
            let (reference, mesh) = rayon::join(|| read(reference), || read(mesh));
            let surfaces = [reference?, mesh?];
            return Ok(Self { surfaces, fields: Vec::new(), volumes: None });
        }
        let read = |path: &Path| {
            let (mesh, report) = files::read_volume(path, &[])?;
            files::tell(path, &report);
            Ok::<_, Failure>(mesh)
        };
        let volumes = [read(reference)?, read(mesh)?];
        Ok(Self {
            surfaces: [nephrite::volume::boundary(&volumes[0]), nephrite::volume::boundary(&volumes[1])],
            fields: measure::measure_fields(&volumes[0], &volumes[1]),
            volumes: Some(volumes.map(|volume| volume.volume())),
        })
    }
}

/// A table of the fields of volumes, nothing where there are none.
fn fields_text(fields: &[FieldDistance]) -> String {
    if fields.is_empty() {
        return String::new();
    }
    let row = |field: &FieldDistance| {
        let share = figures::percent(field.max, field.range);
        let lengths = [field.max_forward, field.max_backward, field.rms].map(figures::significant);
        let [forward, backward, rms] = lengths;
        [
            field.name.clone(),
            figures::significant(field.max),
            share,
            forward,
            backward,
            rms,
            figures::count(field.n_outside),
        ]
    };
    let rows: Vec<_> = fields.iter().map(row).collect();
    let headings = ["field", "max", "% of range", "forward", "backward", "rms", "outside"];
    format!("Fields, sampled at vertices:\n{}", figures::table(headings, &rows))
}

fn write(path: &Path, text: &str) -> io::Result<()> {
    nephrite_formats::publish(path, |out| out.write_all(text.as_bytes()))
}

/// The mesh with the attributes `distance` and `color` in place of any it had of these names; `range` has the ramp's
/// last colour.
fn coloured(mut mesh: TriangleMesh, distances: &[f64], range: f64) -> TriangleMesh {
    mesh.attributes.retain(|attribute| attribute.name != "distance" && attribute.name != "color");
    #[expect(clippy::cast_possible_truncation, reason = "the file keeps f32, as it does for positions")]
    let values = distances.iter().flat_map(|&distance| (distance as f32).to_le_bytes()).collect();
    let colors = distances.iter().flat_map(|distance| ramp::color(distance / range)).collect();
    mesh.attributes.extend([
        Attribute { name: "distance".to_owned(), scalar: ScalarType::F32, n_components: 1, bytes: values },
        Attribute { name: "color".to_owned(), scalar: ScalarType::U8, n_components: 3, bytes: colors },
    ]);
    mesh
}

/// The histograms of both directions over one range.
fn picture(
    arguments: &Arguments,
    [reference, mesh]: [&TriangleMesh; 2],
    distance: &Distance,
) -> Result<String, measure::MeasureError> {
    let histogram = |from: &TriangleMesh, to: &TriangleMesh| {
        let distances = measure::sample_distances(from, to, arguments.samples)?;
        Ok(Histogram::new(&distances, distance.max, N_BINS))
    };
    let [forward, backward] = [histogram(reference, mesh)?, histogram(mesh, reference)?];
    let panel = |title: &str, histogram, one_sided: &OneSided| Panel {
        title: format!("{title}: rms {} by area", figures::significant(one_sided.area_rms)),
        histogram,
        marks: vec![("mean", one_sided.area_mean), ("max", one_sided.max)],
    };
    let panels = [
        panel("from the reference to the mesh", &forward, &distance.forward),
        panel("from the mesh to the reference", &backward, &distance.backward),
    ];
    let name = |path: &Path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let title = format!("Distance between {} and {}", name(&arguments.reference), name(&arguments.mesh));
    Ok(plot::svg(&title, &panels, distance.bounding_diagonal))
}

fn json(distance: &Distance, n_triangles: [usize; 2], seconds: Duration) -> Value {
    let mut json = json!(distance);
    let Distance { forward, backward, .. } = distance;
    for (key, value) in [
        ("max_forward", json!(forward.max)),
        ("max_backward", json!(backward.max)),
        ("mean_forward", json!(forward.mean)),
        ("mean_backward", json!(backward.mean)),
        ("rms_forward", json!(forward.rms)),
        ("rms_backward", json!(backward.rms)),
        ("triangles_reference", json!(n_triangles[0])),
        ("triangles", json!(n_triangles[1])),
        ("seconds", json!(seconds.as_secs_f64())),
    ] {
        json[key] = value;
    }
    json
}

fn text(paths: [&Path; 2], n_triangles: [usize; 2], distance: &Distance, seconds: Duration) -> String {
    let row = |name: &str, max, mean, rms, [lower, upper]: [f64; 2]| {
        let percent = figures::percent(max, distance.bounding_diagonal);
        let lengths = [max, mean, rms, lower, upper].map(figures::significant);
        let [max, mean, rms, lower, upper] = lengths;
        [name.to_owned(), max, percent, mean, rms, lower, upper]
    };
    let one_sided = |name: &str, one: &OneSided| {
        row(name, one.max, one.mean, one.rms, [one.lower_bound, one.upper_bound])
    };
    let rows = [
        one_sided("reference to mesh", &distance.forward),
        one_sided("mesh to reference", &distance.backward),
        row("both", distance.max, distance.mean, distance.rms, [distance.lower_bound, distance.upper_bound]),
    ];
    let surface = |index: usize| {
        format!("{}, {} triangles", paths[index].display(), figures::count(n_triangles[index]))
    };
    let n_samples = distance.forward.n_samples + distance.backward.n_samples;
    let list = figures::list(&[
        ("reference", surface(0)),
        ("mesh", surface(1)),
        ("diagonal", figures::significant(distance.bounding_diagonal)),
        ("samples", figures::count(n_samples)),
        ("time", figures::time(seconds)),
    ]);
    let headings = ["", "max", "% of diagonal", "mean", "rms", "proven at least", "at most"];
    format!("{list}\n{}", figures::table(headings, &rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_parts_or_percent() {
        assert_eq!(tolerance("0.5"), Ok(0.5));
        assert_eq!(tolerance("1%"), Ok(0.01));
        assert_eq!(tolerance("2 %"), Ok(0.02));
        for text in ["", "%", "0", "-1", "nan", "inf", "1%%"] {
            assert!(tolerance(text).is_err(), "{text:?}");
        }
    }
}
