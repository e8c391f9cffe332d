//! What JADE is asked for.

use serde::{Deserialize, Serialize};

/// Largest [`JadeOptions::k`]. Larger ones would start at limits far below what coordinates can
/// tell apart, and need iterations without number.
pub const MAX_K: f64 = 1e12;

/// Smallest [`JadeOptions::c1`]. Smaller ones would raise the limits by next to nothing.
pub const MIN_C1: f64 = 1.001;

/// Where the vertices of a level may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Placement {
    /// Where the input has them.
    #[default]
    Original,
    /// Where the error is least. Fewer triangles for an error and a longer history: a vertex that
    /// moves is a new one.
    Best,
}

/// Constants of the algorithm, by their names in the paper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JadeOptions {
    /// The first limit on the local error is the largest one divided by this (section 5). From 1
    /// to [`MAX_K`].
    pub k: f64,
    /// Factor from one iteration's limit to the next (section 5). From [`MIN_C1`] to 16.
    pub c1: f64,
    /// Limit on the global error as a multiple of that on the local error (section 5). From 1
    /// to 16.
    pub c2: f64,
    /// How much worse than in the star a flipped edge may make the aspect ratio, as a part of it
    /// (section 6).
    pub aspect_loss: f64,
    /// Where vertices may be. [`Placement::Best`] needs the certified bound.
    pub placement: Placement,
}

impl JadeOptions {
    /// The paper's constants for vertices that stay. For vertices that move, limits of which ten
    /// make a decade and that end just below the largest one: a level has just been finished at
    /// the errors that people ask for, such as 0.1, 0.2 and 0.5 %.
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
