//! What a level's error means: the paper's estimates, and the proof.

pub(crate) mod accumulated;
pub(crate) mod certified;
pub(crate) mod estimate;
mod limits;
pub(crate) mod removed;
mod replacement;

pub(crate) use limits::{Errors, Limits};
pub(crate) use replacement::Replacement;

use crate::mesh::{Hole, Renumbering, Surface, TooMany};
use certified::{Certified, MapChange, Transfer};
use estimate::{Estimate, EstimateChange, EstimateKind};

/// An error is followed up to so many times its limit: what a removal needs is then known well
/// enough for the limits to come, and farther off it does not matter yet.
pub(crate) const REACH: f64 = 2.0;

/// The error of the current mesh, in one meaning or the other.
#[derive(Clone, Debug)]
pub(crate) enum GlobalError {
    /// Proven.
    Certified(Certified),
    /// Estimated as in the paper.
    Estimate(Estimate),
}

/// What a replacement changes in the errors.
#[derive(Clone, Debug)]
pub(crate) enum Change {
    /// In the map of the proof.
    Certified(MapChange),
    /// In the estimates.
    Estimate(EstimateChange),
}

impl GlobalError {
    /// The error at the start, when `surface` is the input but for `rounding`: how far reading it
    /// moved the worst vertex. Without an estimate it is proven.
    pub(crate) fn new(estimate: Option<EstimateKind>, surface: &Surface, rounding: f64) -> Self {
        match estimate {
            None => Self::Certified(Certified::new(surface, rounding)),
            Some(kind) => Self::Estimate(Estimate::new(kind, surface)),
        }
    }

    /// The errors of a replacement and what it changes, without changing it. If the errors are
    /// above the limits, only the errors, or lower bounds of them above the limits.
    pub(crate) fn change(
        &self,
        replacement: Replacement<'_>,
        limits: Limits,
        transfer: &mut Transfer,
    ) -> Result<(Errors, Change), Errors> {
        match self {
            Self::Certified(certified) => {
                let found = certified.change(replacement, limits.global, transfer);
                let errors = |global| Errors { local: 0.0, global };
                found.map(|(global, change)| (errors(global), Change::Certified(change))).map_err(errors)
            }
            Self::Estimate(estimate) => {
                let errors = estimate.errors(replacement, limits.scaled(REACH));
                let is_within = errors.within(limits);
                if is_within {
                    Ok((errors, Change::Estimate(estimate.change(replacement))))
                } else {
                    Err(errors)
                }
            }
        }
    }

    /// Gives back memory that finished removals left behind.
    pub(crate) fn compact(&mut self) {
        if let Self::Certified(certified) = self {
            certified.compact();
        }
    }

    /// Gives every slot its new number; changes found before have the old ones.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        match self {
            Self::Certified(certified) => certified.renumber_slots(slots),
            Self::Estimate(estimate) => estimate.renumber_slots(slots),
        }
    }

    /// Whether there is room for these changes of the stars of their holes. O(changes).
    ///
    /// # Errors
    ///
    /// What there would be too many of.
    pub(crate) fn check_room<'a>(
        &self,
        changes: impl Iterator<Item = (&'a Hole, &'a Change)> + Clone,
    ) -> Result<(), TooMany> {
        match self {
            Self::Certified(certified) => certified.check_room(of_map(changes)),
            Self::Estimate(_) => Ok(()),
        }
    }

    /// Applies what was found for the replacement of the star of each hole, one after another. No
    /// two change the same star or move the same source edge, and there is
    /// [room](Self::check_room) for them.
    pub(crate) fn apply_all<'a>(
        &mut self,
        changes: impl Iterator<Item = (&'a Hole, &'a Change)> + Clone + Send,
    ) {
        match self {
            Self::Certified(certified) => certified.apply_all(of_map(changes)),
            Self::Estimate(estimate) => {
                for (hole, change) in changes {
                    if let Change::Estimate(change) = change {
                        estimate.apply(hole, change);
                    }
                }
            }
        }
    }
}

impl Change {
    /// Source edges that get another way over the mesh.
    pub(crate) fn moved_edges(&self) -> impl Iterator<Item = u32> {
        let chains = match self {
            Self::Certified(change) => change.chains.as_slice(),
            Self::Estimate(_) => &[],
        };
        chains.iter().map(|chain| chain.edge)
    }
}

/// The changes in the map of the proof.
fn of_map<'a>(
    changes: impl Iterator<Item = (&'a Hole, &'a Change)> + Clone,
) -> impl Iterator<Item = (&'a Hole, &'a MapChange)> + Clone {
    changes.filter_map(|(hole, change)| match change {
        Change::Certified(change) => Some((hole, change)),
        Change::Estimate(_) => None,
    })
}
