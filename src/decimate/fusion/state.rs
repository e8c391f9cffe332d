//! The mesh in the middle of its fusion, with all that is kept beside it.

use super::creases::Creases;
use super::fields::{Fields, Surroundings};
use super::jumps::Jumps;
use super::metric::{Metric, Quadric};
use super::neighbourhood::Neighbourhood;
use super::options::FusionOptions;
use super::patch::Patch;
use super::prey::Prey;
use super::unit::Unit;
use crate::decimate::{Decimated, Input, Stopped, Watch};
use crate::geometry::bounds::Bounds;
use crate::geometry::vector::{Vector, max};
use crate::history::{Deviation, Recorder};
use crate::mesh::{RepairedVolume, Tetrahedra};
use nephrite_formats::TetrahedronMesh;

/// Largest distance that rounding a point to `f32` and its coordinates' products may make, in parts
/// of the extent.
const SLACK: f64 = 4.0 * f32::EPSILON as f64;

/// [`State::fine_error`] in parts of the bounding box diagonal.
const FINE_ERROR: f64 = 0.0005;

/// The mesh in the middle of its fusion. Lengths are in units of `unit`; those of the input and of
/// the recorder are in mesh units. Fusions between two calls of the observer.
const OBSERVED: usize = 256;

pub(super) struct State {
    unit: Unit,
    pub mesh: Tetrahedra,
    pub metric: Metric,
    pub creases: Creases,
    pub jumps: Jumps,
    pub fields: Fields,
    pub recorder: Recorder<4>,
    /// Bound on the distance between the input's boundary and the faces whose newest corner a
    /// vertex is.
    pub errors: Vec<f64>,
    /// Fusion at which the star of a vertex last changed.
    pub touched: Vec<u32>,
    pub neighbourhood: Neighbourhood,
    pub patch: Patch,
    pub n_fusions: usize,
    /// Six times the volume that may be lost in all.
    pub six_volumes_to_lose: f64,
    /// Six times the volume that may be lost still.
    pub six_volumes_left: f64,
    /// How far a point may be outside by rounding alone.
    pub slack: f64,
    pub max_error: f64,
    /// Whether no two points of the boundary may become one.
    pub lock_boundary: bool,
    /// The error that fusions of tetrahedra may bring to the boundary; what is coarser is left to
    /// edges, which move less of it.
    pub fine_error: f64,
    quadric_distances: Vec<f64>,
    field_deviations: Vec<Vec<f64>>,
    /// The input.
    input: TetrahedronMesh,
}

/// What a fusion tells beside the history.
///
/// ```
/// use nephrite::{FusionReport, VolumeOptions, build_volume, generate};
/// let build = build_volume(&generate::box_volume([6; 3]), &VolumeOptions::default())?;
/// let FusionReport { n_fusions, n_tetrahedron_fusions, .. } = *build.fusions();
/// assert!(n_tetrahedron_fusions < n_fusions);
/// # Ok::<(), nephrite::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FusionReport {
    /// Fusions made.
    pub n_fusions: usize,
    /// Those of tetrahedra among them, which come first.
    pub n_tetrahedron_fusions: usize,
    /// The tetrahedra that those left.
    pub n_left_by_tetrahedra: usize,
    /// Entries of stars read.
    #[cfg(test)]
    pub n_read: u64,
}

/// A fusion that holds.
pub(super) struct Accepted {
    pub point: [f32; 3],
    /// Bound on the distance between the boundary faces that come and the boundary of the input.
    pub error: f64,
    pub six_volumes_lost: f64,
    /// What the fusion costs with the boundary's error counted in.
    pub cost: f64,
}

