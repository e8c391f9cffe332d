//! The distance between two surfaces: sampled like Metro's, and a bracket that is proven.
//!
//! The one-sided distance from a surface to another is the largest distance of a point of the one
//! from the other; the Hausdorff distance is the larger of both directions. A one-sided distance
//! can be zero while the other is large, so both are always measured. Samples alone give a mean and
//! a lower bound; the upper bound comes from a proof over pieces of the surfaces.
//!
//! References: Cignoni, Rocchini and Scopigno, *Metro: measuring error on simplified surfaces*,
//! Computer Graphics Forum 17(2), 1998, for the sampling; Tang, Lee and Kim, *Interactive Hausdorff
//! distance computation for general polygonal models*, ACM Transactions on Graphics 28(3), 2009,
//! for a bracket by branch and bound.

mod batch;
mod bvh;
mod error;
mod fields;
mod found;
mod histogram;
mod index;
mod locator;
mod pair;
mod pieces;
mod polygon;
mod prove;
mod report;
mod samples;
mod search;
mod surface;
mod sweep;
mod walls;

pub use self::error::{MeasureError, Side};
pub use self::fields::{FieldDistance, measure_fields};
pub use self::histogram::Histogram;
pub(crate) use self::index::TriangleIndex;
use self::pair::{Pair, measure_one_sided};
pub(crate) use self::pieces::bound_of_pieces;
use self::prove::{Bracket, Goal, Parts};
pub use self::report::{Distance, MeasureOptions, OneSided, Verdict};
use self::samples::Samples;
use self::surface::{Frame, MeasuredSurface};
pub(crate) use self::walls::inner_walls;
use crate::TriangleMesh;
use crate::geometry::vector::{self, Vector};

/// Measures how far two surfaces are apart, both ways.
///
/// Any two meshes can be compared: open, non-manifold, intersecting themselves, with triangles
/// without area, with different origins. Vertices that no triangle uses are not on a surface. The
/// bracket accounts for floating point by [a stated slack](Distance::lower_bound) of `2^-42` times
/// the largest coordinate about the reference's centre, and for the
/// [`rounding`](TriangleMesh::rounding) that both meshes report: it holds for the surfaces as their
/// files have them. The same meshes and options give the same numbers on any number of threads.
///
/// Cost: about 0.1 us for each sample, plus the hierarchies, about 0.2 us for each triangle.
///
/// # Errors
///
/// [`MeasureError`] for a mesh without triangles, with indices out of range, with coordinates that
/// are not finite, and for options that ask for no samples or no tolerance.
///
/// # Examples
///
/// ```
/// use nephrite::TriangleMesh;
/// use nephrite::measure::{MeasureOptions, measure};
///
/// let square = |z: f32| TriangleMesh {
///     positions: vec![[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]],
///     triangles: vec![[0, 1, 2], [0, 2, 3]],
///     ..TriangleMesh::default()
/// };
/// let options = MeasureOptions { n_samples: 1000, ..MeasureOptions::default() };
/// let distance = measure(&square(0.0), &square(0.5), &options)?;
/// assert_eq!(distance.max, 0.5);
/// assert!(distance.lower_bound <= 0.5 && 0.5 <= distance.upper_bound);
/// # Ok::<(), nephrite::measure::MeasureError>(())
/// ```
pub fn measure(
    reference: &TriangleMesh,
    mesh: &TriangleMesh,
    options: &MeasureOptions,
) -> Result<Distance, MeasureError> {
    if options.n_samples == 0 {
        return Err(MeasureError::NoSamples);
    }
    if !(options.tolerance > 0.0 && options.tolerance.is_finite()) {
        return Err(MeasureError::BadTolerance { found: options.tolerance });
    }
    let pair = Pair::new(reference, mesh)?;
    let [forward, backward] = pair.directions().map(|(source, target)| {
        let one_sided = measure_one_sided(source, target, &pair.uncertainty, options);
        OneSided { farthest: pair.frame.to_file(one_sided.farthest), ..one_sided }
    });
    let is_narrow = |one_sided: &OneSided| {
        let width = one_sided.upper_bound - one_sided.lower_bound - 2.0 * pair.uncertainty.total();
        width <= options.tolerance * one_sided.upper_bound
            || one_sided.upper_bound <= 2.0 * pair.uncertainty.floor()
    };
    let lower_bound = forward.lower_bound.max(backward.lower_bound);
    let upper_bound = forward.upper_bound.max(backward.upper_bound);
    Ok(Distance {
        max: forward.max.max(backward.max),
        mean: 0.5 * (forward.mean + backward.mean),
        rms: forward.rms.max(backward.rms),
        lower_bound,
        upper_bound,
        is_within_tolerance: is_narrow(&forward) && is_narrow(&backward),
        forward,
        backward,
        bounding_diagonal: pair.frame.bounding_diagonal,
    })
}

