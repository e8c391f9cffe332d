//! Is every step of a fusion a valid volume? And how many tetrahedra does the fusion of one remove,
//! beside table 1 of the paper?
//!
//! Each volume is built in memory and its history checked step by step, so that every level that a
//! file could keep is checked: no tetrahedron that ever lived is inverted, the volume stays within
//! 0.1 %, no face has three tetrahedra, and the boundary keeps its Euler characteristic, its
//! components and its edges of two faces. A second build fuses whole tetrahedra as far as possible,
//! like the paper.

use clap::Parser;
use nephrite::{FusionOptions, TetrahedronMesh, VolumeBuild, VolumeOptions, build_volume};
use nephrite_compare::boundary_walk::{BoundaryWalk, events};
use nephrite_compare::{CompareError, Table};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(about = "Checks every step of the fusion of volumes, and counts what fusions take away")]
struct Arguments {
    /// Volumes
    #[arg(required = true)]
    volumes: Vec<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("volume_steps: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<bool, CompareError> {
    let mut steps = Table::new([
        "volume",
        "order",
        "steps",
        "tetrahedra that lived",
        "inverted",
        "volume off at most",
        "crowded faces",
        "characteristic",
        "components",
        "edges not of two faces",
    ]);
    let mut fusions = Table::new([
        "volume",
        "tetrahedra",
        "left by whole ones",
        "reduction",
        "tetrahedra a fusion",
        "inside the mesh",
        "least there",
    ]);
    let mut is_whole = true;
    for path in &arguments.volumes {
        let (mesh, _) = nephrite_formats::read_volume(path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for (order, share) in [("default", FusionOptions::default().tetrahedron_share), ("whole first", 1.0)]
        {
            let fusion = FusionOptions { tetrahedron_share: share, ..FusionOptions::default() };
            let options = VolumeOptions { fusion, ..VolumeOptions::default() };
            let build = build_volume(&mesh, &options)?;
            let walked = walk(&build);
            is_whole &= walked.is_whole();
            steps.push(walked.row(&name, order));
            if share == 1.0 {
                fusions.push(walked.fusions_row(&name, &build));
            }
        }
    }
    println!("{steps}\n{fusions}");
    Ok(is_whole)
}

/// What was counted on the way.
struct Walked {
    end: BoundaryWalk,
    n_steps: usize,
    /// Largest part of the volume that was lost or gained.
    volume_off: f64,
    most_crowded: i64,
    /// Smallest and largest of all steps.
    characteristic: [i64; 2],
    open_edges: [i64; 2],
    /// At the first step and at the last.
    components: [usize; 2],
    /// Fusions of tetrahedra inside the mesh, the tetrahedra that they removed, and the fewest that
    /// one removed.
    n_inner: usize,
    n_inner_taken: usize,
    least_inner: usize,
}

fn walk(build: &VolumeBuild) -> Walked {
    let history = build.history();
    let positions = build.vertices().positions.to_vec();
    let mesh = &TetrahedronMesh { positions, ..TetrahedronMesh::default() };
    let mut walk = BoundaryWalk::default();
    let mut events = events(history).into_iter();
    let start = events.next().unwrap_or_default();
    start[1].iter().for_each(|&i| walk.add(mesh, history.simplices[i]));
    let whole = walk.six_volumes;
    let prey = dying(&history.vertex_death, history.errors.len());
    let mut walked = Walked {
        n_steps: history.errors.len(),
        volume_off: 0.0,
        most_crowded: walk.n_crowded_faces,
        characteristic: [walk.characteristic(); 2],
        open_edges: [walk.n_open_edges; 2],
        components: [walk.n_components(); 2],
        n_inner: 0,
        n_inner_taken: 0,
        least_inner: usize::MAX,
        end: walk,
    };
    for (step, [dead, born]) in (1..).zip(events) {
        let walk = &mut walked.end;
        let is_inner = prey[step].iter().all(|&v| !walk.is_on_boundary(v));
        if step <= build.fusions().n_tetrahedron_fusions && is_inner {
            let n_taken = dead.len() - born.len();
            walked.n_inner += 1;
            walked.n_inner_taken += n_taken;
            walked.least_inner = walked.least_inner.min(n_taken);
        }
        dead.iter().for_each(|&i| walk.remove(mesh, history.simplices[i]));
        born.iter().for_each(|&i| walk.add(mesh, history.simplices[i]));
        walked.volume_off = walked.volume_off.max((walk.six_volumes / whole - 1.0).abs());
        walked.most_crowded = walked.most_crowded.max(walk.n_crowded_faces);
        widen(&mut walked.characteristic, walk.characteristic());
        widen(&mut walked.open_edges, walk.n_open_edges);
    }
    walked.components[1] = walked.end.n_components();
    walked
}

fn widen([low, high]: &mut [i64; 2], value: i64) {
    (*low, *high) = ((*low).min(value), (*high).max(value));
}

/// The vertices that die at each step.
fn dying(vertex_death: &[u32], n_steps: usize) -> Vec<Vec<u32>> {
    let mut dying = vec![Vec::new(); n_steps];
    for (v, &death) in (0..).zip(vertex_death) {
        if let Some(step) = dying.get_mut(death as usize) {
            step.push(v);
        }
    }
    dying
}

impl Walked {
    fn is_whole(&self) -> bool {
        let is_same = |[low, high]: [i64; 2]| low == high;
        self.end.n_inverted == 0
            && self.volume_off <= 0.001
            && self.most_crowded == 0
            && is_same(self.characteristic)
            && is_same(self.open_edges)
            && self.components[0] == self.components[1]
    }

    fn row(&self, name: &str, order: &str) -> [String; 10] {
        let range =
            |[low, high]: [i64; 2]| if low == high { low.to_string() } else { format!("{low} to {high}") };
        [
            name.to_owned(),
            order.to_owned(),
            self.n_steps.to_string(),
            self.end.n_born.to_string(),
            self.end.n_inverted.to_string(),
            format!("{:.4} %", 100.0 * self.volume_off),
            self.most_crowded.to_string(),
            range(self.characteristic),
            format!("{}, {}", self.components[0], self.components[1]),
            range(self.open_edges),
        ]
    }

    fn fusions_row(&self, name: &str, build: &VolumeBuild) -> [String; 7] {
        let n_in = build.history().n_alive(0);
        let n_taken = n_in - build.fusions().n_left_by_tetrahedra;
        let a_fusion = |taken: usize, n: usize| format!("{:.1}", taken as f64 / n.max(1) as f64);
        [
            name.to_owned(),
            n_in.to_string(),
            build.fusions().n_left_by_tetrahedra.to_string(),
            format!("{:.1} %", 100.0 * n_taken as f64 / n_in as f64),
            a_fusion(n_taken, build.fusions().n_tetrahedron_fusions),
            a_fusion(self.n_inner_taken, self.n_inner),
            self.least_inner.to_string(),
        ]
    }
}
