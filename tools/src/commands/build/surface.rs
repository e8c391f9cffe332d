//! A surface built with JADE or the progressive decimator.

use std::time::Instant;

use nephrite::{Build, TriangleMesh, check_attributes};
use nephrite_formats::FileReport;
use serde_json::{Value, json};

use super::facts::Facts;
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
    let facts = Facts {
        bounding_diagonal,
        read,
        repairs: json!(build.repairs()),
        dropped_distance: build.dropped_distance(),
        stored,
        time: start.elapsed(),
    };
    let outcome = Outcome { build, facts };
    Ok(Report { text: outcome.text(job), json: outcome.json() })
}

/// A build that is done.
struct Outcome<'a> {
    build: Build,
    facts: Facts<'a>,
}

impl Outcome<'_> {
    fn json(&self) -> Value {
        let Self { build, facts } = self;
        facts.join(json!({
            "triangles_in": build.n_triangles_in(),
            "vertices_in": build.n_vertices_in(),
            "triangles_stored": facts.stored.n_lifetimes,
            "coarsest_triangles": facts.stored.n_coarsest,
            "certified_triangles": build.n_certified_triangles(),
            "operations": build.progressive().map(|report| &report.counts),
        }))
    }

    fn text(&self, job: &Job<'_>) -> String {
        let Self { build, facts } = self;
        let stored = &facts.stored;
        let [n_triangles, n_vertices] = [build.n_triangles_in(), build.n_vertices_in()].map(figures::count);
        let n_coarsest = figures::count(stored.n_coarsest);
        let n_stored = figures::count(stored.n_lifetimes);
        let list = figures::list(&[
            ("mesh", format!("{n_triangles} triangles, {n_vertices} vertices")),
            ("read", figures::reading(facts.read)),
            ("repaired", facts.repaired()),
            ("levels", format!("{}, down to {n_coarsest} triangles", stored.n_levels)),
            ("error", format!("up to {}", facts.error(stored.max_error))),
            ("stored", format!("{n_stored} triangles in {}", figures::bytes(stored.file_bytes))),
            ("time", figures::time(facts.time)),
        ]);
        format!("{}\n{list}", job.target)
    }
}