/// Proves that the Hausdorff distance of two surfaces is at most `limit`, in mesh units, or that it
/// is not.
///
/// Much cheaper than [`measure`] where the limit is not close to the distance: nothing is sampled,
/// and every piece is settled as soon as it is within the limit. Floating point and rounding are
/// accounted for as there, so a limit below both is never proven.
///
/// # Errors
///
/// [`MeasureError`], as for [`measure`].
pub fn check_within(
    reference: &TriangleMesh,
    mesh: &TriangleMesh,
    limit: f64,
    max_pieces: usize,
) -> Result<Verdict, MeasureError> {
    let pair = Pair::new(reference, mesh)?;
    let uncertainty = pair.uncertainty.total();
    let goal = Goal::AtMost((limit - uncertainty).max(0.0));
    let mut upper_bound = 0.0f64;
    for (source, target) in pair.directions() {
        let distances = sweep::point_distances(&source.vertices, target);
        let mut farthest = sweep::tally_points(&source.vertices, &distances).farthest;
        let mut bracket = Bracket { farthest, upper_sq: f64::INFINITY, n_pieces: 0 };
        if farthest.distance_sq.sqrt() <= limit {
            let tiles = Samples::cut(source.tree.triangles(), target.triangles().len() as f64);
            let (_, parts) = sweep::sweep_faces(&tiles, target, goal.settled_sq(0.0));
            let farthest_seen = farthest.or(parts.farthest);
            bracket = prove::refine(Parts { farthest: farthest_seen, ..parts }, target, goal, max_pieces);
            farthest = bracket.farthest;
        }
        let distance = farthest.distance_sq.sqrt();
        if distance - uncertainty > limit {
            return Ok(Verdict::Beyond { distance, farthest: pair.frame.to_file(farthest.point) });
        }
        upper_bound = upper_bound.max(bracket.upper_sq.sqrt() + uncertainty);
    }
    Ok(if upper_bound <= limit { Verdict::Within } else { Verdict::Undecided { upper_bound } })
}

/// Distance of every vertex of a mesh from another surface, in mesh units, in the order of the
/// vertices; NaN for a vertex that is not finite, which no triangle uses.
///
/// # Errors
///
/// [`MeasureError`], as for [`measure`], where `other` takes the place of the reference.
pub fn vertex_distances(mesh: &TriangleMesh, other: &TriangleMesh) -> Result<Vec<f64>, MeasureError> {
    let frame = Frame::new(other)?;
    let target = MeasuredSurface::new(other, &frame, Side::Reference)?.tree;
    let offset = frame.offset(mesh);
    let points: Vec<Vector> =
        mesh.positions.iter().map(|&position| vector::add(vector::widen(position), offset)).collect();
    Ok(sweep::point_distances(&points, &target))
}

/// Distances of `n_samples` points of a surface, spread evenly by area, from another, in mesh
/// units; fewer if the surface has no area.
///
/// # Errors
///
/// [`MeasureError`], as for [`measure`], where `other` takes the place of the reference.
pub fn sample_distances(
    mesh: &TriangleMesh,
    other: &TriangleMesh,
    n_samples: usize,
) -> Result<Vec<f64>, MeasureError> {
    let frame = Frame::new(other)?;
    let source = MeasuredSurface::new(mesh, &frame, Side::Mesh)?;
    let target = MeasuredSurface::new(other, &frame, Side::Reference)?;
    Ok(sweep::face_distances(&Samples::new(source.tree.triangles(), n_samples, 0.0), &target.tree))
}
