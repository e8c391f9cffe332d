//! `nephrite extract`: one level of detail of a file, written as a mesh.

use std::time::{Duration, Instant};

use clap::Args;
use nephrite::{Cut, INFLECTION_RATIO, Lod, Plane, QueryError, Simplex};
use nephrite_formats::FileFormat;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::length::{Count, Length};
use crate::meshes::{self, Mesh};
use crate::report::{self, Report};
use crate::streams::{Source, Target};
use crate::{figures, files, interrupt};

/// Write one level of detail as a mesh.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File that `build` wrote, or - for standard input
    file: Source,

    /// Mesh to write, or - for standard output. The extension chooses the format: ply, obj, stl,
    /// off or glb for surfaces, vtu or vtk for volumes
    #[arg(short, long, value_name = "MESH")]
    output: Target,

    /// Format of standard output, named by its file extension
    #[arg(long, value_name = "EXT", value_parser = meshes::parse_format)]
    output_format: Option<FileFormat>,

    /// Of a volume, write only its boundary, a surface
    #[arg(long)]
    boundary: bool,

    /// Of a volume, write only its section with the plane A x + B y + C z = D, a surface
    #[arg(long, value_name = "A,B,C,D", value_parser = plane, allow_hyphen_values = true, conflicts_with = "boundary")]
    slice: Option<Plane>,

    #[command(flatten)]
    selector: Selector,
}

/// Which level: exactly one of these.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct Selector {
    /// The coarsest level with at most this error: a length, or with % in percent of the diagonal
    #[arg(long, value_name = "E")]
    error: Option<Length>,

    /// The finest level with at most this many triangles: a number, or with % in percent of the
    /// input's. The coarsest level if every level has more
    #[arg(long, value_name = "N")]
    triangles: Option<Count>,

    /// The same for a file of a volume
    #[arg(long, value_name = "N")]
    tetrahedra: Option<Count>,

    /// Of the levels near reduction R after which the error leaps, the nearest; R is from 0, the
    /// input, to 1, nothing. Without a leap there, the level before the steepest rise
    #[arg(long, value_name = "R", value_parser = reduction)]
    inflection: Option<f64>,

    /// This level; 0 is the input
    #[arg(long, value_name = "L")]
    level: Option<u32>,
}

fn reduction(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.0..=1.0).contains(value));
    value.ok_or("expected a number from 0 to 1")
}

fn plane(text: &str) -> Result<Plane, &'static str> {
    const EXPECTED: &str = "expected four numbers A,B,C,D, the first three not all zero";
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|word| word.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let Some(&[a, b, c, offset]) = numbers.as_deref() else { return Err(EXPECTED) };
    let normal = [a, b, c];
    if normal == [0.0; 3] { Err(EXPECTED) } else { Ok(Plane { normal, offset }) }
}

impl Selector {
    /// The level that was asked for.
    fn cut<'a>(&self, file: &Source, lod: &'a Lod) -> Result<Cut<'a>, Failure> {
        if let Some(error) = self.error {
            return Ok(at_error(error.in_mesh_units(lod.bounding_diagonal()), file, lod));
        }
        if let Some(count) = self.triangles.or(self.tetrahedra) {
            return Ok(at_count(count.of(lod.at_level(0).n_simplices()), file, lod));
        }
        if let Some(reduction) = self.inflection {
            return Ok(lod.at_reduction_near_inflection(reduction, INFLECTION_RATIO));
        }
        let level = self.level.unwrap_or(0);
        if level < lod.n_levels() {
            Ok(lod.at_level(level))
        } else {
            Err(Failure::Level { file: file.to_string(), level, n_levels: lod.n_levels() })
        }
    }
}

/// The coarsest level with at most `error`; says so if even the finest has more.
fn at_error<'a>(error: f64, file: &Source, lod: &'a Lod) -> Cut<'a> {
    let cut = lod.at_error(error);
    if cut.error() > error {
        let found = figures::significant(cut.error());
        report::note(&format!(
            "{file}: level 0 is written: its error is {found}, as reading rounded the input"
        ));
    }
    cut
}

/// The finest level with at most `n_asked` simplices; says so if even the coarsest has more.
fn at_count<'a>(n_asked: usize, file: &Source, lod: &'a Lod) -> Cut<'a> {
    let cut = lod.at_count(n_asked);
    if cut.n_simplices() > n_asked {
        let found = figures::simplices(cut.n_simplices(), lod.simplex());
        report::note(&format!("{file}: the coarsest level is written: it has {found}"));
    }
    cut
}

impl Arguments {
    /// Where the mesh goes.
    pub(super) fn target(&self) -> &Target {
        &self.output
    }

