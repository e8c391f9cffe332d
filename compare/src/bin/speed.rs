//! The whole certified history beside a chain of halvings by meshoptimizer, and the memory of both.
//!
//! The chain simplifies to half the triangles, then the result to half of its triangles, down to
//! 64: what an engine does to get its levels. Both run in this process, in turn, and medians are
//! compared; meshoptimizer uses one thread. Memory is measured in a separate process for each: the
//! peak of the resident memory, less what was resident when the process began and less the mesh.
//! Memory is measured on Linux only.

use clap::{Parser, ValueEnum};
use nephrite::{BuildError, BuildOptions, TriangleMesh};
use nephrite_compare::chain::chain_of_halvings;
use nephrite_compare::{CompareError, Table, load, stopwatch::in_turn};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Duration;

#[derive(Debug, Parser)]
#[command(about = "Time and memory beside meshoptimizer's chain of halvings, as Markdown")]
struct Arguments {
    /// Meshes to simplify
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Samples of which the median is taken
    #[arg(long, default_value_t = 5)]
    repeats: usize,

    /// Print the memory that simplifying the first mesh takes, in bytes, and nothing else
    #[arg(long, value_enum, hide = true)]
    memory_of: Option<System>,
}

/// Who simplifies.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum System {
    Nephrite,
    Meshoptimizer,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match (arguments.memory_of, arguments.meshes.first()) {
        (Some(system), Some(path)) => print_memory(system, path),
        _ => compare(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("speed: {error}");
            ExitCode::FAILURE
        }
    }
}

fn compare(arguments: &Arguments) -> Result<(), CompareError> {
    let [one, two] = [pool(1)?, pool(2)?];
    let mut table = Table::new([
        "mesh",
        "triangles",
        "chain, levels",
        "chain",
        "history, 1 thread",
        "/ chain",
        "history, 2 threads",
        "/ chain",
        "2 threads gain",
        "bytes / vertex",
        "chain, bytes / vertex",
    ]);
    for path in &arguments.meshes {
        let mesh = load(path)?;
        history(&mesh)?;
        let n_levels = chain_of_halvings(&mesh)?.len();
        let seconds = in_turn(
            arguments.repeats,
            Duration::ZERO,
            &mut [
                &mut || _ = black_box(chain_of_halvings(&mesh)),
                &mut || _ = black_box(one.install(|| history(&mesh))),
                &mut || _ = black_box(two.install(|| history(&mesh))),
            ],
        );
        let per_vertex = |system| -> Result<String, CompareError> {
            let bytes = memory_in_own_process(system, path)?;
            Ok(bytes.map_or("-".to_owned(), |bytes| format!("{:.0}", bytes / mesh.positions.len() as f64)))
        };
        table.push([
            path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            mesh.triangles.len().to_string(),
            n_levels.to_string(),
            format!("{:.3} s", seconds[0]),
            format!("{:.3} s", seconds[1]),
            format!("{:.1}", seconds[1] / seconds[0]),
            format!("{:.3} s", seconds[2]),
            format!("{:.1}", seconds[2] / seconds[0]),
            format!("{:.2}", seconds[1] / seconds[2]),
            per_vertex(System::Nephrite)?,
            per_vertex(System::Meshoptimizer)?,
        ]);
    }
    println!("{table}");
    Ok(())
}

fn pool(n_threads: usize) -> Result<ThreadPool, CompareError> {
    Ok(ThreadPoolBuilder::new().num_threads(n_threads).build()?)
}

/// All levels with a proven error; returns their number.
fn history(mesh: &TriangleMesh) -> Result<usize, BuildError> {
    let build = nephrite::build(mesh, &BuildOptions::default())?;
    Ok(build.history().errors.len())
}

/// Memory of simplifying a mesh beside the mesh itself, in bytes; `None` if the system does not
/// tell.
fn memory_in_own_process(system: System, path: &Path) -> Result<Option<f64>, CompareError> {
    let name = match system {
        System::Nephrite => "nephrite",
        System::Meshoptimizer => "meshoptimizer",
    };
    let program = std::env::current_exe()?;
    let output = Command::new(program).arg("--memory-of").arg(name).arg(path).output()?;
    if !output.status.success() {
        let what = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(CompareError::Process { what });
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().parse().ok())
}

fn print_memory(system: System, path: &Path) -> Result<(), CompareError> {
    let Some(at_start) = resident_bytes("VmRSS:") else { return Ok(()) };
    let mesh = load(path)?;
    let mesh_bytes = size_of_val(&mesh.positions[..]) + size_of_val(&mesh.triangles[..]);
    // So far the peak is that of the reader; this resets it to what is resident now
    // (proc_pid_clear_refs(5)).
    std::fs::write("/proc/self/clear_refs", "5")?;
    match system {
        System::Nephrite => {
            _ = black_box(nephrite::build(mesh, &BuildOptions::default())?);
        }
        System::Meshoptimizer => _ = black_box(chain_of_halvings(&mesh)?),
    }
    if let Some(peak) = resident_bytes("VmHWM:") {
        println!("{}", peak - at_start - mesh_bytes as f64);
    }
    Ok(())
}

/// A line of this process's status.
fn resident_bytes(key: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(key))?;
    let kibibytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(1024.0 * kibibytes)
}
