//! A surface built with JADE or the progressive decimator.

use std::time::{Duration, Instant};

use nephrite::{Build, StoreReport, TriangleMesh, check_attributes};
use nephrite_formats::FileReport;
use serde_json::{Value, json};

use super::job::{Built, Job};
use crate::failure::Failure;
use crate::report::Report;
use crate::{figures, interrupt};

/// Decimates a surface and writes the file.
pub(super) fn run(job: &Job<'_>, mesh: TriangleMesh, read: &FileReport) -> Result<Report, Failure> {
    let start = Instant::now();
    check_attributes(&mesh).map_err(|source| job.failed(source))?;
    let bounding_diagonal = nephrite::bounding_diagonal(&mesh);
    let options = job.arguments.options(bounding_diagonal)?;
    let bar = job.bar(bounding_diagonal);
    let build = nephrite::build_with(mesh, &options, &|progress| bar.observe(progress))
        .map_err(|source| Failure::build(&job.name, source))?;
    drop(bar);
    interrupt::check()?;
    let stored = job.write(&Built::Surface(&build))?;
    let outcome = Outcome { bounding_diagonal, read, build, stored, time: start.elapsed() };
    Ok(Report { text: outcome.text(job), json: outcome.json() })
}

/// A build that is done.
struct Outcome<'a> {
    /// In mesh units.
    bounding_diagonal: f64,
    read: &'a FileReport,
    build: Build,
    stored: StoreReport,
    time: Duration,
}

impl Outcome<'_> {
    fn json(&self) -> Value {
        let Self { build, stored, .. } = self;
        json!({
            "triangles_in": build.n_triangles_in(),
            "vertices_in": build.n_vertices_in(),
            "triangles_stored": stored.n_lifetimes,
            "levels": stored.n_levels,
            "coarsest_triangles": stored.n_coarsest,
            "max_error": stored.max_error,
            "bounding_diagonal": self.bounding_diagonal,
            "seconds": self.time.as_secs_f64(),
            "file_bytes": stored.file_bytes,
            "reading": self.read,
            "notes": self.read.notes(),
            "repairs": build.repairs(),
            "dropped_distance": build.dropped_distance(),
            "certified_triangles": build.n_certified_triangles(),
            "operations": build.progressive().map(|report| &report.counts),
        })
    }

    /// What the repair did, and how far what it dropped lies from the rest.
    fn repaired(&self) -> String {
        let tally = figures::tally(&json!(self.build.repairs()));
        if self.build.dropped_distance() > 0.0 {
            let distance = figures::error(self.build.dropped_distance(), self.bounding_diagonal);
            format!("{tally}; what was dropped lies up to {distance} from the rest, which every error counts")
        } else {
            tally
        }
    }

    fn text(&self, job: &Job<'_>) -> String {
        let Self { build, stored, .. } = self;
        let [n_triangles, n_vertices] = [build.n_triangles_in(), build.n_vertices_in()].map(figures::count);
        let n_coarsest = figures::count(stored.n_coarsest);
        let n_stored = figures::count(stored.n_lifetimes);
        let list = figures::list(&[
            ("mesh", format!("{n_triangles} triangles, {n_vertices} vertices")),
            ("read", figures::reading(self.read)),
            ("repaired", self.repaired()),
            ("levels", format!("{}, down to {n_coarsest} triangles", stored.n_levels)),
            ("error", format!("up to {}", figures::error(stored.max_error, self.bounding_diagonal))),
            ("stored", format!("{n_stored} triangles in {}", figures::bytes(stored.file_bytes))),
            ("time", figures::time(self.time)),
        ]);
        format!("{}\n{list}", job.target)
    }
}
