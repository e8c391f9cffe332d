//! Which triangle of a filling a point lies over.

use crate::geometry::height_triangle::HeightTriangle;
use crate::geometry::vector::{Vector, cross, dot, sub};
use crate::mesh::{Filling, Hole};

/// The triangles of a filling, and the half-spaces beside its inner edges, upright on the average
/// plane of its hole.
#[derive(Clone, Debug, Default)]
pub(super) struct Location {
    /// The triangles; `None` for those too thin to measure heights over.
    triangles: Vec<Option<HeightTriangle>>,
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
        self.triangles.clear();
        for (at, &[a, b, c]) in filling.triangles.iter().enumerate() {
            let triangle = HeightTriangle::new(filling.triangle(hole, at));
            self.triangles.push(Some(triangle).filter(HeightTriangle::is_sound));
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

    /// Squared distance of `p` to a triangle; `None` unless `p` lies over it along its normal.
    #[inline]
    pub(super) fn height_sq(&self, triangle: usize, p: Vector) -> Option<f64> {
        self.triangles[triangle].as_ref()?.height_sq(p)
    }

    /// A triangle whose inner edges all have `p` on their left: `guess` where that is one, or else
    /// the first.
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
