//! Triangles at a given error, and error at a given triangle count, beside the figures of other
//! systems.
//!
//! Bunny, fandisk and the cosine surface are simplified to the end in three ways: under the
//! certified bound with fixed and with moving vertices, and under the paper's joint estimate. Every
//! step is kept as a level. Each row extracts one level and measures it against the input. Prints
//! Markdown.

use clap::Parser;
use nephrite::measure::{Distance, MeasureOptions, measure};
use nephrite::{BuildOptions, Cut, EstimateKind, JadeOptions, Placement, TriangleMesh, generate};
use nephrite_compare::anchors::{AT_ERROR, AT_TRIANGLES, AtError, AtTriangles, Simplified, Subject};
use nephrite_compare::statistics::geometric_mean;
use nephrite_compare::{Build, CompareError, KeptLevels, Table, build_lod, load};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(about = "Errors and triangle counts beside published figures, as Markdown")]
struct Arguments {
    /// Folder that holds bunny_34834_le.ply and fandisk_le.ply
    #[arg(default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/surfaces"))]
    meshes: PathBuf,

    /// Samples on the edges, and as many in the triangles, of each surface
    #[arg(long, default_value_t = 1_000_000)]
    samples: usize,
}

/// A surface and all its levels, built in three ways.
struct Study {
    subject: Subject,
    mesh: TriangleMesh,
    certified: Build,
    /// Certified as well, with vertices where the error is least.
    moved: Build,
    joint: Build,
    options: MeasureOptions,
}

/// One level, measured; errors in percent of the diagonal.
struct Level {
    n_triangles: usize,
    stated: f64,
    measured: f64,
}

impl Study {
    fn new(subject: Subject, arguments: &Arguments) -> Result<Self, CompareError> {
        let mesh = surface(subject, &arguments.meshes)?;
        let build = |jade| build_lod(&mesh, &BuildOptions::with(jade), KeptLevels::All);
        let certified = build(JadeOptions::certified(Placement::Original))?;
        let moved = build(JadeOptions::certified(Placement::Best))?;
        let joint = build(JadeOptions::estimate(EstimateKind::Joint))?;
        let options = MeasureOptions { n_samples: arguments.samples, ..MeasureOptions::default() };
        Ok(Self { subject, certified, moved, joint, options, mesh })
    }

    fn at_error(&self, build: &Build, percent: f64) -> Result<Level, CompareError> {
        self.level(build.lod.at_error(percent / 100.0 * nephrite::bounding_diagonal(&self.mesh)))
    }

    fn level(&self, cut: Cut<'_>) -> Result<Level, CompareError> {
        let Distance { max, bounding_diagonal, .. } = measure(&self.mesh, &cut.to_mesh()?, &self.options)?;
        let percent = |length| 100.0 * length / bounding_diagonal;
        Ok(Level { n_triangles: cut.n_simplices(), stated: percent(cut.error()), measured: percent(max) })
    }
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("tables: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), CompareError> {
    let studies = Subject::ALL
        .into_iter()
        .map(|subject| Study::new(subject, arguments))
        .collect::<Result<Vec<_>, _>>()?;
    for study in &studies {
        println!(
            "{}: {} levels in {:.2} s certified, {:.2} s with the best placement, {:.2} s joint, on {} threads",
            study.subject.name(),
            study.certified.lod.n_levels(),
            study.certified.seconds,
            study.moved.seconds,
            study.joint.seconds,
            rayon::current_num_threads(),
        );
    }
    println!(
        "\nTriangles needed at a given error; in brackets the largest two-sided error measured, in percent\n"
    );
    print_at_error(&studies)?;
    println!("\nLargest two-sided error measured at a given number of triangles, in percent\n");
    print_at_triangles(&studies)
}

fn surface(subject: Subject, folder: &Path) -> Result<TriangleMesh, CompareError> {
    match subject {
        Subject::Bunny => load(&folder.join("bunny_34834_le.ply")),
        Subject::Fandisk => load(&folder.join("fandisk_le.ply")),
        Subject::Cosine => Ok(generate::cosine(120)),
    }
}

/// The rows that belong to each study.
fn rows_of<'a, Row>(
    studies: &'a [Study],
    rows: &'a [Row],
    subject_of: fn(&Row) -> Subject,
) -> impl Iterator<Item = (&'a Study, &'a Row)> {
    let belongs = move |study: &Study, row: &Row| study.subject == subject_of(row);
    studies.iter().flat_map(move |study| {
        rows.iter().filter(move |&row| belongs(study, row)).map(move |row| (study, row))
    })
}

