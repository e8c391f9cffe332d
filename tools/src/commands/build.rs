//! `nephrite build`: a mesh in, every level of detail of it out.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use nephrite::decimate::jade::{JadeBound, JadeOptions, MAX_K, MIN_C1};
use nephrite::decimate::progressive::ProgressiveOptions;
use nephrite::store::{self, StoreOptions, StoreReport};
use nephrite::{Build, BuildOptions, Decimator, TriangleMesh};
use nephrite_formats::{FileReport, VolumeFormat};
use serde_json::{Value, json};

use super::build_volume::{FusionArguments, Request};
use super::database;
use crate::failure::Failure;
use crate::length::{Length, LengthError};
use crate::progress::BuildBar;
use crate::report::Report;
use crate::threads::Threads;
use crate::words::{BoundName, MethodName, PlacementName};
use crate::{figures, files, interrupt};

/// Turn a mesh into a file that holds every level of detail of it.
#[derive(Clone, Debug, Args)]
pub(crate) struct Arguments {
    /// Mesh to read: PLY, OBJ, STL, OFF, glTF or GLB; or a volume: VTU, PVTU, PVD, VTK, Gmsh, MEDIT,
    /// MFEM, TetGen or PLOT3D
    mesh: PathBuf,

    /// More parts of a database, or folders of them
    #[arg(requires = "output_dir")]
    more: Vec<PathBuf>,

    /// File to write
    #[arg(short, long, value_name = "OUT.neph", required_unless_present = "output_dir")]
    output: Option<PathBuf>,

    /// Build a database in this folder: a file for each part, or for each mesh of a folder named as one, and a manifest of all. What is
    /// there and unchanged is left alone
    #[arg(long, value_name = "DB", conflicts_with = "output")]
    output_dir: Option<PathBuf>,

    /// Stop at this error (a length, or with % in percent of the diagonal); without it, go as far as possible
    #[arg(long, value_name = "E", value_parser = positive_length)]
    max_error: Option<Length>,

    /// What the error of a level means
    #[arg(long, value_enum, default_value_t = BoundName::Certified)]
    bound: BoundName,

    /// Keep at most this many levels; without it, each has about 63/64 of the triangles of the one before
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    levels: Option<u32>,

    /// Store levels in windows of this many, rounded up to a power of two: a larger file whose levels, drawn as runs, make better
    /// use of the vertex cache; 16 is a good choice
    #[arg(long, value_name = "N")]
    window_levels: Option<u32>,

    /// Store each triangle once, with narrow indices: a file of a third to two thirds the length, which readers lay out in
    /// memory when they open it instead of mapping it
    #[arg(long)]
    compact: bool,

    /// Angle between the normals at an edge, in degrees, from which the edge is a feature; 60 by default, 40 for volumes
    #[arg(long, value_name = "DEG", value_parser = angle)]
    feature_angle: Option<f64>,

    /// Decimator; volumes are always fused
    #[arg(long, value_enum, default_value_t = MethodName::Jade)]
    method: MethodName,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    jade: JadeArguments,

    #[command(flatten)]
    fusion: FusionArguments,

    #[command(flatten)]
    progressive: ProgressiveArguments,
}

/// Constants of the JADE decimator, by their names in the paper.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Options of the JADE decimator")]
struct JadeArguments {
    /// Where the vertices of a level may be
    #[arg(long, value_enum, default_value_t = PlacementName::Original)]
    placement: PlacementName,

    /// The first limit on the local error is the largest one divided by this; 256 by default, 240.5 for the best placement
    #[arg(long = "jade-k", value_name = "K", value_parser = jade_k)]
    k: Option<f64>,

    /// Factor from one iteration's limit to the next; 1.3 by default, 1.259 for the best placement
    #[arg(long = "jade-c1", value_name = "C1", value_parser = jade_c1)]
    c1: Option<f64>,

    /// Limit on the global error as a multiple of that on the local error; 1.2 by default
    #[arg(long = "jade-c2", value_name = "C2", value_parser = from_one_to_sixteen)]
    c2: Option<f64>,

