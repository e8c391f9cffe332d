//! What JADE is asked for.

use crate::bound::estimate::EstimateKind;

/// Where the vertices of a level may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Placement {
    /// Where the input has them.
    #[default]
    Original,
    /// Where the error is least. Fewer triangles for an error, and a longer history: a vertex that
    /// moves is a new one.
    Best,
}

/// What the errors of a build by JADE mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JadeBound {
    /// A proven bound on the two-sided Hausdorff distance to the input. Only the proof follows
    /// vertices that move.
    Certified(Placement),
    /// One of the paper's estimates.
    Estimate {
        /// Which one.
        kind: EstimateKind,
        /// How much worse than in the star a flipped edge may make the aspect ratio, as a part of
        /// it (section 6). From 0 to 1. Edges are flipped towards a smaller estimate; under the
        /// proof nothing is flipped.
        aspect_loss: f64,
    },
}

/// Constants of the algorithm, by their names in the paper.
///
/// Fields may be added: write `..JadeOptions::default()` behind those you set.
///
/// ```
/// use nephrite::{JadeBound, JadeOptions, Placement};
/// let best = JadeOptions { c2: 1.1, ..JadeOptions::certified(Placement::Best) };
/// assert_eq!(best.bound, JadeBound::Certified(Placement::Best));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JadeOptions {
    /// What the errors mean.
    pub bound: JadeBound,
    /// The first limit on the local error is the largest one divided by this (section 5). From 1 to
    /// [`MAX_K`](Self::MAX_K); `None` for 256, or for 240.5 where vertices move.
    pub k: Option<f64>,
    /// Factor from one iteration's limit to the next (section 5). From [`MIN_C1`](Self::MIN_C1) to
    /// 16; `None` for 1.3, or for the tenth root of 10 where vertices move.
    pub c1: Option<f64>,
    /// Limit on the global error as a multiple of that on the local error (section 5). From 1 to
    /// 16.
    pub c2: f64,
}

impl JadeOptions {
    /// Largest [`k`](Self::k). Larger ones would start at limits far below what coordinates can
    /// tell apart, and need iterations without number.
    pub const MAX_K: f64 = 1e12;

    /// Smallest [`c1`](Self::c1). Smaller ones would raise the limits by next to nothing.
    pub const MIN_C1: f64 = 1.001;

    /// A proof, with vertices placed like this.
    pub fn certified(placement: Placement) -> Self {
        Self { bound: JadeBound::Certified(placement), k: None, c1: None, c2: 1.2 }
    }

    /// An estimate, with edges flipped as in the paper.
    pub fn estimate(kind: EstimateKind) -> Self {
        Self { bound: JadeBound::Estimate { kind, aspect_loss: 0.5 }, ..Self::default() }
    }

    /// Where vertices may be.
    pub(crate) fn placement(&self) -> Placement {
        match self.bound {
            JadeBound::Certified(placement) => placement,
            JadeBound::Estimate { .. } => Placement::Original,
        }
    }

    /// The estimate that decides; `None` under the proof.
    pub(crate) fn estimate_kind(&self) -> Option<EstimateKind> {
        match self.bound {
            JadeBound::Certified(_) => None,
            JadeBound::Estimate { kind, .. } => Some(kind),
        }
    }

    /// See [`JadeBound::Estimate`]; 0 where nothing is flipped.
    pub(crate) fn aspect_loss(&self) -> f64 {
        match self.bound {
            JadeBound::Certified(_) => 0.0,
            JadeBound::Estimate { aspect_loss, .. } => aspect_loss,
        }
    }

    /// The value of `k`, given or not. For vertices that move the limits are ten to the decade and
    /// end just below the largest: errors that people ask for, such as 0.1, 0.2 and 0.5 %, then
    /// find a level that has just been finished.
    pub(crate) fn k_value(&self) -> f64 {
        self.k.unwrap_or(match self.placement() {
            Placement::Original => 256.0,
            Placement::Best => 240.5,
        })
    }

    /// The value of `c1`, given or not.
    pub(crate) fn c1_value(&self) -> f64 {
        self.c1.unwrap_or(match self.placement() {
            Placement::Original => 1.3,
            Placement::Best => 10_f64.powf(0.1),
        })
    }
}

impl Default for JadeOptions {
    fn default() -> Self {
        Self::certified(Placement::Original)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_placement_alone_chooses_the_constants() {
        let best = JadeBound::Certified(Placement::Best);
        let from_defaults = JadeOptions { bound: best, ..JadeOptions::default() };
        assert_eq!(from_defaults, JadeOptions::certified(Placement::Best));
        assert_eq!(from_defaults.k_value(), 240.5);
        assert!((from_defaults.c1_value() - 1.2589).abs() < 1e-4);
        assert_eq!((JadeOptions::default().k_value(), JadeOptions::default().c1_value()), (256.0, 1.3));
    }
}
