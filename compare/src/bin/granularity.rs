//! Levels and memory beside meshoptimizer's chain of halvings.
//!
//! An engine that keeps a chain stores one index list per level and draws, for a budget of
//! triangles, the finest level that fits. The unused part of the budget is the price of few levels,
//! averaged over budgets that are evenly spread on a logarithmic scale from the end of the chain to
//! the input. The bytes of all index lists are the price of many levels. Both share one vertex
//! buffer.

use clap::Parser;
use nephrite::{BuildOptions, Lod, StoreOptions};
use nephrite_compare::chain::{CHAIN_END, chain_of_halvings};
use nephrite_compare::{CompareError, Table, load};
use std::io::Cursor;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(about = "Levels and memory beside meshoptimizer's chain of halvings, as Markdown")]
struct Arguments {
    /// Meshes to simplify
    #[arg(required = true)]
    meshes: Vec<PathBuf>,
}

/// Number of budgets over which the loss is averaged.
const N_BUDGETS: u32 = 4096;

/// Levels per window; `None` for whole lifetimes.
const WINDOWS: [Option<u32>; 3] = [None, Some(16), Some(8)];

/// Cuts whose vertex transforms are counted, as parts of the triangles of the input.
const PARTS: [f64; 3] = [0.5, 0.1, 0.01];

/// Vertices that the cache holds.
const CACHE_LEN: u32 = 16;

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("granularity: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), CompareError> {
    let mut table = Table::new([
        "mesh",
        "what",
        "levels",
        "index bytes / input triangle",
        "file, bytes / input triangle",
        "compact file",
        "budget lost",
        "most runs",
        "ACMR at 50 / 10 / 1 %",
    ]);
    for path in &arguments.meshes {
        let mesh = load(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let n_triangles = mesh.triangles.len() as f64;
        let chain = chain_of_halvings(&mesh)?;
        table.push([
            name.clone(),
            "chain of halvings".to_owned(),
            chain.len().to_string(),
            format!("{:.1}", 12.0 * chain.iter().sum::<usize>() as f64 / n_triangles),
            "-".to_owned(),
            "-".to_owned(),
            percent(mean_loss(&chain)),
            "1".to_owned(),
            "-".to_owned(),
        ]);
        let build = nephrite::build(&mesh, &BuildOptions::default())?;
        for window_levels in WINDOWS {
            let bytes = |is_compact| -> Result<Vec<u8>, CompareError> {
                let options = StoreOptions { window_levels, is_compact, ..StoreOptions::default() };
                let mut file = Cursor::new(vec![]);
                build.write_to(&mut file, &options)?;
                Ok(file.into_inner())
            };
            let (plain, compact) = (bytes(false)?, bytes(true)?);
            let lod = Lod::from_bytes(&plain)?;
            let counts: Vec<usize> =
                (0..lod.n_levels()).map(|level| lod.at_level(level).n_simplices()).collect();
            let most_runs = (0..lod.n_levels()).map(|level| lod.at_level(level).n_runs()).max();
            table.push([
                name.clone(),
                window_levels
                    .map_or("nephrite".to_owned(), |levels| format!("nephrite, windows of {levels}")),
                lod.n_levels().to_string(),
                format!("{:.1}", size_of_val(lod.indices()) as f64 / n_triangles),
                format!("{:.1}", plain.len() as f64 / n_triangles),
                format!("{:.1}", compact.len() as f64 / n_triangles),
                percent(mean_loss(&counts)),
                most_runs.unwrap_or(0).to_string(),
                miss_ratios(&lod, n_triangles),
            ]);
        }
    }
    println!("{table}");
    Ok(())
}

/// Average unused part of a budget; `counts` are the triangles of the levels, finest first.
fn mean_loss(counts: &[usize]) -> f64 {
    let [finest, coarsest] =
        [counts.first(), Some(&CHAIN_END)].map(|n| n.copied().unwrap_or(1).max(1) as f64);
    let losses = (0..N_BUDGETS).map(|i| {
        let budget = coarsest * (finest / coarsest).powf((f64::from(i) + 0.5) / f64::from(N_BUDGETS));
        let drawn = counts.iter().copied().find(|&count| count as f64 <= budget).unwrap_or(0);
        1.0 - drawn as f64 / budget
    });
    losses.sum::<f64>() / f64::from(N_BUDGETS)
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "parts of a count")]
fn miss_ratios(lod: &Lod, n_triangles: f64) -> String {
    PARTS
        .map(|part| {
            let cut = lod.at_count((part * n_triangles) as usize);
            format!("{:.2}", cut.miss_ratio(CACHE_LEN))
        })
        .join(" / ")
}
