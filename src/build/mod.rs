//! From a mesh to the history of its simplification.

mod error;
mod options;
mod progress;
mod volume;

pub use error::BuildError;
pub use options::{Bound, BuildOptions, Method};
pub use progress::{Observer, Phase, Progress};
pub use volume::{VolumeBuild, VolumeOptions, build_volume};

use crate::bound::GlobalError;
use crate::bound::certified::Certified;
use crate::bound::estimate::{Estimate, Kind};
use crate::decimate::jade::Placement;
use crate::decimate::jade::decimation::{Decimation, Finished, Workers};
use crate::decimate::jade::placement::Moves;
use crate::decimate::jade::rounds::{Unfinished, run};
use crate::decimate::jade::thresholds::Thresholds;
use crate::decimate::progressive::complex::Complex;
use crate::decimate::progressive::wedges::Wedges;
use crate::decimate::progressive::{self, Passage};
use crate::geometry::distance::Triangle;
use crate::geometry::vector::{Vector, length, max, min, sub, widen};
use crate::history::{History, Recorder};
use crate::measure::bound_of_pieces;
use crate::mesh::{Numbering, RepairReport, Repaired, Seams, Surface, along_a_curve, check_counts, repair};
use nephrite_formats::TriangleMesh;
use options::check_options;

/// What a build leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Build {
    /// The input after repair, and behind its vertices those that were born later: what the history's indices refer to. Without
    /// triangles where the mesh was [given away](build_from()) and [`Method::Jade`] has used them up: they are those of the history that
    /// are born at step 0.
    pub mesh: TriangleMesh,
    /// Every triangle that ever lived.
    pub history: History,
    /// What the repair did.
    pub repairs: RepairReport,
    /// Bound on the distance of what the repair dropped from what it left, in mesh units; part of the error of every level.
    pub dropped_distance: f64,
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
    simplify(mesh.clone(), options, observer, |repaired| repaired.triangles.clone())
}

/// As [`build()`] for a mesh that nobody needs any more, in less memory: its arrays become those of the decimation.
///
/// # Errors
///
/// As [`build()`].
///
/// ```
/// use nephrite::{BuildOptions, build_from, generate};
/// use std::ops::ControlFlow;
/// let mesh = generate::torus(16, 8);
/// let n_triangles = mesh.triangles.len();
/// let build = build_from(mesh, &BuildOptions::default(), &|_| ControlFlow::Continue(()))?;
/// assert_eq!(build.history.birth.iter().filter(|&&birth| birth == 0).count(), n_triangles);
/// # Ok::<(), nephrite::BuildError>(())
/// ```
pub fn build_from(
    mesh: TriangleMesh,
    options: &BuildOptions,
    observer: Observer<'_>,
) -> Result<Build, BuildError> {
    check_options(options)?;
    check_mesh(&mesh)?;
    simplify(mesh, options, observer, |_| vec![])
}

/// Repairs a mesh that was checked and runs the decimator. `keep` gives the triangles that the mesh is to have in the end.
fn simplify(
    mesh: TriangleMesh,
    options: &BuildOptions,
    observer: Observer<'_>,
    keep: impl FnOnce(&TriangleMesh) -> Vec<[u32; 3]>,
) -> Result<Build, BuildError> {
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
    let repairs = repaired.report;
    let dropped_distance = bound_of_dropped(&repaired);
    let options = BuildOptions { max_error: max_error.map(|error| error - dropped_distance), ..*options };
    let tell = |n_triangles, error| tell(Phase::Decimate, n_triangles, error + dropped_distance);
    let (mesh, mut history, passage) = match options.method {
        Method::Jade => simplify_by_removal(repaired, &options, &tell, keep)?,
        Method::Progressive => simplify_by_collapse(along_a_curve(repaired), &options, &tell)?,
        Method::Fusion => return Err(BuildError::NotAVolume),
    };
    if dropped_distance > 0.0 {
        history.errors.iter_mut().for_each(|error| *error += dropped_distance);
    }
    Ok(Build { mesh, history, repairs, dropped_distance, passage })
}

/// What a decimator leaves: the mesh that its history refers to, the history, and what else there is to tell.
type Simplified = (TriangleMesh, History, Option<Passage>);

/// Told the triangles and the error of the moment; false stops the build.
type Tell<'a> = &'a (dyn Fn(usize, f64) -> bool + Sync);

/// Bound on the distance of what the repair dropped from what it left.
fn bound_of_dropped(Repaired { mesh, dropped, .. }: &Repaired) -> f64 {
    if dropped.is_empty() {
        return 0.0;
    }
    let corners = |triangle: &[u32; 3]| triangle.map(|v| widen(mesh.positions[v as usize]));
    let left: Vec<Triangle> = mesh.triangles.iter().map(corners).collect();
    bound_of_pieces(dropped, &left)
}

