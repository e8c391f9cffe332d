//! From a mesh to the history of its simplification.

use crate::bound::GlobalError;
use crate::bound::certified::Certified;
use crate::bound::estimate::{Estimate, Kind};
use crate::decimate::jade::decimation::{Decimation, Workers};
use crate::decimate::jade::placement::Moves;
use crate::decimate::jade::rounds::run;
use crate::decimate::jade::thresholds::Thresholds;
use crate::decimate::jade::{JadeOptions, Placement};
use crate::decimate::progressive::complex::Complex;
use crate::decimate::progressive::wedges::Wedges;
use crate::decimate::progressive::{self, Passage, ProgressiveOptions};
use crate::geometry::vector::{Vector, length, max, min, sub, widen};
use crate::history::{History, Recorder};
use crate::mesh::{
    Numbering, RepairReport, Repaired, Seams, Surface, TooMany, along_a_curve, check_counts, repair,
};
use nephrite_formats::TriangleMesh;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Which decimator runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Vertex removal under a bound on the global error.
    #[default]
    Jade,
    /// Fusion of tetrahedra; of volumes only, see [`build_volume`](crate::build_volume()).
    Fusion,
    /// Edge collapses and vertex splits that change the topology where they must, down to no triangle.
    Progressive,
}

/// What the error of a level means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bound {
    /// A proven bound on the two-sided Hausdorff distance to the input.
    #[default]
    Certified,
    /// The paper's estimate e_g3, the larger of the other two.
    Joint,
    /// The paper's estimate e_g2, from the removed vertices.
    Removed,
    /// The paper's estimate e_g1, accumulated local errors.
    Accumulated,
}

/// How to build.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BuildOptions {
    /// The decimator.
    pub method: Method,
    /// What its errors mean.
    pub bound: Bound,
    /// Largest error of any level, in mesh units; `None` simplifies as far as it goes.
    pub max_error: Option<f64>,
    /// Edges at which the normals turn by more than this, in degrees, are feature edges.
    pub feature_angle_degrees: f64,
    /// Constants of JADE.
    pub jade: JadeOptions,
    /// How far the progressive decimator goes.
    pub progressive: ProgressiveOptions,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            method: Method::default(),
            bound: Bound::default(),
            max_error: None,
            feature_angle_degrees: 60.0,
            jade: JadeOptions::default(),
            progressive: ProgressiveOptions::default(),
        }
    }
}

/// How far a build has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub phase: Phase,
    /// Triangles alive now.
    pub n_triangles: usize,
    /// Triangles of the input.
    pub n_triangles_in: usize,
    /// Error of the current mesh, in mesh units.
    pub error: f64,
    /// Error at which the build ends, if one was asked for.
    pub max_error: Option<f64>,
}

/// Parts of a build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Welding and dropping what is no surface.
    Repair,
    /// Removing vertices.
    Decimate,
}

/// Told of progress now and then, from the building thread; may stop the build.
pub type Observer<'a> = &'a (dyn Fn(&Progress) -> ControlFlow<()> + Sync);

/// What a build leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Build {
    /// The input after repair, and behind its vertices those that were born later: what the history's indices refer to.
    pub mesh: TriangleMesh,
    /// Every triangle that ever lived.
    pub history: History,
    /// What the repair did.
    pub repairs: RepairReport,
    /// What the progressive decimator tells beside the history.
    pub passage: Option<Passage>,
}

impl Build {
    /// Levels with at least this many triangles carry a certified error, those below an estimate. Nothing where the bound that was
    /// asked for holds for all of them.
    pub fn n_certified_triangles(&self) -> Option<usize> {
        let n_steps = self.passage.as_ref()?.n_certified_steps;
        let last = n_steps.checked_sub(1)?;
        let lifetimes = self.history.birth.iter().zip(&self.history.death);
        Some(lifetimes.filter(|&(&birth, &death)| birth <= last && last < death).count())
    }
}

