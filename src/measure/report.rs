//! Options and results of a measurement.

use serde::Serialize;

/// How closely two surfaces are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasureOptions {
    /// Samples on the edges, and as many inside the triangles, of each of the two surfaces, at
    /// least 1.
    pub n_samples: usize,
    /// Width of the proven bracket to aim at, as a part of the distance: `0.01` is 1 %.
    pub tolerance: f64,
    /// Pieces of one surface that the proof may bound, beside a few for each tile of samples,
    /// before it stops and reports the bracket so far.
    pub max_pieces: usize,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self { n_samples: 1_000_000, tolerance: 0.01, max_pieces: 4_000_000 }
    }
}

/// The distance between two surfaces. Lengths are in mesh units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distance {
    /// Largest distance found, the larger of both directions: the Hausdorff distance to within the
    /// bracket.
    pub max: f64,
    /// Mean over the samples, the mean of both directions.
    pub mean: f64,
    /// Root of the mean square over the samples, the larger of both directions.
    pub rms: f64,
    /// Proven: the Hausdorff distance is no less.
    pub lower_bound: f64,
    /// Proven: the Hausdorff distance is no more.
    pub upper_bound: f64,
    /// Whether the brackets of both directions are as narrow as the tolerance asks.
    pub is_within_tolerance: bool,
    /// From the reference to the mesh.
    pub forward: OneSided,
    /// From the mesh to the reference.
    pub backward: OneSided,
    /// Length of the diagonal of the reference's bounding box.
    pub bounding_diagonal: f64,
}

/// The distance of the points of one surface from another. Lengths are in mesh units.
///
/// `mean` and `rms` count what Metro counts: every vertex, samples along the edges by length,
/// samples in the triangles by area, each once. `area_mean` and `area_rms` are the integrals over
/// the surface, from the samples in the triangles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OneSided {
    /// Largest distance found.
    pub max: f64,
    /// Mean over all samples.
    pub mean: f64,
    /// Root of the mean square over all samples.
    pub rms: f64,
    /// Mean by area. For a surface without area, by length; without length, over its points.
    pub area_mean: f64,
    /// Root of the mean square by area, length or points, like `area_mean`.
    pub area_rms: f64,
    /// Proven: the largest distance is no less.
    pub lower_bound: f64,
    /// Proven: the largest distance is no more.
    pub upper_bound: f64,
    /// A point at the largest distance found, in file coordinates.
    pub farthest: [f64; 3],
    /// Samples that were taken, vertices included.
    pub n_samples: usize,
    /// Pieces that the proof has bounded.
    pub n_pieces: usize,
}

/// Result of [`check_within`](super::check_within).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Verdict {
    /// Proven: neither surface has a point farther from the other than the limit.
    Within,
    /// Proven: there is such a point.
    Beyond {
        /// Its distance, in mesh units.
        distance: f64,
        /// The point, in file coordinates.
        farthest: [f64; 3],
    },
    /// The distance is too close to the limit to tell, or the proof would need more pieces than are
    /// allowed.
    Undecided {
        /// Proven: the Hausdorff distance is no more, in mesh units.
        upper_bound: f64,
    },
}
