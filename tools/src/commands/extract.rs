//! `nephrite extract`: one level of detail out of a file, as a mesh.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use nephrite::query::{INFLECTION_RATIO, QueryError, Simplex};
use nephrite::volume::Plane;
use nephrite::{Cut, Lod, TetrahedronMesh, TriangleMesh};
use nephrite_formats::{FileReport, MeshError};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::length::Length;
use crate::report::{self, Report};
use crate::{figures, files, interrupt};

/// Write one level of detail as a mesh.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File that `build` wrote
    file: PathBuf,

    /// Mesh to write; its extension chooses the format: ply, obj, stl, off or glb, for volumes vtu or vtk
    #[arg(short, long, value_name = "MESH")]
    output: PathBuf,

    /// Of a volume, only the surface around it, as a mesh of triangles
    #[arg(long)]
    boundary: bool,

    /// Of a volume, only where it meets the plane A x + B y + C z = D, as a mesh of triangles
    #[arg(long, value_name = "A,B,C,D", value_parser = plane, allow_hyphen_values = true, conflicts_with = "boundary")]
    slice: Option<Plane>,

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
    #[arg(long, value_name = "N", visible_alias = "tetrahedra")]
    triangles: Option<u32>,

    /// The level before a leap of the error whose reduction is nearest to this one, from 0 (the input) to 1 (nothing)
    #[arg(long, value_name = "R", value_parser = reduction)]
    inflection: Option<f64>,

    /// This level: 0 is the input
    #[arg(long, value_name = "L")]
    level: Option<u32>,
}

fn reduction(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.0..=1.0).contains(value));
    value.ok_or("expected a number from 0 to 1")
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
            let cut = lod.at_count(n_triangles as usize);
            if cut.n_simplices() > n_triangles as usize {
                let found = figures::simplices(cut.n_simplices(), lod.simplex());
                report::note(&format!("{}: the coarsest level still has {found}", file.display()));
            }
            return Ok(cut);
        }
        if let Some(reduction) = self.inflection {
            return Ok(lod.at_reduction_near_inflection(reduction, INFLECTION_RATIO));
        }
        let level = self.level.unwrap_or(0);
        if level < lod.n_levels() {
            Ok(lod.at_level(level))
        } else {
            Err(Failure::Level { path: file.to_owned(), level, n_levels: lod.n_levels() })
        }
    }
}

fn plane(text: &str) -> Result<Plane, &'static str> {
    const EXPECTED: &str = "expected four numbers A,B,C,D, the first three not all zero";
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|word| word.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let Some(&[a, b, c, offset]) = numbers.as_deref() else { return Err(EXPECTED) };
    let normal = [a, b, c];
    if normal == [0.0; 3] { Err(EXPECTED) } else { Ok(Plane { normal, offset }) }
}

/// What is written of a level.
enum Part {
    Surface(TriangleMesh),
    Volume(TetrahedronMesh),
}

impl Part {
    fn of(cut: &Cut<'_>, arguments: &Arguments) -> Result<Self, QueryError> {
        Ok(match arguments.slice {
            Some(plane) => Self::Surface(cut.slice(&plane)?),
            None if arguments.boundary => Self::Surface(cut.boundary()?),
            None if cut.lod().simplex() == Simplex::Tetrahedron => Self::Volume(cut.to_volume()?),
            None => Self::Surface(cut.to_mesh()?),
        })
    }

    fn write(&self, output: &Path) -> Result<FileReport, MeshError> {
        match self {
            Self::Surface(mesh) => nephrite_formats::write_mesh(output, mesh),
            Self::Volume(mesh) => nephrite_formats::write_volume(output, mesh),
        }
    }

    /// Simplices and vertices, and what the simplices are.
    fn sizes(&self) -> (usize, usize, Simplex) {
        match self {
            Self::Surface(mesh) => (mesh.triangles.len(), mesh.positions.len(), Simplex::Triangle),
            Self::Volume(mesh) => (mesh.tetrahedra.len(), mesh.positions.len(), Simplex::Tetrahedron),
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let Arguments { file, output, selector, boundary, slice } = arguments;
    let start = Instant::now();
    interrupt::listen();
    if files::is_volume(output) {
        files::check_volume_output(output, &[file])?;
    } else {
        files::check_mesh_output(output, &[file])?;
    }
    let lod = files::open_lod(file)?;
    let is_volume = lod.simplex() == Simplex::Tetrahedron && !boundary && slice.is_none();
    if is_volume != files::is_volume(output) {
        let kind = if is_volume { "a volume" } else { "a surface" };
        return Err(Failure::Kind { path: output.clone(), kind });
    }
    let cut = selector.cut(file, &lod)?;
    let part = Part::of(&cut, arguments).map_err(|source| Failure::file(file, source))?;
    interrupt::check()?;
    let notes = part.write(output)?.notes();
    let seconds = start.elapsed();
    let (n_simplices, n_vertices, simplex) = part.sizes();
    Ok(Report {
        text: format!(
            "{}: {}, {} vertices, error {}, level {}, {}\n{}",
            output.display(),
            figures::simplices(n_simplices, simplex),
            figures::count(n_vertices),
            figures::error(cut.error(), lod.bounding_diagonal()),
            cut.level(),
            figures::time(seconds),
            notes.iter().map(|note| format!("  {note}\n")).collect::<String>()
        ),
        json: json!({
            (simplex.to_string()): n_simplices,
            "vertices": n_vertices,
            "error": cut.error(),
            "deviations": deviations(&cut),
            "level": cut.level(),
            "runs": cut.n_runs(),
            "bounding_diagonal": lod.bounding_diagonal(),
            "seconds": seconds.as_secs_f64(),
            "notes": notes,
        }),
    })
}

/// What the level states beside its error, by name.
fn deviations(cut: &Cut<'_>) -> Value {
    let deviations = cut.lod().deviations();
    deviations.map(|(name, values)| (name.to_owned(), json!(values.get(cut.level() as usize)))).collect()
}
