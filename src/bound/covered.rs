//! The input vertices that a hole's filling will stand for, and over which part of the hole each of them lies.

use crate::geometry::projection::{Plane, Point2, turn};
use crate::geometry::vector::{Vector, length_sq, scale};
use crate::mesh::{Hole, Surface};

/// Most ring vertices of a hole for which sides are kept: `n (n-1) / 2` of them fit 64 bits.
pub const MAX_CORNERS: usize = 11;

/// Source vertices over a hole.
///
/// In the hole's average plane, each ring pair `i < j` is a line, and one bit per vertex tells on which side of it the
/// vertex lies. Whether a vertex lies over a triangle is then a comparison of three bits, and a vertex on a line lies
/// over exactly one of the two triangles there.
#[derive(Clone, Debug, Default)]
pub struct Covered {
    /// The vertices, the one to be removed first.
    pub vertices: Vec<u32>,
    /// Their positions in the input.
    pub points: Vec<Vector>,
    /// A bit per ring pair and vertex; empty where the hole is too large or has no average plane.
    sides: Vec<u64>,
    ring: Vec<Point2>,
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
    /// Takes the given source vertices as those over `hole`. O(vertices * ring pairs).
    pub fn gather(&mut self, surface: &Surface, hole: &Hole, vertices: impl Iterator<Item = u32>) {
        self.vertices.clear();
        self.vertices.extend(vertices);
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
        let ring = &self.ring;
        self.sides.extend(self.points.iter().map(|&p| sides_of(flatten(p), ring)));
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

    /// Points over a triangle.
    pub fn points_over(&self, over: Over) -> impl Iterator<Item = Vector> {
        let is_over = move |&(sides, _): &(&u64, &Vector)| sides & over.mask == over.sides;
        self.sides.iter().zip(&self.points).filter(is_over).map(|(_, &p)| p)
    }
}

fn sides_of(p: Point2, ring: &[Point2]) -> u64 {
    let mut sides = 0;
    let mut bit = 1;
    for (j, &b) in ring.iter().enumerate() {
        for &a in &ring[..j] {
            if turn(a, b, p) >= 0.0 {
                sides |= bit;
            }
            bit <<= 1;
        }
    }
    sides
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
            let covered = Covered { sides: vec![sides_of([x, y], &ring)], points: vec![[x, y, 0.0]], ring, ..Covered::default() };
            let fan = (1..6).map(|i| [start, (start + i) % 7, (start + i + 1) % 7]);
            let holders = fan.filter(|&triangle| covered.is_over(0, Over::new(triangle))).count();
            prop_assert_eq!(holders, 1);
        }
    }
}
