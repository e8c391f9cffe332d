//! Answers of searches.

use crate::geometry::vector::Vector;

/// The answer to a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    /// The least value, over all triangles, of the largest squared distance from a corner.
    pub(super) distance_sq: f64,
    /// A triangle with that value.
    pub(super) triangle: u32,
}

impl Found {
    /// Larger than any answer.
    pub(super) const NOTHING: Self = Self { distance_sq: f64::INFINITY, triangle: 0 };
}

/// A point of one surface with its distance from the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Farthest {
    /// Squared distance.
    pub(super) distance_sq: f64,
    /// The point.
    pub(super) point: Vector,
}

impl Farthest {
    /// The farther of the two; this one if they are equally far.
    pub(super) fn or(self, other: Self) -> Self {
        if other.distance_sq > self.distance_sq { other } else { self }
    }
}
