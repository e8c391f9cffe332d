//! From a mesh to the history of its simplification.

mod error;
mod options;
mod progress;
mod spanned;
mod volume;
mod write;

pub use error::BuildError;
pub use options::{BuildOptions, Decimator, VolumeOptions};
pub use progress::{Observer, Phase, Progress};
pub use spanned::bounding_diagonal;
pub use volume::{VolumeBuild, build_volume, build_volume_with, repair_volume};

use crate::decimate::progressive::ProgressiveReport;
use crate::decimate::{Decimated, Input, Watch, jade, progressive};
use crate::geometry::distance::Triangle;
use crate::geometry::vector::widen;
use crate::history::History;
use crate::measure::bound_of_pieces;
use crate::mesh::{RepairReport, Repaired, check_counts, repair};
use crate::progressive_mesh::{Encoded, StreamError, encode};
use crate::store::Vertices;
use nephrite_formats::TriangleMesh;
use std::borrow::Cow;
use std::ops::ControlFlow;

/// What a build leaves: the history of a simplification, and what it proves.
///
/// Only [`build()`] and [`build_with`] make one, so what it [writes](Self::write) of its method and
/// its bound is true.
#[derive(Clone, Debug, PartialEq)]
pub struct Build {
    options: BuildOptions,
    n_vertices_in: usize,
    n_triangles_in: usize,
    /// The input after repair, and behind its vertices those that were born later. Its triangles,
    /// which the history has as well, stay for the operations of a progressive build.
    pub(crate) mesh: TriangleMesh,
    history: History,
    repairs: RepairReport,
    /// See [`dropped_distance`](Self::dropped_distance).
    dropped_distance: f64,
    progressive: Option<ProgressiveReport>,
}

impl Build {
    /// What the history's indices refer to: the vertices of the input after repair, and behind them
    /// those that were born later.
    pub fn vertices(&self) -> Vertices<'_> {
        (&self.mesh).into()
    }

    /// Every triangle that ever lived.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// What the build was asked for.
    pub fn options(&self) -> &BuildOptions {
        &self.options
    }

    /// Vertices of the input, before repair.
    pub fn n_vertices_in(&self) -> usize {
        self.n_vertices_in
    }

    /// Triangles of the input, before repair.
    pub fn n_triangles_in(&self) -> usize {
        self.n_triangles_in
    }

    /// What the repair did.
    pub fn repairs(&self) -> &RepairReport {
        &self.repairs
    }

    /// Bound on the distance of what the repair dropped from what it left, in mesh units; part of
    /// the error of every level.
    pub fn dropped_distance(&self) -> f64 {
        self.dropped_distance
    }

    /// What the progressive decimator tells beside the history; `None` for another one.
    pub fn progressive(&self) -> Option<&ProgressiveReport> {
        self.progressive.as_ref()
    }

    /// Levels with at least this many triangles carry a certified error, those below it an
    /// estimate. `None` if the bound that was asked for holds for all of them.
    pub fn n_certified_triangles(&self) -> Option<usize> {
        let last = self.progressive.as_ref()?.n_certified_steps.checked_sub(1)?;
        Some(self.history.n_alive(last))
    }

    /// The operations of a progressive build as a stream, which
    /// [`StoreOptions::operations`](crate::store::StoreOptions) also puts into a file. O(n) but for
    /// coding, which is most of it.
    ///
    /// # Errors
    ///
    /// [`StreamError::NoOperations`] for a build of another decimator; [`StreamError::Meaningless`]
    /// for one whose stars of hundreds of thousands of triangles moved so often that no reader
    /// would follow.
    pub fn operations(&self) -> Result<Encoded, StreamError> {
        let report = self.progressive.as_ref().ok_or(StreamError::NoOperations)?;
        encode(&self.mesh, &report.trace)
    }
}

/// Repairs `mesh` and simplifies it as the options say, on the current rayon pool.
///
/// A mesh that is given away takes less memory than one that is lent: its arrays become those of
/// the decimation. The result does not depend on that, nor on the number of threads.
///
/// # Errors
///
/// [`BuildError`] for a mesh without triangles or with coordinates or indices that mean nothing,
/// and for options out of their range.
///
/// ```
/// use nephrite::{BuildOptions, build, generate};
/// let mesh = generate::torus(16, 8);
/// let lent = build(&mesh, &BuildOptions::default())?;
/// assert_eq!(lent.history().n_alive(0), mesh.triangles.len());
/// let given = build(mesh, &BuildOptions::default())?;
/// assert!(lent == given);
/// # Ok::<(), nephrite::BuildError>(())
/// ```
pub fn build<'a>(
    mesh: impl Into<Cow<'a, TriangleMesh>>,
    options: &BuildOptions,
) -> Result<Build, BuildError> {
    build_with(mesh, options, &|_| ControlFlow::Continue(()))
}

/// As [`build()`], with an observer that is told of progress and may stop the build.
///
/// # Errors
///
/// As [`build()`], and [`BuildError::Interrupted`] when `observer` breaks.
///
/// ```
/// use nephrite::{BuildError, BuildOptions, build_with, generate};
/// use std::ops::ControlFlow;
/// let stopped = build_with(&generate::sphere(8), &BuildOptions::default(), &|_| ControlFlow::Break(()));
/// assert_eq!(stopped, Err(BuildError::Interrupted));
/// ```
pub fn build_with<'a>(
    mesh: impl Into<Cow<'a, TriangleMesh>>,
    options: &BuildOptions,
    observer: Observer<'_>,
) -> Result<Build, BuildError> {
    options.check()?;
    let mesh = mesh.into();
    check_counts(mesh.positions.len(), mesh.triangles.len())?;
    mesh.check()?;
    simplify(mesh.into_owned(), options, observer)
}

/// Repairs a mesh that was checked and runs the decimator.
fn simplify(mesh: TriangleMesh, options: &BuildOptions, observer: Observer<'_>) -> Result<Build, BuildError> {
    let (n_vertices_in, n_triangles_in) = (mesh.positions.len(), mesh.triangles.len());
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
        lock_boundary: options.lock_boundary,
    };
    let watch = |n_triangles, error| tell(Phase::Decimate, n_triangles, error + dropped_distance);
    let (mesh, mut history, progressive) = decimate(input, options, &watch)?;
    history.errors.iter_mut().for_each(|error| *error += dropped_distance);
    Ok(Build {
        options: *options,
        n_vertices_in,
        n_triangles_in,
        mesh,
        history,
        repairs,
        dropped_distance,
        progressive,
    })
}

/// Runs the decimator that was asked for: the mesh that its history refers to, the history, and
/// what else there is to tell.
fn decimate(
    input: Input<Repaired>,
    options: &BuildOptions,
    watch: Watch<'_>,
) -> Result<(TriangleMesh, History, Option<ProgressiveReport>), BuildError> {
    match options.decimator {
        Decimator::Jade(options) => {
            let Decimated { mesh, history, .. } = jade::run(input, &options, watch)?;
            Ok((mesh, history, None))
        }
        Decimator::Progressive(options) => {
            let Decimated { mesh, history, report } = progressive::run(input, &options, watch)?;
            Ok((mesh, history, Some(report)))
        }
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
