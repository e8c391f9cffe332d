//! Which triangle of a filling a point lies over.

use crate::geometry::vector::{Vector, cross, dot, sub};
use crate::mesh::{Filling, Hole};

/// The half-spaces beside the inner edges of a filling, upright on the average plane of its hole.
#[derive(Clone, Debug, Default)]
pub(super) struct Location {
    half_spaces: Vec<HalfSpace>,
    /// Where the half-spaces of each triangle start, and where all end.
    starts: Vec<usize>,
}

/// The points with `across . point >= level`.
#[derive(Clone, Copy, Debug)]
struct HalfSpace {
    across: Vector,
    level: f64,
}

impl Location {
    /// Makes this the one of `filling`. O(triangles).
    pub(super) fn build(&mut self, hole: &Hole, filling: &Filling) {
        let up = hole.average_normal();
        self.half_spaces.clear();
        self.starts.clear();
        self.starts.push(0);
        for &[a, b, c] in &filling.triangles {
            for [i, j] in [[a, b], [b, c], [c, a]].map(|edge| edge.map(usize::from)) {
                if !hole.is_ring_edge(i, j) {
                    let (from, to) = (hole.points[i], hole.points[j]);
                    let across = cross(up, sub(to, from));
                    self.half_spaces.push(HalfSpace { across, level: dot(across, from) });
                }
            }
            self.starts.push(self.half_spaces.len());
        }
    }

    /// A triangle whose inner edges all have `p` on their left: `guess` where that is one, or else the first.
    #[inline]
    pub(super) fn find(&self, p: Vector, guess: usize) -> Option<usize> {
        if self.holds(guess, p) {
            return Some(guess);
        }
        (0..self.starts.len() - 1).find(|&triangle| self.holds(triangle, p))
    }

    #[inline]
    fn holds(&self, triangle: usize, p: Vector) -> bool {
        let of_triangle = &self.half_spaces[self.starts[triangle]..self.starts[triangle + 1]];
        of_triangle.iter().all(|&HalfSpace { across, level }| dot(across, p) >= level)
    }
}
