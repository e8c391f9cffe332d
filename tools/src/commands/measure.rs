//! `nephrite measure`: the distance between two surfaces, sampled and proven.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use clap::Args;
use nephrite::measure::{self, Distance, FieldDistance, Histogram, MeasureOptions, OneSided};
use nephrite::{Attribute, ScalarType, Simplex, TriangleMesh};
use nephrite_formats::{FileFormat, MeshError, MeshFormat};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::meshes::{self, Mesh, Read};
use crate::plot::{self, Panel};
use crate::report::{self, Report};
use crate::streams::{Source, Target};
use crate::threads::Threads;
use crate::{figures, files, ramp};

/// Bars of the histogram.
const N_BINS: usize = 128;

/// Measure the two-sided distance between two surfaces, with a proven bracket.
///
/// Of a volume the boundary is measured. Two volumes are also compared by their contents and
/// fields. Mean and rms count what Metro counts: vertices, samples on edges and samples in
/// triangles, each once. The bracket is proven: the Hausdorff distance lies between its ends.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Mesh to compare with, or - for standard input
    reference: Source,

    /// Mesh to judge, or - for standard input
    mesh: Source,

    /// Format of standard input, named by its file extension; without it, the contents tell
    #[arg(long, value_name = "EXT", value_parser = meshes::parse_format)]
    input_format: Option<FileFormat>,

    /// Samples on the edges, and as many in the triangles, of each mesh
    #[arg(long, value_name = "N", default_value_t = MeasureOptions::default().n_samples, value_parser = n_samples)]
    samples: usize,

    /// Width of the proven bracket to reach, as a fraction of the distance or, with %, in percent
    /// of it
    #[arg(long, value_name = "T", default_value = "1%", value_parser = tolerance)]
    tolerance: f64,

    /// The proof stops with the bracket it has when it has examined this many pieces of each mesh
    #[arg(long, value_name = "N", default_value_t = MeasureOptions::default().max_pieces)]
    max_pieces: usize,

    /// Write MESH with two attributes of every vertex: its distance from REFERENCE, and a colour
    /// from dark blue for 0 to yellow for the largest distance
    #[arg(long, visible_alias = "color", value_name = "OUT.ply")]
    colour: Option<Target>,

    /// Write a histogram of the distances, weighted by area, in both directions
    #[arg(long, value_name = "OUT.svg")]
    plot: Option<Target>,

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

impl Arguments {
    /// Where a mesh or picture goes: standard output if one of them does.
    pub(super) fn target(&self) -> Option<&Target> {
        self.targets().find(|target| **target == Target::Stdout)
    }

    fn targets(&self) -> impl Iterator<Item = &Target> {
        self.colour.iter().chain(&self.plot)
    }

    /// Refuses arguments that contradict each other, and outputs that cannot be written.
    fn check(&self) -> Result<(), Failure> {
        let sources = [&self.reference, &self.mesh];
        let n_stdin = sources.iter().filter(|source| source.path().is_none()).count();
        match (n_stdin, self.input_format) {
            (2, _) => {
                return Err(Failure::usage("standard input can be read once, - is given for both meshes"));
            }
            (0, Some(_)) => {
                return Err(Failure::usage(
                    "--input-format is for standard input, and both meshes are files",
                ));
            }
            _ => {}
        }
        if self.targets().filter(|target| **target == Target::Stdout).count() > 1 {
            return Err(Failure::usage("standard output can be written once, - is given for both outputs"));
        }
        let inputs: Vec<&Path> = sources.iter().filter_map(|source| source.path()).collect();
        if let Some(colour) = &self.colour {
            meshes::format_to_write(colour, self.colour_format(), Simplex::Triangle)?;
        }
        if let Some(plot) = &self.plot {
            files::check_is_svg(plot)?;
        }
        self.targets().try_for_each(|target| files::check_target(target, &inputs))
    }

