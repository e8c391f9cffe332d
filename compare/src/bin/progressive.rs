//! Progressive decimation in the rows of figure 7 of its paper, the operation stream, and the time
//! of vtkDecimatePro.
//!
//! vtkDecimatePro is the implementation by the author of the paper. It is called through Python
//! (`pip install vtk`), in turn with ours. Of VTK only the time of `Update` counts; ours includes
//! repair, decimation and the record of the whole history.

use clap::Parser;
use nephrite::{Build, ProgressiveMesh, StreamError, TriangleMesh};
use nephrite_compare::statistics::median;
use nephrite_compare::{Table, decimate_progressively, load};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

#[derive(Debug, Parser)]
#[command(about = "Progressive decimation beside its paper and vtkDecimatePro, as Markdown")]
struct Arguments {
    /// Meshes to simplify; PLY where vtkDecimatePro is to read them
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Split along feature edges before anything else
    #[arg(long)]
    pre_split: bool,

    /// Python that has vtk; without it vtkDecimatePro is left out
    #[arg(long)]
    python: Option<PathBuf>,

    /// Samples of which the median is taken
    #[arg(long, default_value_t = 5)]
    repeats: usize,
}

/// The reductions of the paper's table.
const REDUCTIONS: [f64; 4] = [0.5, 0.75, 0.9, 1.0];
/// Reads a mesh, decimates it and prints the seconds that this took.
const VTK: &str = "
import sys, time, vtk
reader = vtk.vtkPLYReader(); reader.SetFileName(sys.argv[1]); reader.Update()
decimate = vtk.vtkDecimatePro(); decimate.SetInputData(reader.GetOutput())
decimate.SetTargetReduction(float(sys.argv[2])); decimate.BoundaryVertexDeletionOn()
start = time.perf_counter(); decimate.Update(); print(time.perf_counter() - start)
";

/// Reads a mesh and prints the sizes that Draco gives, from its usual quantisation to the finest.
const DRACO: &str = "
import sys, vtk, DracoPy
from vtk.util.numpy_support import vtk_to_numpy
reader = vtk.vtkPLYReader(); reader.SetFileName(sys.argv[1]); reader.Update(); mesh = reader.GetOutput()
points = vtk_to_numpy(mesh.GetPoints().GetData())
faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype('uint32')
for bits in (11, 14, 22, 30):
    print(bits, len(DracoPy.encode(points, faces, quantization_bits=bits, compression_level=7)))
";

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    for path in &arguments.meshes {
        if let Err(error) = compare(path, &arguments) {
            eprintln!("progressive: {}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn compare(path: &Path, arguments: &Arguments) -> Result<(), Box<dyn std::error::Error>> {
    let mesh = load(path)?;
    println!("\n{}: {} triangles\n", path.display(), mesh.triangles.len());
    let mut table = Table::new(["reduction", "collapses", "splits", "merges", "seconds", "vtkDecimatePro"]);
    for reduction in REDUCTIONS {
        let (mut ours, mut theirs, mut counts) = (vec![], vec![], None);
        for _ in 0..arguments.repeats {
            let start = Instant::now();
            let build = decimate_progressively(&mesh, reduction, arguments.pre_split)?;
            ours.push(start.elapsed().as_secs_f64());
            counts = build.progressive().map(|report| report.counts);
            if let Some(python) = &arguments.python {
                theirs.push(vtk_seconds(python, path, reduction)?);
            }
        }
        let counts = counts.unwrap_or_default();
        let theirs = if theirs.is_empty() { "-".to_owned() } else { format!("{:.3}", median(&theirs)) };
        table.push([
            format!("{reduction:.2}"),
            counts.collapses.to_string(),
            counts.splits.to_string(),
            counts.merges.to_string(),
            format!("{:.3}", median(&ours)),
            theirs,
        ]);
    }
    println!("{table}");
    let build = decimate_progressively(&mesh, 1.0, arguments.pre_split)?;
    print_stream(&build, arguments.repeats)?;
    print_codecs(&mesh, path, arguments.python.as_deref())
}

/// Sizes that other codecs give for the same triangles and positions, in bits per vertex.
/// meshoptimizer's codecs keep every bit, in the order that suits them best. Draco quantises the
/// positions and gives one level; it is called through Python (`pip install DracoPy`).
fn print_codecs(
    mesh: &TriangleMesh,
    path: &Path,
    python: Option<&Path>,
) -> Result<(), Box<dyn std::error::Error>> {
    let n_vertices = mesh.positions.len();
    let bits = |n_bytes: usize| 8.0 * n_bytes as f64 / n_vertices as f64;
    let mut indices = meshopt::optimize_vertex_cache(mesh.triangles.as_flattened(), n_vertices);
    let positions = meshopt::optimize_vertex_fetch(&mut indices, &mesh.positions);
    let connectivity = meshopt::encode_index_buffer(&indices, positions.len())?.len();
    let geometry = meshopt::encode_vertex_buffer(&positions)?.len();
    println!(
        "meshoptimizer: {:.1} bits per vertex ({:.1} of indices, {:.1} of positions), lossless",
        bits(connectivity + geometry),
        bits(connectivity),
        bits(geometry)
    );
    if let Some(python) = python {
        let output = Command::new(python).args(["-c", DRACO]).arg(path).output()?;
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            if let Some((quantization, n_bytes)) = line.split_once(' ') {
                println!(
                    "Draco: {:.1} bits per vertex at {quantization} bits a coordinate",
                    bits(n_bytes.parse()?)
                );
            }
        }
    }
    Ok(())
}

fn vtk_seconds(python: &Path, mesh: &Path, reduction: f64) -> Result<f64, Box<dyn std::error::Error>> {
    let output = Command::new(python).args(["-c", VTK]).arg(mesh).arg(reduction.to_string()).output()?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().parse()?)
}

/// Prints the size of the operations and how fast they play.
fn print_stream(build: &Build, repeats: usize) -> Result<(), StreamError> {
    let encoded = build.operations()?;
    let n_vertices = encoded.n_vertices as f64;
    let n_copies = build.history().vertex_birth.iter().filter(|&&birth| birth > 0).count();
    let standard = 12.0 * (build.history().n_alive(0) + build.vertices().positions.len() - n_copies) as f64;
    println!(
        "{} operations: {:.3} of indices and positions uncoded, {:.3} coded, {:.1} bits per vertex",
        encoded.n_operations,
        encoded.plain_bytes as f64 / standard,
        encoded.bytes.len() as f64 / standard,
        8.0 * encoded.bytes.len() as f64 / n_vertices,
    );
    let start = Instant::now();
    let mut mesh = ProgressiveMesh::from_bytes(&encoded.bytes)?;
    let reading = start.elapsed().as_secs_f64();
    let mut seconds = vec![];
    for _ in 0..repeats {
        let start = Instant::now();
        mesh.refine(usize::MAX);
        mesh.coarsen(usize::MAX);
        black_box(mesh.triangles());
        seconds.push(start.elapsed().as_secs_f64());
    }
    let million = encoded.n_operations as f64 / 1e6;
    println!(
        "read at {:.2} million operations a second, played at {:.1}",
        million / reading,
        2.0 * million / median(&seconds)
    );
    Ok(())
}
