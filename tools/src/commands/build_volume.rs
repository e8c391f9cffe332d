//! `nephrite build` for volumes: tetrahedra in, every level of detail of them out.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use clap::Args;
use nephrite::decimate::fusion::FusionOptions;
use nephrite::store::{self, StoreOptions, StoreReport};
use nephrite::{TetrahedronMesh, VolumeBuild, VolumeOptions};
use nephrite_formats::FileReport;
use serde_json::{Value, json};

use super::build::{number, part};
use crate::failure::Failure;
use crate::length::Length;
use crate::progress::BuildBar;
use crate::report::Report;
use crate::{figures, files, interrupt};

/// Constants of the fusion of tetrahedra.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Options for volumes")]
pub(super) struct FusionArguments {
    /// How much fields count beside the shape: the range of a field is worth this many bounding box diagonals
    #[arg(long, value_name = "W", default_value_t = FusionOptions::default().field_weight, value_parser = not_negative)]
    field_weight: f64,

    /// The cheapest part of the tetrahedra that are fused whole before edges are; 1 as in the paper
    #[arg(long, value_name = "PART", default_value_t = FusionOptions::default().tetrahedron_share, value_parser = part)]
    tetrahedron_share: f64,

    /// Largest change of the volume, as a part of it
    #[arg(long, value_name = "PART", default_value_t = FusionOptions::default().volume_loss, value_parser = part)]
    volume_loss: f64,

    /// PLOT3D solution on the grid; may be given for every time step
    #[arg(long, value_name = "FILE")]
    solution: Vec<PathBuf>,
}

impl FusionArguments {
    /// Files that are read beside the mesh.
    pub(super) fn solutions(&self) -> &[PathBuf] {
        &self.solution
    }
}

fn not_negative(text: &str) -> Result<f64, &'static str> {
    number(text, "expected a number that is not negative", |value| value >= 0.0)
}

/// What the command is asked for.
pub(super) struct Request<'a> {
    pub(super) input: &'a Path,
    pub(super) output: &'a Path,
    pub(super) max_error: Option<Length>,
    /// In degrees; `None` for the usual one of volumes.
    pub(super) feature_angle: Option<f64>,
    pub(super) stored: StoreOptions,
    pub(super) fusion: &'a FusionArguments,
}

impl Request<'_> {
    fn options(&self, bounding_diagonal: f64) -> VolumeOptions {
        let usual = VolumeOptions::default();
        let FusionArguments { field_weight, tetrahedron_share, volume_loss, .. } = *self.fusion;
        VolumeOptions {
            max_error: self.max_error.map(|length| length.in_mesh_units(bounding_diagonal)),
            feature_angle_degrees: self.feature_angle.unwrap_or(usual.feature_angle_degrees),
            fusion: FusionOptions { field_weight, tetrahedron_share, volume_loss },
        }
    }

    /// Reads, fuses, writes.
    pub(super) fn run(&self) -> Result<Report, Failure> {
        let start = Instant::now();
        let (mesh, read) = files::read_volume(self.input, &self.fusion.solution)?;
        interrupt::check()?;
        let (n_tetrahedra, n_vertices) = (mesh.tetrahedra.len(), mesh.positions.len());
        let bounding_diagonal = nephrite::bounding_diagonal(&mesh);
        let options = self.options(bounding_diagonal);
        let fusing = Instant::now();
        let half = OnceLock::new();
        let build = self.fuse(&mesh, &options, bounding_diagonal, &half)?;
        let build_seconds = fusing.elapsed().as_secs_f64();
        let half_seconds = half.get().map(|then: &Instant| then.duration_since(fusing).as_secs_f64());
        drop(mesh);
        interrupt::check()?;
        let stored = build.write(self.output, &self.stored);
        let stored = stored.map_err(|source| Failure::file(self.output, source))?;
        let sizes = [n_tetrahedra, n_vertices];
        let seconds = [build_seconds, start.elapsed().as_secs_f64()];
        let outcome = Outcome { sizes, read, build, stored, bounding_diagonal, seconds, half_seconds };
        Ok(Report { text: outcome.text(self.output), json: outcome.json() })
    }

    fn fuse(
        &self,
        mesh: &TetrahedronMesh,
        options: &VolumeOptions,
        bounding_diagonal: f64,
        half: &OnceLock<Instant>,
    ) -> Result<VolumeBuild, Failure> {
        store::check_attributes(mesh).map_err(|source| Failure::file(self.input, source))?;
        let bar = BuildBar::new(bounding_diagonal);
        let build = nephrite::build_volume_with(mesh, options, &|progress| {
            if 2 * progress.n_triangles <= progress.n_triangles_in {
                half.get_or_init(Instant::now);
            }
            bar.observe(progress)
        });
        build.map_err(|source| Failure::build(self.input, source))
    }
}