fn print_at_error(studies: &[Study]) -> Result<(), CompareError> {
    let mut table = Table::new([
        "mesh",
        "error",
        "JADE paper",
        "CGAL envelope",
        "certified",
        "stated",
        "certified / JADE",
        "best placement",
        "best placement / JADE",
        "joint estimate",
    ]);
    let (mut ratios, mut moved_ratios) = (vec![], vec![]);
    for (study, row) in rows_of(studies, &AT_ERROR, |row: &AtError| row.subject) {
        let certified = study.at_error(&study.certified, row.error)?;
        let moved = study.at_error(&study.moved, row.error)?;
        let joint = study.at_error(&study.joint, row.error)?;
        let to_jade =
            |level: &Level| row.jade.map(|jade| level.n_triangles as f64 / f64::from(jade.n_triangles));
        ratios.extend(to_jade(&certified));
        moved_ratios.extend(to_jade(&moved));
        let as_text = |ratio: Option<f64>| ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.3}"));
        table.push([
            study.subject.name().to_owned(),
            format!("{:.2} %", row.error),
            other(row.jade, row.error),
            other(row.cgal_envelope, row.error),
            ours(&certified),
            format!("{:.4}", certified.stated),
            as_text(to_jade(&certified)),
            ours(&moved),
            as_text(to_jade(&moved)),
            ours(&joint),
        ]);
    }
    println!("{table}");
    println!("certified / JADE, geometric mean: {:.3}", geometric_mean(&ratios));
    println!("best placement / JADE, geometric mean: {:.3}", geometric_mean(&moved_ratios));
    Ok(())
}

fn other(simplified: Option<Simplified>, error: f64) -> String {
    simplified.map_or("-".to_owned(), |Simplified { n_triangles, measured }| {
        let broken = if measured > error { ", exceeded" } else { "" };
        format!("{n_triangles} ({measured:.3}{broken})")
    })
}

fn ours(level: &Level) -> String {
    format!("{} ({:.4})", level.n_triangles, level.measured)
}

fn print_at_triangles(studies: &[Study]) -> Result<(), CompareError> {
    let mut table = Table::new([
        "mesh",
        "triangles",
        "JADE paper",
        "best other",
        "which",
        "certified",
        "stated",
        "certified / best",
        "best placement",
        "best placement / best",
        "joint estimate",
    ]);
    let (mut ratios, mut moved_ratios) = (vec![], vec![]);
    for (study, row) in rows_of(studies, &AT_TRIANGLES, |row: &AtTriangles| row.subject) {
        let n_triangles = row.n_triangles as usize;
        let certified = study.level(study.certified.lod.at_count(n_triangles))?;
        let moved = study.level(study.moved.lod.at_count(n_triangles))?;
        let joint = study.level(study.joint.lod.at_count(n_triangles))?;
        let (which, best) = row.best();
        ratios.push(certified.measured / best);
        moved_ratios.push(moved.measured / best);
        let jade = row.errors[0];
        table.push([
            study.subject.name().to_owned(),
            n_triangles.to_string(),
            if jade.is_nan() { "-".to_owned() } else { jade.to_string() },
            best.to_string(),
            which.to_owned(),
            format!("{:.4}", certified.measured),
            format!("{:.4}", certified.stated),
            format!("{:.3}", certified.measured / best),
            format!("{:.4}", moved.measured),
            format!("{:.3}", moved.measured / best),
            format!("{:.4}", joint.measured),
        ]);
    }
    println!("{table}");
    println!("certified / best, geometric mean: {:.3}", geometric_mean(&ratios));
    println!("best placement / best, geometric mean: {:.3}", geometric_mean(&moved_ratios));
    Ok(())
}
