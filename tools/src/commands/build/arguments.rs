//! Arguments of `build`, and the engine's options that they stand for.

use std::path::PathBuf;

use clap::Args;
use nephrite::{
    BuildOptions, Decimator, FusionOptions, JadeBound, JadeOptions, ProgressiveOptions, StoreOptions,
    VolumeOptions,
};
use nephrite_formats::FileFormat;

use crate::failure::Failure;
use crate::length::{Length, LengthError};
use crate::meshes;
use crate::streams::{Source, Target};
use crate::threads::Threads;
use crate::words::{BoundName, MethodName, PlacementName};

/// Build a file that holds every level of detail of a mesh.
#[derive(Clone, Debug, Args)]
pub(crate) struct Arguments {
    /// Mesh to read, or - for standard input. Surfaces: PLY, OBJ, STL, OFF, glTF or GLB. Volumes:
    /// VTU, PVTU, PVD, VTK, Gmsh, MEDIT, MFEM, TetGen or PLOT3D
    pub(super) mesh: Source,

    /// With --output-dir: more meshes, or folders of them
    pub(super) more: Vec<PathBuf>,

    /// File to write, or - for standard output
    #[arg(short, long, value_name = "OUT.neph", required_unless_present = "output_dir")]
    pub(super) output: Option<Target>,

    /// Build a database in this folder: a file for each mesh, and manifest.jsonl with a line for
    /// each. A folder stands for all meshes in it and in its folders. Files that are up to date are
    /// left alone
    #[arg(long, value_name = "DB", conflicts_with = "output")]
    pub(super) output_dir: Option<PathBuf>,

    /// Format of the input, named by its file extension; without it, name and contents tell
    #[arg(long, value_name = "EXT", value_parser = meshes::parse_format)]
    pub(super) input_format: Option<FileFormat>,

    /// Stop at this error: a length, or with % in percent of the diagonal. Without it, go as far as
    /// possible
    #[arg(long, value_name = "E", value_parser = positive_length)]
    pub(super) max_error: Option<Length>,

    /// Decimator of surfaces, jade by default; volumes are always fused
    #[arg(long, value_enum)]
    pub(super) method: Option<MethodName>,

    /// Meaning of the error of a level of a surface; certified by default
    #[arg(long, value_enum)]
    pub(super) bound: Option<BoundName>,

    /// Angle between the normals at an edge, in degrees, from which the edge is a feature; 60 by
    /// default, 40 for volumes
    #[arg(long, value_name = "DEG", value_parser = angle)]
    pub(super) feature_angle: Option<f64>,

    /// Keep the vertices on the boundary of a surface or a volume at every level, so that parts
    /// that meet there fit whatever their levels
    #[arg(long)]
    pub(super) lock_boundary: bool,

    /// Keep at most this many levels; without it, each has about 63/64 of the triangles of the one
    /// before
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) levels: Option<u32>,

    /// Store levels in windows of N, rounded up to a power of two, such as 16. Levels drawn as runs
    /// then make better use of the vertex cache; the file is larger
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) window_levels: Option<u32>,

    /// Store each simplex once, with narrow indices. The file has a third to two thirds of the
    /// length, and readers must lay it out in memory instead of mapping it
    #[arg(long)]
    pub(super) compact: bool,

    #[command(flatten)]
    pub(super) threads: Threads,

    #[command(flatten)]
    pub(super) jade: JadeArguments,

    #[command(flatten)]
    pub(super) progressive: ProgressiveArguments,

    #[command(flatten)]
    pub(super) fusion: FusionArguments,
}

/// Constants of the JADE decimator, by their names in the paper.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Options of --method jade")]
pub(super) struct JadeArguments {
    /// Where the vertices of a level may be; original by default
    #[arg(long, value_enum)]
    pub(super) placement: Option<PlacementName>,

    /// The first limit on the local error is the largest one divided by K; 256 by default, 240.5
    /// with
    /// --placement best
    #[arg(long = "jade-k", value_name = "K", value_parser = jade_k, hide_short_help = true)]
    pub(super) k: Option<f64>,

