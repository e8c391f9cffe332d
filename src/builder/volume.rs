//! From a tetrahedral mesh to the history of its fusion.

use super::{BuildError, Observer, Phase, Progress, VolumeOptions};
use crate::decimate::fusion::{self, FusionReport};
use crate::decimate::{Decimated, Input};
use crate::geometry::distance::Triangle;
use crate::geometry::vector::{Vector, widen};
use crate::history::History;
use crate::measure::{bound_of_pieces, inner_walls};
use crate::mesh::{
    LostParts, RepairedVolume, TetrahedronRepairReport, boundary_faces, check_counts, repair_tetrahedra,
};
use crate::store::Vertices;
use nephrite_formats::{MeshFault, TetrahedronMesh};
use std::ops::ControlFlow;

/// What a build of a volume leaves: the history of a fusion, and how many fusions there were.
///
/// Only [`build_volume`] and [`build_volume_with`] make one, so what it [writes](Self::write) of
/// its method is true.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeBuild {
    pub(super) options: VolumeOptions,
    pub(super) n_vertices_in: usize,
    pub(super) n_tetrahedra_in: usize,
    mesh: TetrahedronMesh,
    history: History<4>,
    pub(super) repairs: TetrahedronRepairReport,
    /// See [`dropped_distance`](Self::dropped_distance).
    dropped_distance: f64,
    /// See [`inner_wall_area`](Self::inner_wall_area).
    inner_wall_area: f64,
    fusions: FusionReport,
}

impl VolumeBuild {
    /// What the history's indices refer to: the vertices of the input after repair, and behind them
    /// all fusion points.
    pub fn vertices(&self) -> Vertices<'_> {
        (&self.mesh).into()
    }

    /// Every tetrahedron that ever lived. Its errors bound the distance between the boundary of a
    /// step and that of the input both ways; its deviations are estimates: of the planar quadric
    /// distance, and of every field.
    pub fn history(&self) -> &History<4> {
        &self.history
    }

    /// What the build was asked for.
    pub fn options(&self) -> &VolumeOptions {
        &self.options
    }

    /// Vertices of the input, before repair.
    pub fn n_vertices_in(&self) -> usize {
        self.n_vertices_in
    }

    /// Tetrahedra of the input, before repair.
    pub fn n_tetrahedra_in(&self) -> usize {
        self.n_tetrahedra_in
    }

    /// What the repair did.
    pub fn repairs(&self) -> &TetrahedronRepairReport {
        &self.repairs
    }

    /// Bound on the distance between the boundary of the input and that of the repaired mesh, both
    /// ways, in mesh units; part of the error of every level.
    pub fn dropped_distance(&self) -> f64 {
        self.dropped_distance
    }

    /// Area of the walls inside the boundary, both sheets, in square mesh units: faces that lie on
    /// others the other way round, as where nodes hang at the edge of a refined part.
    pub fn inner_wall_area(&self) -> f64 {
        self.inner_wall_area
    }

    /// How many fusions there were.
    pub fn fusions(&self) -> &FusionReport {
        &self.fusions
    }
}

/// Repairs `mesh` and fuses its tetrahedra as the options say. The result does not depend on the
/// number of threads.
///
/// # Errors
///
/// [`BuildError`] for a mesh without tetrahedra or that contradicts itself, and for options out of
/// their range.
///
/// ```
/// use nephrite::{VolumeOptions, build_volume, generate};
/// let build = build_volume(&generate::box_volume([4; 3]), &VolumeOptions::default())?;
/// assert!(build.fusions().n_fusions > 0);
/// # Ok::<(), nephrite::BuildError>(())
/// ```
pub fn build_volume(mesh: &TetrahedronMesh, options: &VolumeOptions) -> Result<VolumeBuild, BuildError> {
    build_volume_with(mesh, options, &|_| ControlFlow::Continue(()))
}

