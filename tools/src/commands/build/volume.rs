//! A volume built by fusion of its tetrahedra.

use std::sync::OnceLock;
use std::time::Instant;

use nephrite::{TetrahedronMesh, VolumeBuild, check_attributes};
use nephrite_formats::FileReport;
use serde_json::{Value, json};

use super::facts::Facts;
use super::job::{Built, Job};
use crate::failure::Failure;
use crate::report::Report;
use crate::{figures, interrupt};

/// Fuses the tetrahedra of a volume and writes the file.
pub(super) fn run(job: &Job<'_>, mesh: TetrahedronMesh, read: &FileReport) -> Result<Report, Failure> {
    let start = Instant::now();
    check_attributes(&mesh).map_err(|source| job.failed(source))?;
    let bounding_diagonal = nephrite::bounding_diagonal(&mesh);
    let options = job.arguments.volume_options(bounding_diagonal);
    let bar = job.bar(bounding_diagonal);
    let half = OnceLock::new();
    let build = nephrite::build_volume_with(&mesh, &options, &|progress| {
        if 2 * progress.n_triangles <= progress.n_triangles_in {
            half.get_or_init(Instant::now);
        }
        bar.observe(progress)
    });
    let build = build.map_err(|source| Failure::build(&job.name, source))?;
    let fusion_seconds = start.elapsed().as_secs_f64();
    let half_seconds = half.get().map(|then: &Instant| then.duration_since(start).as_secs_f64());
    drop((mesh, bar));
    interrupt::check()?;
    let stored = job.write(&Built::Volume(&build))?;
    let facts = Facts {
        bounding_diagonal,
        read,
        repairs: json!(build.repairs()),
        dropped_distance: build.dropped_distance(),
        stored,
        time: start.elapsed(),
    };
    let outcome = Outcome { build, fusion_seconds, half_seconds, facts };
    Ok(Report { text: outcome.text(job), json: outcome.json() })
}

/// A build that is done.
struct Outcome<'a> {
    build: VolumeBuild,
    /// Time of the fusions.
    fusion_seconds: f64,
    /// Time of the fusions until half of the tetrahedra were gone.
    half_seconds: Option<f64>,
    facts: Facts<'a>,
}

impl Outcome<'_> {
    /// Tetrahedra that a fusion removed on average: of a tetrahedron, and of all.
    #[expect(clippy::cast_precision_loss, reason = "one decimal is printed")]
    fn per_fusion(&self) -> [f64; 2] {
        let history = self.build.history();
        let n_repaired = history.n_alive(0);
        let n_left = history.death.iter().filter(|&&death| death == nephrite::NEVER).count();
        let fusions = self.build.fusions();
        [
            (n_repaired - fusions.n_left_by_tetrahedra) as f64 / fusions.n_tetrahedron_fusions.max(1) as f64,
            (n_repaired - n_left) as f64 / fusions.n_fusions.max(1) as f64,
        ]
    }

    fn deviations(&self) -> Value {
        let deviations = self.build.history().deviations.iter();
        deviations
            .map(|deviation| (deviation.name.clone(), json!(deviation.values.last().copied().unwrap_or(0.0))))
            .collect()
    }

    fn json(&self) -> Value {
        let Self { build, facts, .. } = self;
        let fusions = build.fusions();
        facts.join(json!({
            "tetrahedra_in": build.n_tetrahedra_in(),
            "vertices_in": build.n_vertices_in(),
            "tetrahedra_stored": facts.stored.n_lifetimes,
            "coarsest_tetrahedra": facts.stored.n_coarsest,
            "fusions": fusions.n_fusions,
            "tetrahedron_fusions": fusions.n_tetrahedron_fusions,
            "tetrahedra_left_by_tetrahedron_fusions": fusions.n_left_by_tetrahedra,
            "tetrahedra_per_tetrahedron_fusion": self.per_fusion()[0],
            "tetrahedra_per_fusion": self.per_fusion()[1],
            "deviations": self.deviations(),
            "fusion_seconds": self.fusion_seconds,
            "half_seconds": self.half_seconds,
            "inner_wall_area": build.inner_wall_area(),
        }))
    }

    /// What the repair did, and what walls are inside.
    fn repaired(&self) -> String {
        let mut text = self.facts.repaired();
        if self.build.inner_wall_area() > 0.0 {
            let area = figures::significant(self.build.inner_wall_area());
            text += &format!("; hanging nodes make an inner wall of area {area}");
        }
        text
    }

    fn text(&self, job: &Job<'_>) -> String {
        let Self { build, facts, .. } = self;
        let stored = &facts.stored;
        let fusions = build.fusions();
        let [n_tetrahedra, n_vertices] = [build.n_tetrahedra_in(), build.n_vertices_in()].map(figures::count);
        let [n_coarsest, n_stored] = [stored.n_coarsest, stored.n_lifetimes].map(figures::count);
        let [of_tetrahedra, of_edges] =
            [fusions.n_tetrahedron_fusions, fusions.n_fusions - fusions.n_tetrahedron_fusions]
                .map(figures::count);
        let [per_tetrahedron, per_fusion] = self.per_fusion();
        let list = figures::list(&[
            ("volume", format!("{n_tetrahedra} tetrahedra, {n_vertices} vertices")),
            ("read", figures::reading(facts.read)),
            ("repaired", self.repaired()),
            (
                "fusions",
                format!(
                    "{of_tetrahedra} of tetrahedra, each removes {per_tetrahedron:.1} on average (paper: 13.9 \
                     to 16.1); {of_edges} of edges; average of all {per_fusion:.1}"
                ),
            ),
            ("levels", format!("{}, down to {n_coarsest} tetrahedra", stored.n_levels)),
            ("boundary", format!("within {}, proven", facts.error(stored.max_error))),
            ("stored", format!("{n_stored} tetrahedra in {}", figures::bytes(stored.file_bytes))),
            ("time", figures::time(facts.time)),
        ]);
        format!("{}\n{list}", job.target)
    }
}
