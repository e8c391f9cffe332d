//! The input vertices that a hole's filling will stand for, and over which part of the hole each of them lies.

use crate::geometry::projection::{Plane, Point2, turn};
use crate::geometry::vector::{Vector, length_sq, scale};
use crate::mesh::{Hole, Surface};

/// Most ring vertices of a hole for which sides are kept: `n (n-1) / 2` of them fit 64 bits.
pub const MAX_CORNERS: usize = 11;

/// Most vertices of a hole that are asked about each triangle that might fill it.
const MAX_ASKED: usize = 128;

/// Source vertices over a hole.
///
/// In the hole's average plane, each ring pair `i < j` is a line, and one bit per vertex tells on which side of it the
/// vertex lies. Whether a vertex lies over a triangle is then a comparison of three bits, and a vertex on a line lies
/// over exactly one of the two triangles there.
#[derive(Clone, Debug, Default)]
pub struct Covered {
    /// The vertices, in no particular order.
    pub vertices: Vec<u32>,
    /// Their positions in the input.
    pub points: Vec<Vector>,
    /// A bit per ring pair and vertex; empty where the hole is too large or has no average plane.
    sides: Vec<u64>,
    ring: Vec<Point2>,
    flat: Vec<Point2>,
}

/// Which bits of a vertex's sides say that it lies over a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Over {
    mask: u64,
    sides: u64,
}

impl Over {
    /// Vertices over the triangle of three ring indices below [`MAX_CORNERS`], in ring order.
    pub fn new([a, b, c]: [u8; 3]) -> Self {
        [[a, b], [b, c], [c, a]].into_iter().fold(Self { mask: 0, sides: 0 }, |over, [i, j]| {
            let bit = pair_bit(i.min(j), i.max(j));
            Self { mask: over.mask | bit, sides: over.sides | if i < j { bit } else { 0 } }
        })
    }
}

fn pair_bit(low: u8, high: u8) -> u64 {
    1 << (usize::from(high) * usize::from(high - 1) / 2 + usize::from(low))
}

impl Covered {
    /// Takes the source vertices of the given lists as those over `hole`. O(vertices * ring pairs).
    pub fn gather<'a>(&mut self, surface: &Surface, hole: &Hole, lists: impl Iterator<Item = &'a [u32]>) {
        self.vertices.clear();
        lists.for_each(|list| self.vertices.extend_from_slice(list));
        self.points.clear();
        self.points.extend(self.vertices.iter().map(|&v| surface.origin(v)));
        self.sides.clear();
        self.ring.clear();
        let normal = hole.average_normal();
        let size_sq = length_sq(normal);
        if hole.n_ring() > MAX_CORNERS || size_sq <= 0.0 || !size_sq.is_finite() {
            return;
        }
        let plane = Plane::new(scale(normal, 1.0 / size_sq.sqrt()));
        let flatten = |p: Vector| plane.project(p, hole.apex);
        self.ring.extend(hole.points.iter().map(|&p| flatten(p)));
        self.flat.clear();
        self.flat.extend(self.points.iter().map(|&p| flatten(p)));
        find_sides(&self.flat, &self.ring, &mut self.sides);
        // A few from everywhere to the front: the ones that are asked.
        let n = self.sides.len();
        if n > MAX_ASKED {
            (0..MAX_ASKED).for_each(|at| self.swap(at, at * n / MAX_ASKED));
        }
    }

    /// Whether sides are known.
    pub fn has_sides(&self) -> bool {
        !self.sides.is_empty()
    }

    /// Twice the area of a triangle of ring indices in the average plane, negative when it faces away.
    pub fn flat_area(&self, triangle: [u8; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| self.ring[usize::from(i)]);
        turn(a, b, c)
    }

    /// Whether the vertex at index `at` is known to lie over a triangle.
    #[inline]
    pub fn is_over(&self, at: usize, over: Over) -> bool {
        self.sides.get(at).is_some_and(|sides| sides & over.mask == over.sides)
    }

    /// Largest of `value` among the points over a triangle, or the first one found above `cutoff`. Of many points some hundred are
    /// asked: enough to choose a triangle by, not to prove anything. A point that ends the search moves
    /// half way to the front: what is too far from one triangle is likely to be so from others, and is found sooner there.
    #[inline]
    pub fn largest_over(&mut self, over: Over, cutoff: f64, value: impl Fn(Vector) -> f64) -> f64 {
        let mut largest = 0.0_f64;
        let mut last = None;
        for (at, (&sides, &p)) in self.sides.iter().take(MAX_ASKED).zip(&self.points).enumerate() {
            if sides & over.mask == over.sides {
                largest = largest.max(value(p));
                if largest > cutoff {
                    last = Some(at);
                    break;
                }
            }
        }
        if let Some(at) = last {
            self.swap(at, at / 2);
        }
        largest
    }

    fn swap(&mut self, i: usize, j: usize) {
        self.vertices.swap(i, j);
        self.points.swap(i, j);
        self.sides.swap(i, j);
    }
}

/// Fills `sides`, which is empty, for points in the plane of the ring: line by line rather than point by point, so that several
/// points are compared at once.
fn find_sides(flat: &[Point2], ring: &[Point2], sides: &mut Vec<u64>) {
    sides.resize(flat.len(), 0);
    let mut bit = 1;
    for (j, &b) in ring.iter().enumerate() {
        for &a in &ring[..j] {
            let across = [a[1] - b[1], b[0] - a[0]];
            let level = across[0] * a[0] + across[1] * a[1];
            for (sides, p) in sides.iter_mut().zip(flat) {
                *sides |= if across[0] * p[0] + across[1] * p[1] >= level { bit } else { 0 };
            }
            bit <<= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Over a convex hole every point inside lies over exactly one triangle of any fan.
        #[test]
        fn a_point_lies_over_one_triangle_of_a_fan(x in -0.6_f64..0.6, y in -0.6_f64..0.6, start in 0_u8..7) {
            let ring: Vec<Point2> = (0..7).map(|i| { let a = f64::from(i) * 0.897; [a.cos(), a.sin()] }).collect();
            let mut sides = vec![];
            find_sides(&[[x, y]], &ring, &mut sides);
            let covered = Covered { sides, points: vec![[x, y, 0.0]], ring, ..Covered::default() };
            let fan = (1..6).map(|i| [start, (start + i) % 7, (start + i + 1) % 7]);
            let holders = fan.filter(|&triangle| covered.is_over(0, Over::new(triangle))).count();
            prop_assert_eq!(holders, 1);
        }
    }
}
