//! `nephrite bench`: the rate at which this machine extracts levels of a file, beside plain copies.

mod memory;

use std::hint::black_box;
use std::io;
use std::path::Path;

use clap::Args;
use nephrite::{CACHE_LEN, Lod, QueryError, Simplex, miss_ratio};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::report::Report;
use crate::streams::Source;
use crate::{figures, files, stopwatch};
use memory::{CacheFlush, forget_file};

/// Measure the rate at which this machine extracts levels of a file, beside plain copies of the
/// same bytes.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File that `build` wrote, or - for standard input
    file: Source,
}

/// Most cuts that are measured, evenly spread in the logarithm of the simplex count.
const N_CUTS: u32 = 12;

/// The cost of one cut.
struct Measured {
    level: u32,
    n_simplices: usize,
    n_runs: usize,
    query_ns: f64,
    extract_per_second: f64,
    parallel_per_second: f64,
    memcpy_per_second: f64,
    /// The same two with cold processor caches.
    far_per_second: f64,
    far_memcpy_per_second: f64,
    /// Vertices transformed per triangle with a cache of 16, drawn as runs and as an ordered copy.
    miss_ratio: f64,
    ordered_miss_ratio: f64,
}

impl Measured {
    /// Rate of extraction divided by that of memcpy.
    fn ratio(&self) -> f64 {
        self.extract_per_second / self.memcpy_per_second
    }

    /// The same out of cache.
    fn far_ratio(&self) -> f64 {
        self.far_per_second / self.far_memcpy_per_second
    }

    fn row(&self) -> [String; 12] {
        [
            self.level.to_string(),
            figures::count(self.n_simplices),
            self.n_runs.to_string(),
            format!("{:.0} ns", self.query_ns),
            format!("{:.0}", self.extract_per_second / 1e6),
            format!("{:.0}", self.memcpy_per_second / 1e6),
            format!("{:.2}", self.ratio()),
            format!("{:.0}", self.far_per_second / 1e6),
            format!("{:.2}", self.far_ratio()),
            format!("{:.0}", self.parallel_per_second / 1e6),
            format!("{:.2}", self.miss_ratio),
            format!("{:.2}", self.ordered_miss_ratio),
        ]
    }

    fn json(&self, simplex: Simplex) -> Value {
        json!({
            "level": self.level,
            (simplex.to_string()): self.n_simplices,
            "runs": self.n_runs,
            "query_ns": self.query_ns,
            (format!("extract_{simplex}_per_second")): self.extract_per_second,
            (format!("memcpy_{simplex}_per_second")): self.memcpy_per_second,
            "ratio": self.ratio(),
            (format!("out_of_cache_{simplex}_per_second")): self.far_per_second,
            (format!("out_of_cache_memcpy_{simplex}_per_second")): self.far_memcpy_per_second,
            "out_of_cache_ratio": self.far_ratio(),
            (format!("parallel_extract_{simplex}_per_second")): self.parallel_per_second,
            "miss_ratio": self.miss_ratio,
            "ordered_miss_ratio": self.ordered_miss_ratio,
        })
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let lod = files::open_lod(&arguments.file)?;
    let failed = |source| Failure::file(arguments.file.to_string(), source);
    let opening = arguments.file.path().map(Opening::measure).transpose().map_err(failed)?;
    let mut flush = CacheFlush::new();
    let mut cuts = Vec::new();
    for level in spread_levels(&lod) {
        let measured = measure(&lod, level, &mut flush);
        cuts.push(measured.map_err(|source| Failure::file(arguments.file.to_string(), source))?);
    }
    let rows: Vec<_> = cuts.iter().map(Measured::row).collect();
    let simplices = lod.simplex().to_string();
    let headings = [
        "level",
        &simplices,
        "runs",
        "query",
        "extract M/s",
        "memcpy M/s",
        "ratio",
        "out of cache M/s",
        "ratio",
        "all threads M/s",
        "misses",
        "ordered",
    ];
    let n_threads = rayon::current_num_threads();
    let legend = format!(
        "M/s: millions of {simplices} per second. All threads: {n_threads}. Misses: vertices transformed per triangle with a cache of {CACHE_LEN} vertices, drawn as runs and \
         as an ordered copy.\n"
    );
    Ok(Report {
        text: figures::table(headings, &rows)
            + &legend
            + &opening.as_ref().map_or(String::new(), Opening::text),
        json: json!({
            "cuts": cuts.iter().map(|cut| cut.json(lod.simplex())).collect::<Vec<_>>(),
            "cache_len": CACHE_LEN,
            "threads": n_threads,
            "open_seconds": opening.as_ref().map(|opening| opening.warm_seconds),
            "cold_open_seconds": opening.and_then(|opening| opening.cold_seconds),
        }),
    })
}

/// Seconds to read the whole file and check its head.
struct Opening {
    /// From the page cache of the system.
    warm_seconds: f64,
    /// From the disk; `None` if the page cache cannot be cleared.
    cold_seconds: Option<f64>,
}

impl Opening {
    fn measure(path: &Path) -> io::Result<Self> {
        let mut open = || _ = black_box(Lod::open(black_box(path)));
        let warm_seconds = stopwatch::alone(&mut open);
        let can_forget = forget_file(path)?;
        let cold_seconds = can_forget.then(|| stopwatch::after(|| _ = forget_file(path), &mut open));
        Ok(Self { warm_seconds, cold_seconds })
    }

