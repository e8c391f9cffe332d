//! Two surfaces side by side, and the measurement from one to the other.

use super::error::{MeasureError, Side};
use super::prove::{self, Bracket, Goal, Parts};
use super::report::{MeasureOptions, OneSided};
use super::samples::Samples;
use super::search::TriangleTree;
use super::surface::{Frame, MeasuredSurface};
use super::sweep::{self, SampleSums};
use crate::TriangleMesh;
use crate::geometry::distance::Segment;
use nephrite_formats::MeshFault;

/// Rounding of one distance and of everything that led to its corners, in units of the largest
/// coordinate: `1024 f64::EPSILON`. The closest point costs 16, placing a mesh in the frame 2, and
/// each of at most 139 cuts of a piece 1.
pub(super) const SLACK: f64 = 1.0 / (1u64 << 42) as f64;

/// Two surfaces in one frame.
pub(super) struct Pair {
    /// Where both are measured.
    pub(super) frame: Frame,
    surfaces: [MeasuredSurface; 2],
    /// The uncertainty of distances.
    pub(super) uncertainty: Uncertainty,
}

impl Pair {
    /// Places the mesh beside the reference.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if one of them is not a surface.
    pub(super) fn new(reference: &TriangleMesh, mesh: &TriangleMesh) -> Result<Self, MeasureError> {
        for (side, found) in [(Side::Reference, reference.rounding), (Side::Mesh, mesh.rounding)] {
            if !(found.is_finite() && found >= 0.0) {
                return Err(MeasureError::Inconsistent { side, fault: MeshFault::Rounding { found } });
            }
        }
        let frame = Frame::new(reference)?;
        let (first, second) = rayon::join(
            || MeasuredSurface::new(reference, &frame, Side::Reference),
            || MeasuredSurface::new(mesh, &frame, Side::Mesh),
        );
        let surfaces = [first?, second?];
        let uncertainty = Uncertainty {
            slack: SLACK * surfaces[0].magnitude.max(surfaces[1].magnitude),
            rounding: reference.rounding + mesh.rounding,
        };
        Ok(Self { frame, surfaces, uncertainty })
    }

    /// From the reference to the mesh, and back.
    pub(super) fn directions(&self) -> [(&MeasuredSurface, &TriangleTree); 2] {
        let [reference, mesh] = &self.surfaces;
        [(reference, &mesh.tree), (mesh, &reference.tree)]
    }
}

/// The difference between a computed distance and that of the surfaces in the files.
pub(super) struct Uncertainty {
    /// Floating point, as a length.
    slack: f64,
    /// How far the vertices moved when the meshes were read.
    rounding: f64,
}

impl Uncertainty {
    /// Added to every bound, so that it holds for the surfaces in the files.
    pub(super) fn total(&self) -> f64 {
        self.slack + self.rounding
    }

    /// Distances below this are not distinguished.
    pub(super) fn floor(&self) -> f64 {
        4.0 * self.slack + self.rounding
    }
}

/// Measures from one surface to the other; `farthest` is given in the frame.
pub(super) fn measure_one_sided(
    source: &MeasuredSurface,
    target: &TriangleTree,
    uncertainty: &Uncertainty,
    options: &MeasureOptions,
) -> OneSided {
    let goal = Goal::Tolerance { tolerance: options.tolerance, floor: uncertainty.floor() };
    let distances = sweep::point_distances(&source.vertices, target);
    let vertices = sweep::tally_points(&source.vertices, &distances);

    let segments: Vec<Segment> =
        source.edges.iter().map(|edge| edge.map(|v| source.vertices[v as usize])).collect();
    let edges = sweep::sweep_edges(&Samples::new(&segments, options.n_samples, 0.0), target);

    let settled_sq = goal.settled_sq(vertices.farthest.or(edges.farthest).distance_sq);
    // Tiles no larger than the triangles of the target have good first bounds, however few the
    // samples.
    let samples = Samples::new(source.tree.triangles(), options.n_samples, target.triangles().len() as f64);
    let (faces, parts) = sweep::sweep_faces(&samples, target, settled_sq);

    let farthest = vertices.farthest.or(edges.farthest).or(faces.farthest).or(parts.farthest);
    let bracket = prove::refine(Parts { farthest, ..parts }, target, goal, options.max_pieces);
    summarize([vertices, edges, faces], &bracket, uncertainty, options)
}

/// The numbers of one direction from the tallies of vertices, edges and faces and from the bracket.
fn summarize(
    [vertices, edges, faces]: [SampleSums; 3],
    bracket: &Bracket,
    uncertainty: &Uncertainty,
    options: &MeasureOptions,
) -> OneSided {
    // Metro takes no more vertices than samples. Here all vertices count, with the total weight of
    // those that Metro would take.
    let vertex_weight = (options.n_samples as f64 / vertices.n as f64).min(1.0);
    let weighted = |of: fn(&SampleSums) -> f64| vertex_weight * of(&vertices) + of(&edges) + of(&faces);
    let n = weighted(|tally| tally.n as f64);
    let own = [&faces, &edges].into_iter().find(|tally| tally.n > 0).unwrap_or(&vertices);
    let max = bracket.farthest.distance_sq.sqrt();
    OneSided {
        max,
        mean: weighted(|tally| tally.sum) / n,
        rms: (weighted(|tally| tally.sum_sq) / n).sqrt(),
        area_mean: own.sum / own.n as f64,
        area_rms: (own.sum_sq / own.n as f64).sqrt(),
        lower_bound: (max - uncertainty.total()).max(0.0),
        upper_bound: bracket.upper_sq.sqrt() + uncertainty.total(),
        farthest: bracket.farthest.point,
        n_samples: vertices.n + edges.n + faces.n,
        n_pieces: bracket.n_pieces,
    }
}
