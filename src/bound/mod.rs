//! What a level's error means: the paper's estimates, and the proof.

pub mod accumulated;
pub mod certified;
pub mod covered;
pub mod estimate;
pub mod removed;

use crate::mesh::{Filling, Hole, Surface};
use certified::{Certified, Transfer};
use covered::Covered;
use estimate::Estimate;

/// A star about to be replaced by a filling.
#[derive(Clone, Copy, Debug)]
pub struct Replacement<'a> {
    /// The mesh before it.
    pub surface: &'a Surface,
    /// The star.
    pub hole: &'a Hole,
    /// What closes it; its triangles go into the first slots of the star.
    pub filling: &'a Filling,
}

/// The error of the current mesh, in one meaning or the other.
#[derive(Clone, Debug)]
pub enum GlobalError {
    /// Proven.
    Certified(Certified),
    /// Estimated as in the paper.
    Estimate(Estimate),
}

impl GlobalError {
    /// Takes over what the replacement makes of the errors.
    pub fn commit(&mut self, replacement: Replacement<'_>, covered: &mut Covered, transfer: &mut Transfer) {
        match self {
            Self::Certified(certified) => certified.commit(replacement, covered, transfer),
            Self::Estimate(estimate) => estimate.commit(replacement),
        }
    }
}

/// The largest local and global error that a removal may make now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Limit on the error between the star and its filling.
    pub local: f64,
    /// Limit on the error between the input and the filling.
    pub global: f64,
}

impl Limits {
    /// No limit.
    pub const NONE: Self = Self { local: f64::INFINITY, global: f64::INFINITY };
}

/// Errors that a removal would make, or lower bounds of them once one is above its limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Error between the star and its filling.
    pub local: f64,
    /// Error between the input and the filling.
    pub global: f64,
}

impl Errors {
    /// Whether both errors are within their limits.
    pub fn within(self, limits: Limits) -> bool {
        self.local <= limits.local && self.global <= limits.global
    }
}