    /// Format of the coloured mesh if its name does not tell: PLY on standard output.
    fn colour_format(&self) -> Option<FileFormat> {
        let is_stdout = self.colour == Some(Target::Stdout);
        is_stdout.then_some(FileFormat::Surface(MeshFormat::Ply))
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let start = Instant::now();
    arguments.check()?;
    arguments.threads.run(|| {
        let inputs = Inputs::read(arguments)?;
        let [reference, mesh] = &inputs.surfaces;
        let options = MeasureOptions {
            n_samples: arguments.samples,
            tolerance: arguments.tolerance,
            max_pieces: arguments.max_pieces,
        };
        let distance =
            measure::measure(reference, mesh, &options).map_err(|source| failed(arguments, source))?;
        let seconds = start.elapsed();
        if !distance.is_within_tolerance {
            report::note("the bracket is wider than asked for: --max-pieces stopped the proof");
        }
        write_colours(arguments, &inputs, &distance)?;
        write_plot(arguments, &inputs, &distance)?;
        Ok(Report {
            text: text(arguments, &inputs, &distance, seconds) + &fields_text(&inputs.fields),
            json: json(&inputs, &distance, seconds),
        })
    })?
}

fn failed(arguments: &Arguments, source: measure::MeasureError) -> Failure {
    Failure::file(format!("{} and {}", arguments.reference, arguments.mesh), source)
}

fn write_colours(arguments: &Arguments, inputs: &Inputs, distance: &Distance) -> Result<(), Failure> {
    let Some(target) = &arguments.colour else { return Ok(()) };
    let [reference, mesh] = &inputs.surfaces;
    let distances = measure::vertex_distances(mesh, reference).map_err(|source| failed(arguments, source))?;
    let coloured = Mesh::Surface(coloured(mesh.clone(), &distances, distance.backward.max));
    let format = meshes::format_to_write(target, arguments.colour_format(), Simplex::Triangle)?;
    files::tell(&target.to_string(), &coloured.write(target, format)?.notes());
    Ok(())
}

fn write_plot(arguments: &Arguments, inputs: &Inputs, distance: &Distance) -> Result<(), Failure> {
    let Some(target) = &arguments.plot else { return Ok(()) };
    let [reference, mesh] = &inputs.surfaces;
    let picture =
        picture(arguments, [reference, mesh], distance).map_err(|source| failed(arguments, source))?;
    let written = target.publish(|out| out.write_all(picture.as_bytes()));
    written.map_err(|source: io::Error| Failure::file(target.to_string(), source))
}

/// Two surfaces to measure. Of a volume, its boundary.
struct Inputs {
    surfaces: [TriangleMesh; 2],
    /// What each surface was read from.
    simplices: [Simplex; 2],
    /// Fields that both volumes have.
    fields: Vec<FieldDistance>,
    /// Contents of two volumes, in cubic mesh units.
    volumes: Option<[f64; 2]>,
}

impl Inputs {
    fn read(arguments: &Arguments) -> Result<Self, Failure> {
        let Arguments { reference, mesh, .. } = arguments;
        let (reference, mesh) = rayon::join(|| read(arguments, reference), || read(arguments, mesh));
        let (reference, mesh) = (reference?, mesh?);
        let simplices = [reference.simplex(), mesh.simplex()];
        let (fields, volumes) = match (&reference, &mesh) {
            (Mesh::Volume(one), Mesh::Volume(other)) => {
                let fields =
                    measure::measure_fields(one, other).map_err(|source| failed(arguments, source))?;
                (fields, Some([one.volume(), other.volume()]))
            }
            _ => (Vec::new(), None),
        };
        let surfaces = [surface(reference)?, surface(mesh)?];
        Ok(Self { surfaces, simplices, fields, volumes })
    }
}

/// Reads a mesh as `build` does: volumes after repair. Prints the notes of its reader.
fn read(arguments: &Arguments, source: &Source) -> Result<Mesh, Failure> {
    let format = arguments.input_format.filter(|_| source.path().is_none());
    let Read { mesh, report } = meshes::read(source, format)?;
    files::tell(&source.to_string(), &report.notes());
    Ok(match mesh {
        Mesh::Volume(volume) => Mesh::Volume(nephrite::repair_volume(&volume).map_err(MeshError::from)?.0),
        surface => surface,
    })
}

fn surface(mesh: Mesh) -> Result<TriangleMesh, MeshError> {
    match mesh {
        Mesh::Surface(mesh) => Ok(mesh),
        Mesh::Volume(volume) => Ok(nephrite::boundary(&volume)?),
    }
}

/// A table of the fields of volumes; empty if there are none.
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

/// The mesh with the attributes `distance` and `color`, which replace any of these names. A
/// distance of `range` has the last colour of the ramp.
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
    let name = |source: &Source| {
        let name = source.path().and_then(Path::file_name);
        name.map_or(source.to_string(), |name| name.to_string_lossy().into_owned())
    };
    let title = format!("Distance between {} and {}", name(&arguments.reference), name(&arguments.mesh));
    Ok(plot::svg(&title, &panels, distance.bounding_diagonal))
}

fn json(inputs: &Inputs, distance: &Distance, seconds: Duration) -> Value {
    let n_triangles = inputs.surfaces.each_ref().map(|mesh| mesh.triangles.len());
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
    if let Some([volume_reference, volume]) = inputs.volumes {
        json["volume_reference"] = json!(volume_reference);
        json["volume"] = json!(volume);
        json["fields"] = json!(inputs.fields);
    }
    json
}

fn text(arguments: &Arguments, inputs: &Inputs, distance: &Distance, seconds: Duration) -> String {
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
    let surface = |source: &Source, index: usize| {
        let boundary = match inputs.simplices[index] {
            Simplex::Triangle => "",
            Simplex::Tetrahedron => "the boundary, ",
        };
        let n_triangles = figures::count(inputs.surfaces[index].triangles.len());
        format!("{source}, {boundary}{n_triangles} triangles")
    };
    let n_samples = distance.forward.n_samples + distance.backward.n_samples;
    let list = figures::list(&[
        ("reference", surface(&arguments.reference, 0)),
        ("mesh", surface(&arguments.mesh, 1)),
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
