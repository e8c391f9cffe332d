//! The table of the progressive decimator's paper (W. J. Schroeder, 1997, figure 7) with similar
//! parts.
//!
//! The shell, the plate and the heat exchanger are generated with the paper's numbers of triangles,
//! or close to them; the paper's meshes were never published. For the plates, the last meshes
//! before nothing are listed too.

use clap::Parser;
use nephrite::generate::{Drilling, drilled_plate, heat_exchanger, shell};
use nephrite::{Build, NEVER, TriangleMesh};
use nephrite_compare::{CompareError, Table, decimate_progressively};
use std::process::ExitCode;
use std::time::Instant;

#[derive(Debug, Parser)]
#[command(about = "Collapses and splits beside those of the progressive decimator's paper, as Markdown")]
struct Arguments {}

const REDUCTIONS: [f64; 4] = [0.5, 0.75, 0.9, 1.0];

/// A part, and the figures of the paper.
struct Part {
    name: &'static str,
    mesh: TriangleMesh,
    triangles: usize,
    /// Collapses and splits at each reduction.
    operations: [[usize; 2]; 4],
}

fn parts() -> [Part; 3] {
    [
        Part {
            name: "shell",
            mesh: shell(&Drilling::SHELL),
            triangles: 1132,
            operations: [[319, 0], [494, 0], [557, 0], [648, 0]],
        },
        Part {
            name: "plate",
            mesh: drilled_plate(&Drilling::PLATE),
            triangles: 2624,
            operations: [[656, 0], [984, 0], [1228, 169], [1457, 221]],
        },
        Part {
            name: "heat exchanger",
            mesh: heat_exchanger(15, 5, 16),
            triangles: 11_006,
            operations: [[2759, 0], [4139, 0], [5447, 914], [6355, 1160]],
        },
    ]
}

fn main() -> ExitCode {
    let Arguments {} = Arguments::parse();
    let printed = parts().iter().try_for_each(print_part).and_then(|()| print_last_stages());
    match printed {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("figure7: {error}");
            ExitCode::FAILURE
        }
    }
}

fn print_part(part: &Part) -> Result<(), CompareError> {
    let n_in = part.mesh.triangles.len();
    println!("\n{}: {n_in} triangles, the paper's {}\n", part.name, part.triangles);
    let mut table = Table::new([
        "reduction",
        "left",
        "collapses",
        "paper",
        "splits",
        "paper",
        "merges",
        "pre-split: left",
        "collapses",
        "splits",
        "ms",
    ]);
    for (reduction, [collapses, splits]) in REDUCTIONS.into_iter().zip(part.operations) {
        let start = Instant::now();
        let plain = decimate_progressively(&part.mesh, reduction, false)?;
        let milliseconds = 1e3 * start.elapsed().as_secs_f64();
        let split = decimate_progressively(&part.mesh, reduction, true)?;
        let counts = |build: &Build| build.progressive().map(|report| report.counts).unwrap_or_default();
        let left = |build: &Build| build.history().death.iter().filter(|&&death| death == NEVER).count();
        table.push([
            format!("{reduction:.2}"),
            left(&plain).to_string(),
            counts(&plain).collapses.to_string(),
            collapses.to_string(),
            counts(&plain).splits.to_string(),
            splits.to_string(),
            counts(&plain).merges.to_string(),
            left(&split).to_string(),
            counts(&split).collapses.to_string(),
            counts(&split).splits.to_string(),
            format!("{milliseconds:.1}"),
        ]);
    }
    println!("{table}");
    Ok(())
}

/// Prints how many triangles of which face are left of pre-split plates just before nothing is
/// left.
fn print_last_stages() -> Result<(), CompareError> {
    for (name, drilling, paper) in
        [("plate with seven holes", Drilling::PLATE, 4), ("plate with one hole", Drilling::WASHER, 4)]
    {
        let mesh = drilled_plate(&drilling);
        let n_in = mesh.triangles.len();
        let left = 1.0 - (paper as f64 + 0.5) / n_in as f64;
        let build = decimate_progressively(&mesh, left, true)?;
        let mut by_face = [0; 3];
        let alive = build.history().simplices.iter().zip(&build.history().death);
        for (triangle, _) in alive.filter(|&(_, &death)| death == NEVER) {
            let heights = triangle.map(|v| build.vertices().positions[v as usize][2].to_bits());
            let face = if heights[0] != heights[1] || heights[1] != heights[2] {
                2
            } else {
                usize::from(heights[0] == 0)
            };
            by_face[face] += 1;
        }
        let [above, below, between] = by_face;
        println!(
            "{name}, {n_in} triangles: {above} of the upper face, {below} of the lower and {between} others before nothing"
        );
    }
    Ok(())
}
