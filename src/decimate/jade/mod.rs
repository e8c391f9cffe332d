//! JADE: simplification by vertex removal under a bound on the global error.
//!
//! A. Ciampalini, P. Cignoni, C. Montani and R. Scopigno, "Multiresolution decimation based on global error", *The
//! Visual Computer* 13, 1997. The paper goes through the vertices one by one, under limits that rise from iteration to
//! iteration, and removes whatever is below them. Here an iteration works in rounds over an independent set, cheapest first:
//! its candidates are judged in parallel, a batch at a time, and those within the limits removed. No heap is needed, and the
//! result does not depend on the number of threads.

pub mod asked;
pub mod batch;
pub mod best_place;
pub mod candidate;
pub mod classify;
pub mod crossings;
pub mod decimation;
pub mod ears;
pub mod fit;
pub mod flip;
pub mod optimal;
pub mod placement;
pub mod removal;
pub mod rounds;
pub mod thresholds;
pub mod triangulate;
pub mod validity;
pub mod worklists;

/// Largest [`JadeOptions::k`], and least [`JadeOptions::c1`]: limits far below what coordinates can tell apart, or steps of next
/// to nothing, would make iterations without number.
pub const MAX_K: f64 = 1e12;
/// See [`MAX_K`].
pub const MIN_C1: f64 = 1.001;

/// Where the vertices of a level may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Placement {
    /// Where the input has them.
    #[default]
    Original,
    /// Where the error is least. Fewer triangles for an error, and a longer history: a vertex that moves is a new one.
    Best,
}

/// Constants of the algorithm, by their names in the paper.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct JadeOptions {
    /// The first limit on the local error is the largest one divided by this (section 5). From 1 to [`MAX_K`].
    pub k: f64,
    /// Factor from one iteration's limit to the next (section 5). From [`MIN_C1`] to 16.
    pub c1: f64,
    /// Limit on the global error as a multiple of that on the local error (section 5). At least 1.
    pub c2: f64,
    /// How much worse than in the star a flipped edge may make the aspect ratio, as a part of it (section 6).
    pub aspect_loss: f64,
    /// Where vertices may be. Another one than the original needs the certified bound.
    pub placement: Placement,
}

impl JadeOptions {
    /// The paper's constants for vertices that stay; for vertices that move, limits that are ten to the decade and end just below
    /// the largest: errors that people ask for, such as 0.1, 0.2 and 0.5 %, then find a level that has just been finished.
    pub fn of_placement(placement: Placement) -> Self {
        const C2: f64 = 1.2;
        let (k, c1) = match placement {
            Placement::Original => (256.0, 1.3),
            Placement::Best => (240.5, 10_f64.powf(0.1)),
        };
        Self { k, c1, c2: C2, aspect_loss: 0.5, placement }
    }
}

impl Default for JadeOptions {
    fn default() -> Self {
        Self::of_placement(Placement::Original)
    }
}
