//! Thousands of parts for a database: plates, shells and heat exchangers of 1,000 to 10,000
//! triangles, no two alike.
//!
//! With ten thousand of them, `nephrite build FOLDER --output-dir DB --method progressive` is the
//! task of the paper (W. J. Schroeder, 1997, section 2: 10,000 parts, 100 million triangles a day).

use clap::Parser;
use nephrite::TriangleMesh;
use nephrite::generate::{Drilling, drilled_plate, heat_exchanger, shell};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(about = "Writes many generated parts to a folder")]
struct Arguments {
    /// Folder to write to
    folder: PathBuf,

    /// How many parts
    #[arg(long, default_value_t = 10_000)]
    parts: u32,
}

fn main() -> ExitCode {
    let Arguments { folder, parts } = Arguments::parse();
    if let Err(error) = std::fs::create_dir_all(&folder) {
        eprintln!("parts: {}: {error}", folder.display());
        return ExitCode::FAILURE;
    }
    let mut n_triangles = 0;
    for index in 0..parts {
        let (name, mesh) = part(index);
        n_triangles += mesh.triangles.len();
        if let Err(error) = nephrite_formats::write_mesh(folder.join(format!("{name}-{index:05}.ply")), &mesh)
        {
            eprintln!("parts: {error}");
            return ExitCode::FAILURE;
        }
    }
    println!("{parts} parts, {n_triangles} triangles");
    ExitCode::SUCCESS
}

/// Parts whose sizes fill the range evenly, whatever their number, because they follow multiples of
/// the golden section.
fn part(index: u32) -> (&'static str, TriangleMesh) {
    let share = (f64::from(index) * 0.618_033_988_749_895).fract();
    let wished = 1600.0 + 8300.0 * share;
    let of_squares = |per_square: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most a hundred squares"
        )]
        let n_squares = (wished / per_square) as u32;
        let columns = n_squares.isqrt().max(1) + index % 2;
        [columns, (n_squares / columns).max(1)]
    };
    match index % 3 {
        0 => {
            let segments = 24 + 4 * (index % 5);
            let [columns, rows] = of_squares(f64::from(4 * segments + 12));
            ("plate", drilled_plate(&Drilling::of_every_square(columns, rows, segments)))
        }
        1 => {
            let segments = 12 + 4 * (index % 4);
            let [columns, rows] = of_squares(f64::from(5 * segments + 48));
            let holes = columns * rows - index % 4;
            ("shell", shell(&Drilling { columns, rows, holes, segments, ..Drilling::SHELL }))
        }
        _ => {
            let segments = 8 + 4 * (index % 4);
            let [columns, rows] = of_squares(f64::from(8 * segments + 24));
            ("heat-exchanger", heat_exchanger(columns, rows, segments))
        }
    }
}