    fn text(&self) -> String {
        let cold = self.cold_seconds.map_or("-".to_owned(), |seconds| format!("{:.2} ms", seconds * 1e3));
        format!("Opened by reading it all: {:.2} ms, from the disk {cold}.\n", self.warm_seconds * 1e3)
    }
}

/// Levels whose simplex counts are evenly apart in the logarithm, each once, finest first.
fn spread_levels(lod: &Lod) -> Vec<u32> {
    let [finest, coarsest] =
        [0, lod.n_levels() - 1].map(|level| lod.at_level(level).n_simplices().max(1) as f64);
    let mut levels: Vec<u32> = (0..N_CUTS)
        .map(|cut| {
            let wanted = finest * (coarsest / finest).powf(f64::from(cut) / f64::from(N_CUTS - 1));
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two counts")]
            lod.at_count(wanted.round() as usize).level()
        })
        .collect();
    levels.dedup();
    levels
}

fn measure(lod: &Lod, level: u32, flush: &mut CacheFlush) -> Result<Measured, QueryError> {
    let cut = lod.at_level(level);
    let n_indices = cut.n_indices();
    let [mut extracted, mut copied] = [vec![0; n_indices], vec![0; n_indices]];
    cut.extract_into(&mut extracted)?;
    let source = extracted.clone();
    let [extract_seconds, memcpy_seconds] = stopwatch::in_turn(
        || _ = black_box(cut.extract_into(black_box(&mut extracted))),
        || black_box(&mut copied).copy_from_slice(black_box(&source)),
    );
    let far_seconds =
        stopwatch::after(|| flush.flush(), || _ = black_box(cut.extract_into(black_box(&mut extracted))));
    let far_memcpy_seconds =
        stopwatch::after(|| flush.flush(), || black_box(&mut copied).copy_from_slice(black_box(&source)));
    let error = cut.error();
    let query_seconds = stopwatch::alone(|| {
        for run in lod.at_error(black_box(error)).runs() {
            black_box(run);
        }
    });
    let parallel_seconds =
        stopwatch::alone(|| _ = black_box(cut.par_extract_into(black_box(&mut extracted))));
    let mut ordered_miss_ratio = 0.0;
    if lod.simplex() == Simplex::Triangle {
        cut.extract_ordered_into(&mut copied)?;
        ordered_miss_ratio = miss_ratio(copied.as_chunks().0.iter().copied(), CACHE_LEN);
    }
    let n_simplices = cut.n_simplices();
    Ok(Measured {
        level,
        n_simplices,
        n_runs: cut.n_runs(),
        query_ns: query_seconds * 1e9,
        extract_per_second: n_simplices as f64 / extract_seconds,
        parallel_per_second: n_simplices as f64 / parallel_seconds,
        memcpy_per_second: n_simplices as f64 / memcpy_seconds,
        far_per_second: n_simplices as f64 / far_seconds,
        far_memcpy_per_second: n_simplices as f64 / far_memcpy_seconds,
        miss_ratio: cut.miss_ratio(CACHE_LEN),
        ordered_miss_ratio,
    })
}