/// Why a build failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// No triangle is left after repair.
    #[error("no triangle with three distinct corners among the {n_triangles} of the mesh")]
    NoTriangles {
        /// Triangles before repair.
        n_triangles: usize,
    },
    /// No tetrahedron is left after repair.
    #[error("no tetrahedron with four distinct corners among the {n_tetrahedra} of the mesh")]
    NoTetrahedra {
        /// Tetrahedra before repair.
        n_tetrahedra: usize,
    },
    /// A volume contradicts itself: an index without a vertex, a field of the wrong length.
    #[error("the mesh contradicts itself: found {found} where {expected} would be right or the limit")]
    Inconsistent {
        /// Index or length.
        found: u64,
        /// Length or limit that would be right.
        expected: u64,
    },
    /// A coordinate is not a number, or not finite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {found}, the mesh has {n_vertices}")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The index it holds.
        found: u32,
        /// Vertices there are.
        n_vertices: usize,
    },
    /// More vertices or simplices than ids of 32 bits have room for, see [`mesh::MAX_SIMPLICES`](crate::mesh::MAX_SIMPLICES).
    #[error("{found} {what}, there can be at most {limit}")]
    TooLarge {
        /// What is counted, in the plural.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// Fusion was asked for of a surface.
    #[error("a surface has no tetrahedra to fuse")]
    NotAVolume,
    /// An option has no meaning.
    #[error("{option} must be {expected}, found {found}")]
    Option {
        /// Its name.
        option: &'static str,
        /// What it must be.
        expected: &'static str,
        /// What it is.
        found: f64,
    },
    /// The decimator cannot state what was asked for.
    #[error("the {method} decimator states {expected}, not a {found} error")]
    BoundOfMethod {
        /// The decimator.
        method: &'static str,
        /// What it can state.
        expected: &'static str,
        /// What was asked for.
        found: &'static str,
    },
    /// Vertices were to move under something else than the proof that follows them.
    #[error("vertices move only under the certified bound of the jade decimator")]
    PlacementOfBound,
    /// The observer asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Repairs `mesh` and simplifies it as the options say, on the current rayon pool.
///
/// The result does not depend on the number of threads.
///
/// # Errors
///
/// [`BuildError`] for a mesh without triangles or with coordinates or indices that mean nothing, for options out of
/// their range, and when `observer` breaks.
pub fn build(
    mesh: &TriangleMesh,
    options: &BuildOptions,
    observer: Observer<'_>,
) -> Result<Build, BuildError> {
    check_options(options)?;
    check_mesh(mesh)?;
    let n_triangles_in = mesh.triangles.len();
    let max_error = options.max_error;
    let tell = |phase, n_triangles, error| {
        observer(&Progress { phase, n_triangles, n_triangles_in, error, max_error }).is_continue()
    };
    if !tell(Phase::Repair, n_triangles_in, 0.0) {
        return Err(BuildError::Interrupted);
    }
    let repaired = repair(mesh);
    if repaired.mesh.triangles.is_empty() {
        return Err(BuildError::NoTriangles { n_triangles: n_triangles_in });
    }
    let repaired = if options.method == Method::Progressive { along_a_curve(repaired) } else { repaired };
    let Repaired { mesh, points, looks, report: repairs } = repaired;
    let points_and_looks = points.zip(looks);
    match options.method {
        Method::Jade => {
            let go_on = |decimation: &Decimation| {
                tell(Phase::Decimate, decimation.surface.n_triangles(), decimation.recorder.error())
            };
            let (history, moves) = decimate(&mesh, points_and_looks, options, &go_on)?;
            let moved = moves.into_iter().flat_map(|moves| moves.born);
            let mesh = with_copies(mesh, moved.map(|(vertex, place)| (vertex, Some(place))));
            Ok(Build { mesh, history, repairs, passage: None })
        }
        Method::Fusion => Err(BuildError::NotAVolume),
        Method::Progressive => {
            let go_on = |decimation: &progressive::Decimation| {
                let error = decimation.journal.recorder.error();
                tell(Phase::Decimate, decimation.complex.n_triangles(), error)
            };
            // Inside the pool from the start: to enter it for each of the many short parallel parts would cost more than they do.
            let decimate =
                |_: &rayon::Scope<'_>| decimate_progressively(&mesh, points_and_looks, options, &go_on);
            let (history, passage) = rayon::scope(decimate)?;
            Ok(Build {
                mesh: with_copies(mesh, passage.trace.copies.iter().map(|&copied| (copied, None))),
                history,
                repairs,
                passage: Some(passage),
            })
        }
    }
}

fn decimate_progressively(
    mesh: &TriangleMesh,
    points_and_looks: Option<(Vec<u32>, Vec<u32>)>,
    options: &BuildOptions,
    go_on: &dyn Fn(&progressive::Decimation) -> bool,
) -> Result<(History, Passage), BuildError> {
    let triangles = mesh.triangles.clone();
    let (triangles, wedges) = match points_and_looks {
        None => (triangles, None),
        Some((points, looks)) => {
            let over_points = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
            (over_points, Some(Wedges::new(triangles, looks)))
        }
    };
    let settings = progressive::Settings {
        cos_feature_angle: options.feature_angle_degrees.to_radians().cos(),
        max_error: options.max_error.unwrap_or(f64::INFINITY),
        rounding: mesh.rounding,
        proves: options.bound == Bound::Certified,
        options: options.progressive,
    };
    let complex = Complex::new(mesh.positions.clone(), triangles);
    let n_vertices = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
    let mut decimation = progressive::Decimation::new(complex, wedges, n_vertices, settings);
    if !decimation.run(go_on) {
        return Err(BuildError::Interrupted);
    }
    Ok(decimation.finish())
}

/// The mesh with one vertex more for each of `copies`: the attributes of the vertex named, at the place given or its own.
fn with_copies(
    mut mesh: TriangleMesh,
    copies: impl IntoIterator<Item = (u32, Option<[f32; 3]>)>,
) -> TriangleMesh {
    for (copied, place) in copies {
        let copied = copied as usize;
        mesh.positions.push(place.unwrap_or(mesh.positions[copied]));
        for attribute in &mut mesh.attributes {
            let stride = attribute.stride_bytes();
            attribute.bytes.extend_from_within(copied * stride..(copied + 1) * stride);
        }
    }
    mesh
}

fn decimate(
    mesh: &TriangleMesh,
    points_and_looks: Option<(Vec<u32>, Vec<u32>)>,
    options: &BuildOptions,
    go_on: &dyn Fn(&Decimation) -> bool,
) -> Result<(History, Option<Moves>), BuildError> {
    let numbering = Numbering::along_curve(&mesh.positions);
    let mut triangles = mesh.triangles.clone();
    numbering.sort_triangles(&mut triangles);
    let moves =
        (options.jade.placement == Placement::Best).then(|| Moves::new(&mesh.positions, triangles.len()));
    let place = |triangles: &[[u32; 3]]| triangles.iter().map(|t| t.map(|v| numbering.place(v))).collect();
    let (triangles, seams) = match points_and_looks {
        // A vertex that moves is a new vertex at the same point, which only seams tell apart.
        None if moves.is_some() => {
            let looks = (0..).take(mesh.positions.len()).collect();
            (place(&triangles), Some(Seams::new(triangles, looks)))
        }
        None => (place(&triangles), None),
        Some((points, looks)) => {
            let over_points: Vec<[u32; 3]> =
                triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
            (place(&over_points), Some(Seams::new(triangles, looks)))
        }
    };
    let surface = Surface::new(numbering.arrange(&mesh.positions), triangles);
    let error = match options.bound {
        Bound::Certified => GlobalError::Certified(Certified::new(&surface, mesh.rounding)),
        Bound::Joint => GlobalError::Estimate(Estimate::new(Kind::Joint, &surface)),
        Bound::Removed => GlobalError::Estimate(Estimate::new(Kind::Removed, &surface)),
        Bound::Accumulated => GlobalError::Estimate(Estimate::new(Kind::Accumulated, &surface)),
    };
    let mut decimation = Decimation {
        error,
        recorder: Recorder::new(surface.n_slots(), surface.n_vertices(), mesh.rounding),
        surface,
        seams,
        names: numbering.into_vertices(),
        cos_feature_angle: options.feature_angle_degrees.to_radians().cos(),
        aspect_loss: options.jade.aspect_loss,
        c2: options.jade.c2,
        moves,
        workers: Workers::new(),
    };
    let thresholds = Thresholds::new(options.max_error, bounding_diagonal(mesh), &options.jade);
    if !run(&mut decimation, thresholds, go_on) {
        return Err(BuildError::Interrupted);
    }
    Ok(decimation.finish())
}

/// Length of the diagonal of the mesh's bounding box, in mesh units.
pub fn bounding_diagonal(mesh: &TriangleMesh) -> f64 {
    let mut points = mesh.positions.iter().map(|&p| widen(p));
    let Some(first) = points.next() else { return 0.0 };
    let (low, high): (Vector, Vector) = points.fold((first, first), |(l, h), p| (min(l, p), max(h, p)));
    length(sub(high, low))
}

impl From<TooMany> for BuildError {
    fn from((what, found, limit): TooMany) -> Self {
        Self::TooLarge { what, found, limit }
    }
}

fn check_mesh(mesh: &TriangleMesh) -> Result<(), BuildError> {
    check_counts(mesh.positions.len(), mesh.triangles.len())?;
    let is_finite = |p: &[f32; 3]| p.iter().all(|x| x.is_finite());
    if let Some(vertex) = mesh.positions.iter().position(|p| !is_finite(p)) {
        return Err(BuildError::NotFinite { vertex });
    }
    let n_vertices = mesh.positions.len();
    let flat = mesh.triangles.as_flattened();
    match flat.iter().position(|&v| v as usize >= n_vertices) {
        Some(at) => Err(BuildError::IndexOutOfRange { triangle: at / 3, found: flat[at], n_vertices }),
        None => Ok(()),
    }
}

fn check_options(options: &BuildOptions) -> Result<(), BuildError> {
    let check = |option, expected, found: f64, is_good: bool| {
        if is_good { Ok(()) } else { Err(BuildError::Option { option, expected, found }) }
    };
    let BuildOptions {
        max_error,
        feature_angle_degrees: angle,
        jade: JadeOptions { k, c1, c2, aspect_loss, placement },
        progressive: ProgressiveOptions { reduction, .. },
        ..
    } = *options;
    if let (Method::Progressive, Bound::Joint | Bound::Removed) = (options.method, options.bound) {
        let found = if options.bound == Bound::Joint { "joint" } else { "removed" };
        let expected = "a certified or an accumulated error";
        return Err(BuildError::BoundOfMethod { method: "progressive", expected, found });
    }
    if placement == Placement::Best && (options.method, options.bound) != (Method::Jade, Bound::Certified) {
        return Err(BuildError::PlacementOfBound);
    }
    let reduction = reduction.unwrap_or(1.0);
    check("reduction", "from 0 to 1", reduction, (0.0..=1.0).contains(&reduction))?;
    if let Some(error) = max_error {
        check("max error", "finite and above zero", error, error.is_finite() && error > 0.0)?;
    }
    check("feature angle", "from 0 to 180 degrees", angle, (0.0..=180.0).contains(&angle))?;
    check("k", "finite and at least 1", k, k.is_finite() && k >= 1.0)?;
    check("c1", "above 1, at most 16", c1, c1 > 1.0 && c1 <= 16.0)?;
    check("c2", "from 1 to 16", c2, (1.0..=16.0).contains(&c2))?;
    check("aspect loss", "from 0 to 1", aspect_loss, (0.0..=1.0).contains(&aspect_loss))
}