    /// How much worse than before a flipped edge may make the aspect ratio, as a part of it; 0.5 by default. Only the estimates
    /// have edges flipped
    #[arg(long = "jade-aspect-loss", value_name = "PART", value_parser = part)]
    aspect_loss: Option<f64>,
}

/// How far the progressive decimator goes.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Options of the progressive decimator")]
struct ProgressiveArguments {
    /// Part of the triangles to remove, from 0 to 1 (all of them, which is what it does without this)
    #[arg(long, value_name = "R", value_parser = part)]
    reduction: Option<f64>,

    /// Split along feature edges, at corners and at non-manifold vertices before anything else: better for large flat faces with
    /// thin sides between them
    #[arg(long)]
    pre_split: bool,

    /// Store the operations as well, from which the mesh can be built up one by one while they arrive
    #[arg(long)]
    operations: bool,
}

impl JadeArguments {
    fn options(&self, bound: BoundName) -> Result<JadeOptions, Failure> {
        let usual = match (bound.estimate(), self.placement, self.aspect_loss) {
            (None, placement, None) => JadeOptions::certified(placement.into()),
            (Some(kind), PlacementName::Original, None) => JadeOptions::estimate(kind),
            (Some(kind), PlacementName::Original, Some(aspect_loss)) => {
                JadeOptions { bound: JadeBound::Estimate { kind, aspect_loss }, ..JadeOptions::default() }
            }
            (Some(_), PlacementName::Best, _) => {
                return Err(needs("--placement best", "--bound certified"));
            }
            (None, _, Some(_)) => {
                return Err(needs("--jade-aspect-loss", "--bound joint, removed or accumulated"));
            }
        };
        Ok(JadeOptions { k: self.k, c1: self.c1, c2: self.c2.unwrap_or(usual.c2), ..usual })
    }

    /// Nothing where none of these options was given.
    fn refuse_beside(&self, wanted: &str) -> Result<(), Failure> {
        let given = [
            ("--placement best", self.placement == PlacementName::Best),
            ("--jade-k", self.k.is_some()),
            ("--jade-c1", self.c1.is_some()),
            ("--jade-c2", self.c2.is_some()),
            ("--jade-aspect-loss", self.aspect_loss.is_some()),
        ];
        refuse(given, wanted)
    }
}

impl ProgressiveArguments {
    /// Nothing where none of these options was given.
    fn refuse_beside(&self, wanted: &str) -> Result<(), Failure> {
        let given = [
            ("--reduction", self.reduction.is_some()),
            ("--pre-split", self.pre_split),
            ("--operations", self.operations),
        ];
        refuse(given, wanted)
    }
}

/// Fails with the first option that was given.
fn refuse<const N: usize>(given: [(&str, bool); N], wanted: &str) -> Result<(), Failure> {
    match given.into_iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(needs(option, wanted)),
        None => Ok(()),
    }
}

/// An option that has no meaning without another one.
fn needs(option: &str, wanted: &str) -> Failure {
    Failure::usage(format!("{option} needs {wanted}; see nephrite build --help"))
}

/// A finite number of which something holds.
pub(super) fn number(
    text: &str,
    expected: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<f64, &'static str> {
    text.parse().ok().filter(|&value: &f64| value.is_finite() && holds(value)).ok_or(expected)
}

fn angle(text: &str) -> Result<f64, &'static str> {
    number(text, "expected an angle from 0 to 180 degrees", |value| (0.0..=180.0).contains(&value))
}

fn jade_k(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 1 to 1e12", |value| (1.0..=MAX_K).contains(&value))
}

fn jade_c1(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 1.001 to 16", |value| (MIN_C1..=16.0).contains(&value))
}

fn from_one_to_sixteen(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 1 to 16", |value| (1.0..=16.0).contains(&value))
}

/// A part of a whole.
pub(super) fn part(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 0 to 1", |value| (0.0..=1.0).contains(&value))
}