/// Whether any error is left to be made: not where what the repair dropped has used up all that was allowed.
fn may_change(options: &BuildOptions) -> bool {
    options.max_error.is_none_or(|error| error > 0.0)
}

fn simplify_by_removal(
    repaired: Repaired,
    options: &BuildOptions,
    tell: Tell<'_>,
    keep: impl FnOnce(&TriangleMesh) -> Vec<[u32; 3]>,
) -> Result<Simplified, BuildError> {
    let Repaired { mut mesh, points, looks, .. } = repaired;
    let go_on = |decimation: &Decimation| tell(decimation.surface.n_triangles(), decimation.recorder.error());
    let triangles = keep(&mesh);
    let (history, moves) = decimate(&mut mesh, points.zip(looks), options, &go_on)?;
    mesh.triangles = triangles;
    let moved = moves.into_iter().flat_map(|moves| moves.born);
    Ok((with_copies(mesh, moved.map(|(vertex, place)| (vertex, Some(place)))), history, None))
}

fn simplify_by_collapse(
    repaired: Repaired,
    options: &BuildOptions,
    tell: Tell<'_>,
) -> Result<Simplified, BuildError> {
    let Repaired { mesh, points, looks, .. } = repaired;
    let points_and_looks = points.zip(looks);
    let go_on = |decimation: &progressive::Decimation| {
        tell(decimation.complex.n_triangles(), decimation.journal.recorder.error())
    };
    // Inside the pool from the start: to enter it for each of the many short parallel parts would cost more than they do.
    let decimate = |_: &rayon::Scope<'_>| decimate_progressively(&mesh, points_and_looks, options, &go_on);
    let (history, passage) = rayon::scope(decimate)?;
    let mesh = with_copies(mesh, passage.trace.copies.iter().map(|&copied| (copied, None)));
    Ok((mesh, history, Some(passage)))
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
    if may_change(options) && !decimation.run(go_on) {
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

/// Takes the triangles out of `mesh`; everything else is as before in the end.
fn decimate(
    mesh: &mut TriangleMesh,
    points_and_looks: Option<(Vec<u32>, Vec<u32>)>,
    options: &BuildOptions,
    go_on: &dyn Fn(&Decimation) -> bool,
) -> Result<(History, Option<Moves>), BuildError> {
    let bounding_diagonal = bounding_diagonal(mesh);
    let numbering = Numbering::along_curve(&mesh.positions);
    let mut triangles = std::mem::take(&mut mesh.triangles);
    numbering.sort_triangles(&mut triangles);
    let moves =
        (options.jade.placement == Placement::Best).then(|| Moves::new(&mesh.positions, triangles.len()));
    let (mut triangles, seams) = match points_and_looks {
        None => (triangles, None),
        Some((points, looks)) => {
            let over_points = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
            (over_points, Some(Seams::new(triangles, looks)))
        }
    };
    triangles.as_flattened_mut().iter_mut().for_each(|v| *v = numbering.place(*v));
    let positions = numbering.arrange(&mesh.positions);
    if moves.is_none() {
        mesh.positions = vec![];
    }
    let surface = Surface::new(positions, triangles);
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
        names: moves.is_some().then(|| numbering.vertices().to_vec()),
        numbers: numbering.into_vertices(),
        cos_feature_angle: options.feature_angle_degrees.to_radians().cos(),
        aspect_loss: options.jade.aspect_loss,
        c2: options.jade.c2,
        moves,
        workers: Workers::new(),
    };
    if may_change(options) {
        let thresholds = Thresholds::new(options.max_error, bounding_diagonal, &options.jade);
        run(&mut decimation, thresholds, go_on).map_err(|unfinished| match unfinished {
            Unfinished::Stopped => BuildError::Interrupted,
            Unfinished::TooLarge(too_many) => too_many.into(),
        })?;
    }
    let Finished { history, moves, positions } = decimation.finish();
    if let Some(positions) = positions {
        mesh.positions = positions;
    }
    Ok((history, moves))
}

/// Length of the diagonal of the mesh's bounding box, in mesh units.
pub fn bounding_diagonal(mesh: &TriangleMesh) -> f64 {
    let mut points = mesh.positions.iter().map(|&p| widen(p));
    let Some(first) = points.next() else { return 0.0 };
    let (low, high): (Vector, Vector) = points.fold((first, first), |(l, h), p| (min(l, p), max(h, p)));
    length(sub(high, low))
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