    /// Factor from the limit of one iteration to the next; 1.3 by default, 1.259 with --placement
    /// best
    #[arg(long = "jade-c1", value_name = "C1", value_parser = jade_c1, hide_short_help = true)]
    pub(super) c1: Option<f64>,

    /// Limit on the global error, as a multiple of that on the local error; 1.2 by default
    #[arg(long = "jade-c2", value_name = "C2", value_parser = from_one_to_sixteen, hide_short_help = true)]
    pub(super) c2: Option<f64>,

    /// With --bound joint, removed or accumulated: fraction by which flipping an edge may make the
    /// aspect ratio worse; 0.5 by default
    #[arg(long = "jade-aspect-loss", value_name = "FRACTION", value_parser = fraction, hide_short_help = true)]
    pub(super) aspect_loss: Option<f64>,
}

/// How far the progressive decimator goes.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Options of --method progressive")]
pub(super) struct ProgressiveArguments {
    /// Fraction of the triangles to remove, from 0 to 1; 1 by default
    #[arg(long, value_name = "R", value_parser = fraction)]
    pub(super) reduction: Option<f64>,

    /// First split the surface along feature edges, at corners and at non-manifold vertices: better
    /// for large flat faces with thin sides between them
    #[arg(long)]
    pub(super) pre_split: bool,

    /// Store the operations too: a reader can build up the mesh one by one while they arrive
    #[arg(long)]
    pub(super) operations: bool,
}

/// Constants of the fusion of tetrahedra.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Options for volumes")]
pub(super) struct FusionArguments {
    /// Weight of the fields beside the shape: the range of a field counts as W bounding box
    /// diagonals; 4 by default
    #[arg(long, value_name = "W", value_parser = not_negative)]
    pub(super) field_weight: Option<f64>,

    /// Cheapest fraction of the tetrahedra, which are fused whole before edges are; 0.1 by default,
    /// 1 in the paper
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub(super) tetrahedron_share: Option<f64>,

    /// Largest change of the volume, as a fraction of it; 0.001 by default
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub(super) volume_loss: Option<f64>,

    /// PLOT3D solution on the grid; one for each time step
    #[arg(long, value_name = "FILE")]
    pub(super) solution: Vec<PathBuf>,
}

/// A finite number for which `holds` is true.
fn number(text: &str, expected: &'static str, holds: impl Fn(f64) -> bool) -> Result<f64, &'static str> {
    text.parse().ok().filter(|&value: &f64| value.is_finite() && holds(value)).ok_or(expected)
}

fn angle(text: &str) -> Result<f64, &'static str> {
    number(text, "expected an angle from 0 to 180 degrees", |value| (0.0..=180.0).contains(&value))
}

fn jade_k(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 1 to 1e12", |value| (1.0..=JadeOptions::MAX_K).contains(&value))
}

fn jade_c1(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 1.001 to 16", |value| (JadeOptions::MIN_C1..=16.0).contains(&value))
}

fn from_one_to_sixteen(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 1 to 16", |value| (1.0..=16.0).contains(&value))
}

fn fraction(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number from 0 to 1", |value| (0.0..=1.0).contains(&value))
}

fn not_negative(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number that is not negative", |value| value >= 0.0)
}

fn positive_length(text: &str) -> Result<Length, LengthError> {
    text.parse().and_then(|length: Length| if length.is_zero() { Err(LengthError::Zero) } else { Ok(length) })
}

impl Arguments {
    /// Where the file goes; `None` for a database.
    pub(crate) fn target(&self) -> Option<&Target> {
        self.output.as_ref()
    }

    /// Options for a surface with this bounding box diagonal.
    ///
    /// # Errors
    ///
    /// [`Failure::Usage`] for a bound that the decimator cannot state.
    pub(super) fn options(&self, bounding_diagonal: f64) -> Result<BuildOptions, Failure> {
        let decimator = match self.method.unwrap_or_default() {
            MethodName::Progressive => Decimator::Progressive(self.progressive_options()?),
            MethodName::Jade | MethodName::Fusion => Decimator::Jade(self.jade_options()),
        };
        let usual = BuildOptions::with(decimator);
        Ok(BuildOptions {
            max_error: self.max_error.map(|length| length.in_mesh_units(bounding_diagonal)),
            feature_angle_degrees: self.feature_angle.unwrap_or(usual.feature_angle_degrees),
            lock_boundary: self.lock_boundary,
            ..usual
        })
    }