fn positive_length(text: &str) -> Result<Length, LengthError> {
    text.parse().and_then(|length: Length| if length.is_zero() { Err(LengthError::Zero) } else { Ok(length) })
}

impl Arguments {
    /// Mesh to read.
    pub(super) fn mesh(&self) -> &Path {
        &self.mesh
    }

    /// File to write.
    pub(super) fn output(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(""))
    }

    /// That the file can be written and would replace nothing that is read, TetGen's other file included.
    fn check_output(&self) -> Result<(), Failure> {
        let others = ["ele", "node"].map(|extension| self.mesh.with_extension(extension));
        let is_in_two = VolumeFormat::from_path(&self.mesh) == Some(VolumeFormat::Tetgen);
        let others = others.iter().filter(|_| is_in_two);
        let inputs = std::iter::once(&self.mesh).chain(self.fusion.solutions()).chain(others);
        let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
        files::check_output(self.output(), &inputs)
    }

    /// All meshes that were named.
    pub(super) fn parts(&self) -> impl Iterator<Item = &PathBuf> {
        std::iter::once(&self.mesh).chain(&self.more)
    }

    /// The same for one part of a database.
    pub(super) fn for_part(&self, part: &Path, output: &Path) -> Self {
        Self { mesh: part.to_owned(), output: Some(output.to_owned()), ..self.clone() }
    }

    /// What the build of a surface is asked for.
    ///
    /// # Errors
    ///
    /// [`Failure::Usage`] for options that do not go together.
    pub(super) fn options(&self, bounding_diagonal: f64) -> Result<BuildOptions, Failure> {
        let decimator = match self.method {
            MethodName::Progressive => {
                self.jade.refuse_beside("--method jade")?;
                let ProgressiveArguments { reduction, pre_split, .. } = self.progressive;
                let bound = self
                    .bound
                    .of_progressive()
                    .ok_or_else(|| needs("--bound joint or removed", "--method jade"))?;
                Decimator::Progressive(ProgressiveOptions { bound, reduction, pre_split })
            }
            MethodName::Jade | MethodName::Fusion => {
                self.progressive.refuse_beside("--method progressive")?;
                Decimator::Jade(self.jade.options(self.bound)?)
            }
        };
        let usual = BuildOptions::with(decimator);
        Ok(BuildOptions {
            max_error: self.max_error.map(|length| length.in_mesh_units(bounding_diagonal)),
            feature_angle_degrees: self.feature_angle.unwrap_or(usual.feature_angle_degrees),
            ..usual
        })
    }

    /// What the file is to keep.
    pub(super) fn stored(&self) -> StoreOptions {
        StoreOptions {
            levels: self.levels,
            window_levels: self.window_levels,
            is_compact: self.compact,
            operations: self.progressive.operations,
        }
    }

    /// All that decides what a file holds, in one text.
    pub(super) fn key(&self) -> String {
        let Self { max_error, feature_angle, method, bound, jade, fusion, progressive, .. } = self;
        let options = (max_error, feature_angle, method, bound, jade, fusion, progressive);
        format!("{options:?} {:?}", self.stored())
    }

    /// Whether the input is a volume, by its name or by the method.
    pub(super) fn is_of_volume(&self) -> bool {
        self.method == MethodName::Fusion || files::is_volume(&self.mesh)
    }

    pub(super) fn volume(&self) -> Request<'_> {
        Request {
            input: &self.mesh,
            output: self.output(),
            max_error: self.max_error,
            feature_angle: self.feature_angle,
            stored: self.stored(),
            fusion: &self.fusion,
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let start = Instant::now();
    interrupt::listen();
    if let Some(folder) = &arguments.output_dir {
        return arguments.threads.run(|| database::run(arguments, folder))?;
    }
    arguments.check_output()?;
    // Told before a file is read.
    arguments.options(1.0)?;
    arguments.threads.run(|| {
        if arguments.is_of_volume() {
            return arguments.volume().run();
        }
        let (mesh, read) = files::read_mesh(&arguments.mesh)?;
        interrupt::check()?;
        let input = Input::of(&mesh);
        let build = decimate(arguments, mesh, input.bounding_diagonal)?;
        interrupt::check()?;
        let stored = build.write(arguments.output(), &arguments.stored());
        let stored = stored.map_err(|source| Failure::file(arguments.output(), source))?;
        let outcome = Outcome { input, read, build, stored, seconds: start.elapsed().as_secs_f64() };
        Ok(Report { text: outcome.text(arguments), json: outcome.json() })
    })?
}

