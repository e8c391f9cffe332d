//! From a mesh to the history of its simplification.

mod error;
mod options;
mod progress;
mod volume;

pub use crate::bound::Bound;
pub use error::BuildError;
pub use options::{BuildOptions, Method};
pub use progress::{Observer, Phase, Progress};
pub use volume::{VolumeBuild, VolumeOptions, build_volume};

use crate::decimate::progressive::Passage;
use crate::decimate::{Decimated, Input, Watch, jade, progressive};
use crate::geometry::bounds;
use crate::geometry::distance::Triangle;
use crate::geometry::vector::widen;
use crate::history::History;
use crate::measure::bound_of_pieces;
use crate::mesh::{RepairReport, Repaired, check_counts, repair};
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
        observer(&Progress { phase, n_triangles, n_triangles_in, error, max_error })
    };
    if tell(Phase::Repair, n_triangles_in, 0.0).is_break() {
        return Err(BuildError::Interrupted);
    }
    let repaired = repair(mesh);
    if repaired.mesh.triangles.is_empty() {
        return Err(BuildError::NoTriangles { n_triangles: n_triangles_in });
    }
    let repairs = repaired.report;
    let dropped_distance = bound_of_dropped(&repaired);
    let input = Input {
        mesh: repaired,
        max_error: max_error.map(|error| error - dropped_distance),
        cos_feature_angle: options.feature_angle_degrees.to_radians().cos(),
    };
    let watch = |n_triangles, error| tell(Phase::Decimate, n_triangles, error + dropped_distance);
    let (mesh, mut history, passage) = decimate(input, options, &watch, keep)?;
    if dropped_distance > 0.0 {
        history.errors.iter_mut().for_each(|error| *error += dropped_distance);
    }
    Ok(Build { mesh, history, repairs, dropped_distance, passage })
}

/// Runs the decimator that was asked for: the mesh that its history refers to, the history, and what
/// else there is to tell.
fn decimate(
    input: Input<Repaired>,
    options: &BuildOptions,
    watch: Watch<'_>,
    keep: impl FnOnce(&TriangleMesh) -> Vec<[u32; 3]>,
) -> Result<(TriangleMesh, History, Option<Passage>), BuildError> {
    match options.method {
        Method::Jade => {
            let triangles = keep(&input.mesh.mesh);
            let Decimated { mesh, history, .. } = jade::run(input, options.bound, &options.jade, watch)?;
            Ok((TriangleMesh { triangles, ..mesh }, history, None))
        }
        Method::Progressive => {
            let Decimated { mesh, history, report } =
                progressive::run(input, options.bound, &options.progressive, watch)?;
            Ok((mesh, history, Some(report)))
        }
        Method::Fusion => Err(BuildError::NotAVolume),
    }
}

/// Bound on the distance of what the repair dropped from what it left.
fn bound_of_dropped(Repaired { mesh, dropped, .. }: &Repaired) -> f64 {
    if dropped.is_empty() {
        return 0.0;
    }
    let corners = |triangle: &[u32; 3]| triangle.map(|v| widen(mesh.positions[v as usize]));
    let left: Vec<Triangle> = mesh.triangles.iter().map(corners).collect();
    bound_of_pieces(dropped, &left)
}

/// Length of the diagonal of the mesh's bounding box, in mesh units.
pub fn bounding_diagonal(mesh: &TriangleMesh) -> f64 {
    bounds::bounding_diagonal(&mesh.positions)
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