    fn jade_options(&self) -> JadeOptions {
        let JadeArguments { placement, k, c1, c2, aspect_loss } = self.jade;
        let usual = match (self.bound.unwrap_or_default().estimate(), aspect_loss) {
            (None, _) => JadeOptions::certified(placement.unwrap_or_default().into()),
            (Some(kind), None) => JadeOptions::estimate(kind),
            (Some(kind), Some(aspect_loss)) => {
                let bound = JadeBound::Estimate { kind, aspect_loss };
                JadeOptions { bound, ..JadeOptions::estimate(kind) }
            }
        };
        JadeOptions { k, c1, c2: c2.unwrap_or(usual.c2), ..usual }
    }

    fn progressive_options(&self) -> Result<ProgressiveOptions, Failure> {
        let ProgressiveArguments { reduction, pre_split, .. } = self.progressive;
        let bound = self.bound.unwrap_or_default().of_progressive();
        let refused = || Failure::usage("--method progressive needs --bound certified or accumulated");
        Ok(ProgressiveOptions { bound: bound.ok_or_else(refused)?, reduction, pre_split })
    }

    /// Options for a volume with this bounding box diagonal.
    pub(super) fn volume_options(&self, bounding_diagonal: f64) -> VolumeOptions {
        let usual = VolumeOptions::default();
        let FusionArguments { field_weight, tetrahedron_share, volume_loss, .. } = self.fusion;
        VolumeOptions {
            max_error: self.max_error.map(|length| length.in_mesh_units(bounding_diagonal)),
            feature_angle_degrees: self.feature_angle.unwrap_or(usual.feature_angle_degrees),
            lock_boundary: self.lock_boundary,
            fusion: FusionOptions {
                field_weight: field_weight.unwrap_or(usual.fusion.field_weight),
                tetrahedron_share: tetrahedron_share.unwrap_or(usual.fusion.tetrahedron_share),
                volume_loss: volume_loss.unwrap_or(usual.fusion.volume_loss),
            },
        }
    }

    /// What the file keeps.
    pub(super) fn stored(&self) -> StoreOptions {
        StoreOptions {
            levels: self.levels,
            window_levels: self.window_levels,
            is_compact: self.compact,
            operations: self.progressive.operations,
        }
    }

    /// All options that decide what a file holds, as one text.
    pub(super) fn key(&self) -> String {
        let Self { max_error, feature_angle, lock_boundary, method, bound, .. } = self;
        let Self { jade, fusion, progressive, .. } = self;
        let options = (max_error, feature_angle, lock_boundary, method, bound, jade, fusion, progressive);
        format!("{options:?} {:?}", self.stored())
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;
    use nephrite::EstimateKind;

    use super::*;

    #[test]
    fn the_defaults_in_the_help_are_the_engines() {
        let mut program = crate::Arguments::command();
        let build = program.find_subcommand_mut("build").unwrap();
        let help = build.render_long_help().to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        let FusionOptions { field_weight, tetrahedron_share, volume_loss, .. } = FusionOptions::default();
        let JadeBound::Estimate { aspect_loss, .. } = JadeOptions::estimate(EstimateKind::Joint).bound else {
            unreachable!()
        };
        for number in [
            field_weight,
            tetrahedron_share,
            volume_loss,
            BuildOptions::default().feature_angle_degrees,
            JadeOptions::default().c2,
            aspect_loss,
        ] {
            assert!(help.contains(&format!("{number} by default")), "{number}: {help}");
        }
    }

    #[test]
    fn the_papers_constants_are_in_the_long_help_only() {
        let mut program = crate::Arguments::command();
        let build = program.find_subcommand_mut("build").unwrap();
        assert!(!build.render_help().to_string().contains("--jade-"));
        assert!(build.render_long_help().to_string().contains("--jade-aspect-loss"));
    }
}