/// As [`build_volume`], with an observer that is told of progress and may stop the build.
///
/// # Errors
///
/// As [`build_volume`], and [`BuildError::Interrupted`] when `observer` breaks.
pub fn build_volume_with(
    mesh: &TetrahedronMesh,
    options: &VolumeOptions,
    observer: Observer<'_>,
) -> Result<VolumeBuild, BuildError> {
    options.check()?;
    check_counts(mesh.positions.len(), mesh.tetrahedra.len())?;
    mesh.check()?;
    let (n_vertices_in, n_tetrahedra_in) = (mesh.positions.len(), mesh.tetrahedra.len());
    let tell = |phase, n_triangles, error| {
        let max_error = options.max_error;
        let progress = Progress { phase, n_triangles, n_triangles_in: n_tetrahedra_in, error, max_error };
        observer(&progress)
    };
    if tell(Phase::Repair, n_tetrahedra_in, 0.0).is_break() {
        return Err(BuildError::Interrupted);
    }
    let repaired = repair_tetrahedra(mesh);
    if repaired.mesh.tetrahedra.is_empty() {
        return Err(BuildError::NoTetrahedra { n_tetrahedra: n_tetrahedra_in });
    }
    let (boundary, apexes) = boundary_of(&repaired);
    let walls = inner_walls(&boundary, &apexes);
    let dropped_distance = bound_of_lost(&repaired.lost, &boundary);
    drop((boundary, apexes));
    let repairs = TetrahedronRepairReport { faces_at_hanging_nodes: walls.n_faces, ..repaired.report };
    let watch = |n_alive, error| tell(Phase::Decimate, n_alive, error + dropped_distance);
    let input = Input {
        mesh: repaired,
        max_error: options.max_error.map(|error| (error - dropped_distance).max(0.0)),
        cos_feature_angle: options.feature_angle_degrees.to_radians().cos(),
        lock_boundary: options.lock_boundary,
    };
    let Decimated { mesh, mut history, report } = fusion::run(input, &options.fusion, &watch)?;
    history.errors.iter_mut().for_each(|error| *error += dropped_distance);
    Ok(VolumeBuild {
        options: *options,
        n_vertices_in,
        n_tetrahedra_in,
        mesh,
        history,
        repairs,
        dropped_distance,
        inner_wall_area: walls.area,
        fusions: report,
    })
}

/// The volume that [`build_volume`] fuses, and what was repaired. Level 0 of its file is this.
///
/// # Errors
///
/// The first contradiction in `mesh`.
///
/// ```
/// let (repaired, report) = nephrite::repair_volume(&nephrite::generate::ball_volume(4))?;
/// assert_eq!((report.vertices_welded, repaired.check()), (0, Ok(())));
/// # Ok::<(), nephrite::MeshFault>(())
/// ```
pub fn repair_volume(
    mesh: &TetrahedronMesh,
) -> Result<(TetrahedronMesh, TetrahedronRepairReport), MeshFault> {
    mesh.check()?;
    let RepairedVolume { mesh, report, .. } = repair_tetrahedra(mesh);
    Ok((mesh, report))
}

/// The boundary of a repaired volume, and the fourth corner of the tetrahedron at each triangle.
fn boundary_of(RepairedVolume { mesh, points, .. }: &RepairedVolume) -> (Vec<Triangle>, Vec<Vector>) {
    let point = |v: u32| points.as_ref().map_or(v, |points| points[v as usize]);
    let tetrahedra: Vec<[u32; 4]> = mesh.tetrahedra.iter().map(|t| t.map(point)).collect();
    let place = |t: usize, i: usize| widen(mesh.positions[tetrahedra[t][i] as usize]);
    let faces = boundary_faces(&tetrahedra, mesh.positions.len());
    // The corners of a tetrahedron are 0 to 3, which add up to 6.
    let apex = |face: [usize; 3]| 6 - face.iter().sum::<usize>();
    faces.map(|(t, face)| (face.map(|i| place(t, i)), place(t, apex(face)))).unzip()
}

/// Bound on the distance between the boundary of the input and that of the repaired mesh, both
/// ways.
fn bound_of_lost(lost: &LostParts, boundary: &[Triangle]) -> f64 {
    let of_peeled =
        bound_of_pieces(&lost.peeled, &lost.bared).max(bound_of_pieces(&lost.bared, &lost.peeled));
    if lost.loose.is_empty() {
        return of_peeled;
    }
    of_peeled.max(bound_of_pieces(&lost.loose, &[boundary, &lost.beside_loose].concat()))
}