/// What is told of a mesh that the build uses up.
#[derive(Clone, Copy)]
pub(super) struct Input {
    pub(super) n_triangles: usize,
    pub(super) n_vertices: usize,
    /// In mesh units.
    pub(super) bounding_diagonal: f64,
}

impl Input {
    pub(super) fn of(mesh: &TriangleMesh) -> Self {
        Self {
            n_triangles: mesh.triangles.len(),
            n_vertices: mesh.positions.len(),
            bounding_diagonal: nephrite::bounding_diagonal(mesh),
        }
    }
}

/// Runs the decimator under a progress bar.
fn decimate(arguments: &Arguments, mesh: TriangleMesh, bounding_diagonal: f64) -> Result<Build, Failure> {
    store::check_attributes(&mesh).map_err(|source| Failure::file(&arguments.mesh, source))?;
    let bar = BuildBar::new(bounding_diagonal);
    let options = arguments.options(bounding_diagonal)?;
    nephrite::build_with(mesh, &options, &|progress| bar.observe(progress))
        .map_err(|source| Failure::build(&arguments.mesh, source))
}

/// A build that is done.
struct Outcome {
    input: Input,
    read: FileReport,
    build: Build,
    stored: StoreReport,
    seconds: f64,
}

impl Outcome {
    fn json(&self) -> Value {
        json!({
            "triangles_in": self.input.n_triangles,
            "vertices_in": self.input.n_vertices,
            "triangles_stored": self.stored.n_lifetimes,
            "levels": self.stored.n_levels,
            "coarsest_triangles": self.stored.n_coarsest,
            "max_error": self.stored.max_error,
            "bounding_diagonal": self.input.bounding_diagonal,
            "seconds": self.seconds,
            "file_bytes": self.stored.file_bytes,
            "reading": self.read,
            "notes": self.read.notes(),
            "repairs": self.build.repairs(),
            "dropped_distance": self.build.dropped_distance(),
            "certified_triangles": self.build.n_certified_triangles(),
            "operations": self.build.progressive().map(|report| &report.counts),
        })
    }

    /// What the repair did, and how far what it dropped lies from the rest.
    fn repaired(&self) -> String {
        let tally = figures::tally(&json!(self.build.repairs()));
        if self.build.dropped_distance() > 0.0 {
            let distance = figures::error(self.build.dropped_distance(), self.input.bounding_diagonal);
            format!(
                "{tally}; what was dropped lies up to {distance} from the rest, which every level's error counts"
            )
        } else {
            tally
        }
    }

    fn text(&self, arguments: &Arguments) -> String {
        let Self { input, stored, .. } = self;
        let size = |triangles: usize, vertices: usize| {
            format!("{} triangles, {} vertices", figures::count(triangles), figures::count(vertices))
        };
        let list = figures::list(&[
            ("mesh", size(input.n_triangles, input.n_vertices)),
            ("read", figures::reading(&self.read)),
            ("repaired", self.repaired()),
            (
                "levels",
                format!("{}, down to {} triangles", stored.n_levels, figures::count(stored.n_coarsest)),
            ),
            ("error", format!("up to {}", figures::error(stored.max_error, input.bounding_diagonal))),
            (
                "stored",
                format!(
                    "{} triangles in {}",
                    figures::count(stored.n_lifetimes),
                    figures::bytes(stored.file_bytes)
                ),
            ),
            ("time", figures::time(Duration::from_secs_f64(self.seconds))),
        ]);
        format!("{}\n{list}", arguments.output().display())
    }
}