impl State {
    /// The state at step 0. O(n).
    pub(super) fn new(input: Input<RepairedVolume>, options: &FusionOptions) -> Self {
        let Input { mesh: RepairedVolume { mesh, points, .. }, max_error, cos_feature_angle, lock_boundary } =
            input;
        let unit = Unit::new(Bounds::around_positions(&mesh.positions).diagonal());
        let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|&p| unit.point_to_unit(p)).collect();
        let bounds = Bounds::around_positions(&positions);
        let (corners, vertices) = match points {
            None => (mesh.tetrahedra.clone(), None),
            Some(points) => {
                let over_points = mesh.tetrahedra.iter().map(|t| t.map(|v| points[v as usize]));
                (over_points.collect(), Some(mesh.tetrahedra.clone()))
            }
        };
        let jumps = Jumps::new(&corners, vertices, positions.len());
        let tetrahedra = Tetrahedra::new(positions, corners);
        let field_range = options.field_weight * bounds.diagonal();
        let fields = Fields::new(&mesh.attributes, mesh.positions.len(), field_range);
        let (n_scaled, scaled) = fields.scaled();
        let metric = Metric::new(&tetrahedra, &jumps, bounds.center(), (n_scaled, &scaled));
        let recorder = Recorder::new(mesh.tetrahedra.len(), mesh.positions.len(), mesh.rounding);
        let six_volumes: f64 = tetrahedra.iter().map(|(slot, _)| tetrahedra.six_volumes(slot)).sum();
        let six_volumes_to_lose = options.volume_loss * six_volumes.abs();
        Self {
            creases: Creases::new(&tetrahedra, cos_feature_angle),
            jumps,
            recorder,
            touched: vec![0; mesh.positions.len()],
            errors: vec![unit.to_unit(mesh.rounding); mesh.positions.len()],
            quadric_distances: vec![0.0],
            field_deviations: vec![vec![0.0]; fields.len()],
            slack: SLACK
                * max(bounds.low.map(f64::abs), bounds.high.map(f64::abs)).into_iter().fold(0.0, f64::max),
            six_volumes_to_lose,
            six_volumes_left: six_volumes_to_lose,
            lock_boundary,
            max_error: unit.to_unit(max_error.unwrap_or(f64::INFINITY)),
            fine_error: FINE_ERROR * bounds.diagonal(),
            mesh: tetrahedra,
            metric,
            fields,
            neighbourhood: Neighbourhood::default(),
            patch: Patch::default(),
            n_fusions: 0,
            input: mesh,
            unit,
        }
    }

    /// The fusions made so far, as a stamp.
    #[expect(clippy::cast_possible_truncation, reason = "fewer fusions than vertices")]
    pub(super) fn now(&self) -> u32 {
        self.n_fusions as u32
    }

    /// Tells `watch` how far the fusions have come, every so many of them.
    ///
    /// # Errors
    ///
    /// [`Stopped`] when it breaks.
    pub(super) fn tell(&self, watch: Watch<'_>) -> Result<(), Stopped> {
        let is_time = self.n_fusions.is_multiple_of(OBSERVED);
        if is_time && watch(self.mesh.n_alive(), self.recorder.error()).is_break() {
            return Err(Stopped::Interrupted);
        }
        Ok(())
    }

    /// Makes a fusion whose neighbourhood is gathered; `changed` hears of every slot with new
    /// corners. Returns the new vertex.
    pub(super) fn fuse(&mut self, prey: &Prey, accepted: &Accepted, mut changed: impl FnMut(u32)) -> u32 {
        let quadric = self.metric.of(prey.vertices());
        self.recorder.step(self.unit.to_mesh(accepted.error));
        let local = self.metric.local(accepted.point.map(f64::from));
        let best = |field| self.metric.best_value(prey.vertices(), field, local);
        let surroundings = Surroundings { mesh: &self.mesh, jumps: &self.jumps, around: &self.neighbourhood };
        self.fields.add_vertex(surroundings, prey.vertices(), accepted.point, best);
        self.n_fusions += 1;
        let now = self.now();
        for &slot in &self.neighbourhood.deleted {
            if let Some(corners) = self.mesh.get(slot) {
                self.recorder.death(slot, self.jumps.vertices(slot, corners));
                self.mesh.remove(slot);
                corners.iter().for_each(|&v| self.touched[v as usize] = now);
            }
        }
        let new = self.recorder.vertex();
        self.mesh.add_vertex(accepted.point);
        for affected in &self.neighbourhood.affected {
            let slot = affected.slot;
            if let Some(corners) = self.mesh.get(slot) {
                let vertices = self.jumps.vertices(slot, corners);
                // Beyond a jump the vertex stays, at its place and with its values.
                if prey.vertices().contains(&vertices[affected.corner]) {
                    self.recorder.death(slot, vertices);
                    self.recorder.birth(slot);
                    self.jumps.set(slot, affected.corner, new);
                }
                let bits = self.neighbourhood.boundary_bits(&self.mesh, prey, affected);
                self.mesh.move_corner(slot, affected.corner, bits);
                affected.base.iter().for_each(|&v| self.touched[v as usize] = now);
                changed(slot);
            }
        }
        self.touched.push(now);
        self.errors.push(accepted.error);
        let surroundings = Surroundings { mesh: &self.mesh, jumps: &self.jumps, around: &self.neighbourhood };
        self.fields.deviate(surroundings, prey.vertices(), new);
        self.metric.add_vertex(prey.vertices());
        self.creases.add_vertex(prey.points());
        self.jumps.add_point(prey.points());
        self.six_volumes_left -= accepted.six_volumes_lost;
        self.record_deviations(&quadric, accepted.point.map(f64::from));
        new
    }

    fn record_deviations(&mut self, quadric: &Quadric, p: Vector) {
        let [xx, _, _, yy, _, zz] = quadric.a;
        let squared = quadric.at(self.metric.local(p)).max(0.0) / (xx + yy + zz).max(f64::MIN_POSITIVE);
        let last = self.quadric_distances.last().copied().unwrap_or(0.0);
        self.quadric_distances.push(last.max(self.unit.to_mesh(squared.sqrt())));
        for (values, &worst) in self.field_deviations.iter_mut().zip(&self.fields.worst) {
            values.push(worst);
        }
    }

    /// The mesh and its history; `by_tetrahedra` are the fusions of tetrahedra and the tetrahedra
    /// they left.
    pub(super) fn finish(self, by_tetrahedra: [usize; 2]) -> Decimated<TetrahedronMesh, 4, FusionReport> {
        let alive = self.mesh.iter().map(|(slot, corners)| (slot, self.jumps.vertices(slot, corners)));
        let mut history = self.recorder.finish(&alive.collect::<Vec<_>>());
        let names = std::iter::once("planar quadric").chain(self.fields.names()).map(str::to_owned);
        let values = std::iter::once(self.quadric_distances).chain(self.field_deviations);
        history.deviations = names.zip(values).map(|(name, values)| Deviation { name, values }).collect();
        let born = &self.mesh.positions()[self.input.positions.len()..];
        let born = born.iter().map(|&p| self.unit.point_to_mesh(p));
        let mesh = TetrahedronMesh {
            positions: self.input.positions.iter().copied().chain(born).collect(),
            attributes: self.fields.into_attributes(),
            ..self.input
        };
        let [n_tetrahedron_fusions, n_left_by_tetrahedra] = by_tetrahedra;
        let report = FusionReport {
            n_fusions: self.n_fusions,
            n_tetrahedron_fusions,
            n_left_by_tetrahedra,
            #[cfg(test)]
            n_read: self.mesh.n_read(),
        };
        Decimated { mesh, history, report }
    }
}