    /// Refuses options that mean nothing for what the file holds.
    fn check(&self, lod: &Lod) -> Result<(), Failure> {
        let Selector { triangles, tetrahedra, .. } = self.selector;
        let (refused, holds): (&[_], _) = match lod.simplex() {
            Simplex::Triangle => (
                &[
                    ("--tetrahedra", tetrahedra.is_some()),
                    ("--boundary", self.boundary),
                    ("--slice", self.slice.is_some()),
                ],
                "a surface, of triangles",
            ),
            Simplex::Tetrahedron => {
                (&[("--triangles", triangles.is_some())], "a volume: count --tetrahedra instead")
            }
        };
        match refused.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => {
                Err(Failure::usage(format!("{option} cannot be used: {} holds {holds}", self.file)))
            }
            None => Ok(()),
        }
    }

    /// What is written, and the level whose error it has: the level that was asked for, or a mesh
    /// between two levels if the file has operations that lead to the count.
    fn pick<'a>(&self, lod: &'a Lod) -> Result<(Cut<'a>, Mesh), Failure> {
        let name = || self.file.to_string();
        if let Some(count) = self.selector.triangles {
            let n_triangles = count.of(lod.at_level(0).n_simplices());
            let replayed = lod.replay(n_triangles).map_err(|source| Failure::file(name(), source))?;
            if let Some(replayed) = replayed {
                return Ok((replayed.bound, Mesh::Surface(replayed.mesh)));
            }
        }
        let cut = self.selector.cut(&self.file, lod)?;
        let mesh = self.mesh(&cut).map_err(|source| Failure::file(name(), source))?;
        Ok((cut, mesh))
    }

    /// What is written of a level.
    fn mesh(&self, cut: &Cut<'_>) -> Result<Mesh, QueryError> {
        Ok(match (cut.lod().simplex(), &self.slice) {
            (Simplex::Triangle, _) => Mesh::Surface(cut.to_mesh()?),
            (Simplex::Tetrahedron, Some(plane)) => Mesh::Surface(cut.slice(plane)?),
            (Simplex::Tetrahedron, None) if self.boundary => Mesh::Surface(cut.boundary()?),
            (Simplex::Tetrahedron, None) => Mesh::Volume(cut.to_volume()?),
        })
    }

    /// What the written mesh consists of.
    fn simplex_written(&self, lod: &Lod) -> Simplex {
        if self.boundary || self.slice.is_some() { Simplex::Triangle } else { lod.simplex() }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let Arguments { file, output, output_format, .. } = arguments;
    let start = Instant::now();
    interrupt::listen();
    files::check_target(output, &file.path().into_iter().collect::<Vec<_>>())?;
    let lod = files::open_lod(file)?;
    arguments.check(&lod)?;
    let format = meshes::format_to_write(output, *output_format, arguments.simplex_written(&lod))?;
    let (cut, mesh) = arguments.pick(&lod)?;
    interrupt::check()?;
    let notes = mesh.write(output, format)?.notes();
    let seconds = start.elapsed();
    Ok(Report {
        text: text(output, &mesh, &cut, seconds) + &figures::notes(&notes),
        json: json(&mesh, &cut, seconds, &notes),
    })
}

fn text(output: &Target, mesh: &Mesh, cut: &Cut<'_>, seconds: Duration) -> String {
    format!(
        "{output}: {}, {} vertices, error {}, {}, level {}, {}\n",
        figures::simplices(mesh.n_simplices(), mesh.simplex()),
        figures::count(mesh.n_vertices()),
        figures::error(cut.error(), cut.lod().bounding_diagonal()),
        if cut.is_proven() { "proven" } else { "an estimate" },
        cut.level(),
        figures::time(seconds)
    )
}

fn json(mesh: &Mesh, cut: &Cut<'_>, seconds: Duration, notes: &[String]) -> Value {
    json!({
        (mesh.simplex().to_string()): mesh.n_simplices(),
        "vertices": mesh.n_vertices(),
        "error": cut.error(),
        "proven": cut.is_proven(),
        "deviations": deviations(cut),
        "level": cut.level(),
        "runs": cut.n_runs(),
        "bounding_diagonal": cut.lod().bounding_diagonal(),
        "notes": notes,
        "seconds": seconds.as_secs_f64(),
    })
}

/// What the level states beside its error, by name.
fn deviations(cut: &Cut<'_>) -> Value {
    let deviations = cut.lod().deviations();
    deviations.map(|(name, values)| (name.to_owned(), json!(values.get(cut.level() as usize)))).collect()
}
