//! The input vertices that score fillings of a hole, and over which part of the hole each lies.

use crate::geometry::projection::{Point2, ProjectionPlane, turn};
use crate::geometry::vector::{Vector, length_sq, scale};
use crate::mesh::{Hole, Surface};
use multiversion::multiversion;

/// Most ring vertices of a hole that is filled as well as can be.
pub(crate) const MAX_CORNERS: usize = 11;

/// Most vertices that are sampled; of more of them so many, evenly spread.
const MAX_SAMPLED: usize = Set::BITS as usize;

/// Points that are compared with a line at once.
const LANES: usize = 8;

/// A bit for each of the vertices.
type Set = u64;

/// Source vertices over a hole, or some of them.
///
/// In the hole's average plane, each ring pair `i < j` is a line that parts the vertices into those
/// on one side of it and those on the other. The vertices over a triangle are what three such sets
/// have in common, and a vertex on a line lies over exactly one of the two triangles there.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampledVertices {
    points: Vec<Vector>,
    /// The points in the average plane, in units about as long as the hole, filled up with zeros
    /// to whole [`LANES`].
    flat: [Vec<f32>; 2],
    ring: Vec<Point2>,
    /// Per ring pair, those on its left when it is run upwards.
    left: Vec<Set>,
    /// Those that were too far from a triangle: they are likely to be too far from others.
    far: Set,
}

impl SampledVertices {
    /// Asks the `covered` source vertices about fillings of `hole`, whose average plane has the
    /// normal `up` that is not zero. At most [`MAX_CORNERS`] corners. O(ring pairs) for each that
    /// is sampled.
    pub(crate) fn gather(&mut self, surface: &Surface, hole: &Hole, up: Vector, covered: &[u32]) {
        let size = length_sq(up).sqrt();
        let (plane, unit) = (ProjectionPlane::new(scale(up, 1.0 / size)), 1.0 / size.sqrt());
        let flatten = |p: Vector| plane.project(p, hole.apex).map(|x| unit * x);
        self.ring.clear();
        self.ring.extend(hole.points.iter().map(|&p| flatten(p)));
        self.points.clear();
        self.points.extend(chosen(covered).map(|v| surface.origin(v)));
        self.find_sides(flatten);
        self.far = 0;
    }

    /// Twice the area of a triangle of ring indices in the average plane, negative when it faces
    /// away.
    pub(crate) fn flat_area(&self, triangle: [u8; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| self.ring[usize::from(i)]);
        turn(a, b, c)
    }

    /// The vertices over a triangle of ring indices, in ring order.
    #[inline]
    pub(crate) fn over(&self, [a, b, c]: [u8; 3]) -> Set {
        [[a, b], [b, c], [c, a]].into_iter().fold(self.all(), |over, [i, j]| {
            over & if i < j { self.left[pair(i, j)] } else { !self.left[pair(j, i)] }
        })
    }

    /// Largest of `value` among some points, or the first one found above `cutoff`.
    #[inline]
    pub(crate) fn largest(&mut self, among: Set, cutoff: f64, value: impl Fn(Vector) -> f64) -> f64 {
        let mut largest = 0.0_f64;
        for mut rest in [among & self.far, among & !self.far] {
            while rest != 0 {
                let at = rest.trailing_zeros();
                rest &= rest - 1;
                largest = largest.max(value(self.points[at as usize]));
                if largest > cutoff {
                    self.far |= 1 << at;
                    return largest;
                }
            }
        }
        largest
    }

    fn all(&self) -> Set {
        match self.points.len() {
            0 => 0,
            n => Set::MAX >> (MAX_SAMPLED - n),
        }
    }

    /// Parts the points by each line.
    #[expect(clippy::cast_possible_truncation, reason = "near enough to choose a filling by")]
    fn find_sides(&mut self, flatten: impl Fn(Vector) -> Point2) {
        let n = self.points.len().next_multiple_of(LANES);
        for coordinates in &mut self.flat {
            coordinates.clear();
            coordinates.resize(n, 0.0);
        }
        let [xs, ys] = &mut self.flat;
        for ((x, y), &p) in xs.iter_mut().zip(&mut *ys).zip(&self.points) {
            [*x, *y] = flatten(p).map(|x| x as f32);
        }
        self.left.clear();
        part(&self.flat, &self.ring, &mut self.left);
    }
}

/// Parts points by each line of the ring, as many at once as the processor can compare.
#[multiversion(targets("x86_64+avx2"))]
#[expect(clippy::cast_possible_truncation, reason = "near enough to choose a filling by")]
fn part(flat: &[Vec<f32>; 2], ring: &[Point2], left: &mut Vec<Set>) {
    for (j, &b) in ring.iter().enumerate() {
        for &a in &ring[..j] {
            let across = [a[1] - b[1], b[0] - a[0]];
            let level = across[0] * a[0] + across[1] * a[1];
            left.push(set_above(flat, across.map(|x| x as f32), level as f32));
        }
    }
}

/// At most [`MAX_SAMPLED`] of the vertices, evenly spread.
fn chosen(covered: &[u32]) -> impl Iterator<Item = u32> {
    let n = covered.len().min(MAX_SAMPLED);
    (0..n).map(move |at| covered[at * covered.len() / n])
}

/// Where a ring pair's set is, its lower index first.
#[inline]
fn pair(low: u8, high: u8) -> usize {
    usize::from(high) * usize::from(high - 1) / 2 + usize::from(low)
}

/// Those of the points with `across . point >= level`.
#[inline(always)]
fn set_above([xs, ys]: &[Vec<f32>; 2], across: [f32; 2], level: f32) -> Set {
    let (xs, ys) = (xs.as_chunks::<LANES>().0, ys.as_chunks::<LANES>().0);
    let mut set = 0;
    for (at, (xs, ys)) in xs.iter().zip(ys).enumerate() {
        let mut above = 0;
        for lane in 0..LANES {
            above |= u8::from(across[0] * xs[lane] + across[1] * ys[lane] >= level) << lane;
        }
        set |= Set::from(above) << (LANES * at);
    }
    set
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
            let mut sampled = SampledVertices { points: vec![[x, y, 0.0]; 9], ring, ..SampledVertices::default() };
            sampled.find_sides(|[x, y, _]| [x, y]);
            let mut fan = (1..6).map(|i| [start, (start + i) % 7, (start + i + 1) % 7]);
            let n_holders = fan.clone().filter(|&triangle| sampled.over(triangle) != 0).count();
            prop_assert_eq!(n_holders, 1);
            prop_assert!(fan.all(|triangle| [0, 0x1ff].contains(&sampled.over(triangle))));
        }

        #[test]
        fn no_more_are_sampled_than_there_are_bits(n in 0_u32..500) {
            let covered: Vec<u32> = (0..n).collect();
            let chosen: Vec<u32> = chosen(&covered).collect();
            prop_assert_eq!(chosen.len(), covered.len().min(MAX_SAMPLED));
            prop_assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }

    #[test]
    fn the_first_one_too_far_comes_first_for_the_next() {
        let points = [1.0, 9.0, 5.0].map(|x| [x, 0.0, 0.0]).to_vec();
        let mut sampled = SampledVertices { points, ..SampledVertices::default() };
        assert_eq!(sampled.largest(0b111, 10.0, |[x, ..]| x), 9.0);
        assert_eq!(sampled.largest(0b101, 4.0, |[x, ..]| x), 5.0);
        assert_eq!(sampled.largest(0b111, 0.5, |[x, ..]| x), 5.0);
        assert_eq!(sampled.largest(0, 0.5, |[x, ..]| x), 0.0);
    }
}