/// A build that is done.
struct Outcome {
    /// Tetrahedra and vertices of the input.
    sizes: [usize; 2],
    read: FileReport,
    build: VolumeBuild,
    stored: StoreReport,
    bounding_diagonal: f64,
    /// Of the fusions, and of all.
    seconds: [f64; 2],
    /// Of the fusions until half of the tetrahedra were gone.
    half_seconds: Option<f64>,
}

impl Outcome {
    /// Tetrahedra that a fusion took away on average.
    #[expect(clippy::cast_precision_loss, reason = "two decimals are printed")]
    fn per_fusion(&self) -> [f64; 2] {
        let history = self.build.history();
        let n_left = history.death.iter().filter(|&&death| death == nephrite::history::NEVER).count();
        let n_repaired = history.n_alive(0);
        let fusions = self.build.fusions();
        let [of_tetrahedra, all] = [fusions.n_tetrahedron_fusions, fusions.n_fusions];
        let n_left_then = fusions.n_left_by_tetrahedra;
        [
            (n_repaired - n_left_then) as f64 / of_tetrahedra.max(1) as f64,
            (n_repaired - n_left) as f64 / all.max(1) as f64,
        ]
    }

    fn deviations(&self) -> Value {
        let last = |values: &Vec<f64>| values.last().copied().unwrap_or(0.0);
        let deviations = self.build.history().deviations.iter();
        deviations.map(|deviation| (deviation.name.clone(), json!(last(&deviation.values)))).collect()
    }

    fn json(&self) -> Value {
        json!({
            "tetrahedra_in": self.sizes[0],
            "vertices_in": self.sizes[1],
            "tetrahedra_stored": self.stored.n_lifetimes,
            "levels": self.stored.n_levels,
            "coarsest_tetrahedra": self.stored.n_coarsest,
            "max_error": self.stored.max_error,
            "bounding_diagonal": self.bounding_diagonal,
            "fusions": self.build.fusions().n_fusions,
            "tetrahedron_fusions": self.build.fusions().n_tetrahedron_fusions,
            "tetrahedra_left_by_tetrahedron_fusions": self.build.fusions().n_left_by_tetrahedra,
            "tetrahedra_per_tetrahedron_fusion": self.per_fusion()[0],
            "tetrahedra_per_fusion": self.per_fusion()[1],
            "deviations": self.deviations(),
            "fusion_seconds": self.seconds[0],
            "half_seconds": self.half_seconds,
            "seconds": self.seconds[1],
            "file_bytes": self.stored.file_bytes,
            "reading": self.read,
            "notes": self.read.notes(),
            "repairs": self.build.repairs(),
        })
    }

    fn text(&self, output: &Path) -> String {
        let Self { stored, build, .. } = self;
        let size = |tetrahedra: usize, vertices: usize| {
            format!("{} tetrahedra, {} vertices", figures::count(tetrahedra), figures::count(vertices))
        };
        let [per_tetrahedron, per_fusion] = self.per_fusion();
        let list = figures::list(&[
            ("volume", size(self.sizes[0], self.sizes[1])),
            ("read", figures::reading(&self.read)),
            ("repaired", figures::tally(&json!(build.repairs()))),
            (
                "fusions",
                format!(
                    "{} of tetrahedra, {per_tetrahedron:.1} tetrahedra each (13.9 to 16.1 in the paper), {} of edges; {per_fusion:.1} each \
                     in all",
                    figures::count(build.fusions().n_tetrahedron_fusions),
                    figures::count(build.fusions().n_fusions - build.fusions().n_tetrahedron_fusions)
                ),
            ),
            (
                "levels",
                format!("{}, down to {} tetrahedra", stored.n_levels, figures::count(stored.n_coarsest)),
            ),
            (
                "boundary",
                format!("within {}, proven", figures::error(stored.max_error, self.bounding_diagonal)),
            ),
            (
                "stored",
                format!(
                    "{} tetrahedra in {}",
                    figures::count(stored.n_lifetimes),
                    figures::bytes(stored.file_bytes)
                ),
            ),
            ("time", figures::time(Duration::from_secs_f64(self.seconds[1]))),
        ]);
        format!("{}\n{list}", output.display())
    }
}
