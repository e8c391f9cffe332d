//! Bounding boxes.

use super::vector::{Vector, add, length, max, midpoint, min, sub, widen};

/// A box with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    /// Least coordinates.
    pub low: Vector,
    /// Largest coordinates.
    pub high: Vector,
}

impl Bounds {
    /// The box that holds nothing.
    pub(crate) const EMPTY: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    /// Smallest box around `points`. O(n).
    #[inline]
    pub(crate) fn around(points: impl IntoIterator<Item = Vector>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| bounds.union(&Self { low: p, high: p }))
    }

    /// Smallest box around `positions`; a point at the origin if there are none. O(n).
    pub(crate) fn around_positions(positions: &[[f32; 3]]) -> Self {
        if positions.is_empty() {
            return Self { low: [0.0; 3], high: [0.0; 3] };
        }
        Self::around(positions.iter().map(|&p| widen(p)))
    }

    /// Smallest box around two.
    #[inline(always)]
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { low: min(self.low, other.low), high: max(self.high, other.high) }
    }

    /// Lengths of the sides; 0 for the empty box.
    #[inline(always)]
    pub(crate) fn extent(&self) -> Vector {
        max(sub(self.high, self.low), [0.0; 3])
    }

    /// Length of the diagonal.
    pub(crate) fn diagonal(&self) -> f64 {
        length(self.extent())
    }

    /// Half the surface area.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f64 {
        let [x, y, z] = self.extent();
        x * y + y * z + z * x
    }

    /// The middle.
    pub(crate) fn center(&self) -> Vector {
        midpoint(self.low, self.high)
    }

    /// Twice the middle.
    #[inline(always)]
    pub(crate) fn center_twice(&self) -> Vector {
        add(self.low, self.high)
    }

    /// Least and largest coordinates in `f32`: exact for a box around positions, zero for the empty
    /// box.
    #[expect(clippy::cast_possible_truncation, reason = "they were f32 before")]
    pub(crate) fn to_f32(self) -> ([f32; 3], [f32; 3]) {
        if self == Self::EMPTY {
            return ([0.0; 3], [0.0; 3]);
        }
        (self.low.map(|x| x as f32), self.high.map(|x| x as f32))
    }
}

/// Length of the diagonal of the box around `positions`; zero if there are none. O(n).
pub(crate) fn bounding_diagonal(positions: &[[f32; 3]]) -> f64 {
    Bounds::around_positions(positions).diagonal()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_ends_at_the_outermost_points() {
        let bounds = Bounds::around_positions(&[[1.0, -2.0, 3.0], [0.0, 2.0, 3.0], [-1.0, 0.0, 2.0]]);
        assert_eq!(bounds, Bounds { low: [-1.0, -2.0, 2.0], high: [1.0, 2.0, 3.0] });
        assert_eq!(bounds.to_f32(), ([-1.0, -2.0, 2.0], [1.0, 2.0, 3.0]));
        assert_eq!(bounds.extent(), [2.0, 4.0, 1.0]);
        assert_eq!((bounds.center(), bounds.center_twice()), ([0.0, 0.0, 2.5], [0.0, 0.0, 5.0]));
        assert_eq!(bounds.diagonal(), 21_f64.sqrt());
        assert_eq!(bounds.half_area(), 14.0);
    }

    #[test]
    fn nothing_has_no_size() {
        assert_eq!(Bounds::EMPTY.extent(), [0.0; 3]);
        assert_eq!(Bounds::EMPTY.to_f32(), ([0.0; 3], [0.0; 3]));
        assert_eq!(bounding_diagonal(&[]), 0.0);
        let bounds = Bounds::around([[1.0; 3]]);
        assert_eq!(Bounds::EMPTY.union(&bounds), bounds);
    }
}
