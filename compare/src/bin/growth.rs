//! Does finding a cut get slower as histories grow? Synthetic lifetimes, from ten thousand to a
//! hundred million.
//!
//! Each query is timed by itself, clock included, as a renderer asks it: a random error, its level
//! by binary search in the error table, and the runs of that level read once. A hundred million
//! lifetimes take some 1.5 GB of memory and half a minute.

use clap::Parser;
use nephrite::TreeError;
use nephrite::internals::{Layout, Tree};
use nephrite_compare::Table;
use nephrite_compare::lifetimes::{SyntheticLifetimes, even};
use nephrite_compare::statistics::percentile;
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

#[derive(Debug, Parser)]
#[command(about = "Query time as histories grow, as Markdown")]
struct Arguments {
    /// Lifetimes of each history
    #[arg(default_values_t = [10_000, 100_000, 1_000_000, 10_000_000, 100_000_000])]
    n_lifetimes: Vec<u32>,

    /// Queries of each history
    #[arg(long, default_value_t = 200_000)]
    queries: u32,
}

/// Lifetimes per level: a decimator that records every step has some 6, a file with the usual
/// levels thousands.
const LIFETIMES_PER_LEVEL: u32 = 100;

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("growth: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), TreeError> {
    let mut table =
        Table::new(["lifetimes", "levels", "most runs", "mean runs", "median", "99th percentile", "slowest"]);
    for &n_lifetimes in &arguments.n_lifetimes {
        table.push(row(n_lifetimes, arguments.queries)?);
    }
    println!("{table}");
    Ok(())
}

fn row(n_lifetimes: u32, n_queries: u32) -> Result<[String; 7], TreeError> {
    let n_levels = (n_lifetimes / LIFETIMES_PER_LEVEL).max(1);
    let lives = SyntheticLifetimes { n_levels };
    let layout = Layout::build(n_levels, n_lifetimes, |id| lives.lifetime(id))?;
    let n_slots = u32::try_from(layout.slots().len()).unwrap_or(u32::MAX);
    let (offsets, runs) = layout.runs();
    drop(layout);
    let tree = Tree::new(&offsets, &runs, n_slots);
    let errors: Vec<f64> = (0..n_levels).map(|level| f64::from(level).powi(2)).collect();
    let largest = errors.last().copied().unwrap_or(0.0);

    let mut nanoseconds = Vec::with_capacity(n_queries as usize);
    let (mut most_runs, mut n_runs) = (0, 0);
    for query in 0..n_queries {
        let error = black_box(even(u64::from(query)).powi(2) * largest);
        let start = Instant::now();
        let level = errors.partition_point(|&stated| stated <= error).saturating_sub(1);
        let found = tree.stab(u32::try_from(level).unwrap_or(u32::MAX));
        let count = found.fold(0, |count, run| count + usize::from(black_box(run).len > 0));
        nanoseconds.push(start.elapsed().as_secs_f64() * 1e9);
        most_runs = most_runs.max(count);
        n_runs += count;
    }
    let at = |part| format!("{:.0} ns", percentile(&nanoseconds, part));
    Ok([
        n_lifetimes.to_string(),
        n_levels.to_string(),
        most_runs.to_string(),
        format!("{:.1}", n_runs as f64 / f64::from(n_queries)),
        at(0.5),
        at(0.99),
        at(1.0),
    ])
}
