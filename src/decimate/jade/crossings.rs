//! Source edges at the removed vertex, and how far the inner edges of a filling would be from where they cross them.
//!
//! A removal that the proof refuses fails at such a crossing four times out of five. Their distances cost little and do not depend on
//! the triangles beside the edge: what no choice of inner edges can avoid ends a candidate before anything else of it is looked at.

use crate::bound::certified::Certified;
use crate::geometry::vector::{Vector, cross, dot, length_sq, sub};
use crate::mesh::{Hole, Surface};

/// Source edges at the vertex of a hole, as far as they get a chain if they cross an edge inside it.
#[derive(Clone, Debug, Default)]
pub struct Crossings {
    /// Where the removed vertex is in the input.
    origin: Vector,
    /// Normal of the hole's average plane.
    up: Vector,
    /// Per ring vertex, where a source edge ends there.
    corners: Vec<Option<Vector>>,
    /// Where the others end, at covered vertices.
    covered: Vec<Vector>,
}

impl Crossings {
    /// Makes these the edges at the vertex of `hole`, whose average plane has the normal `up`. O(valence).
    pub fn gather(&mut self, surface: &Surface, hole: &Hole, up: Vector, certified: &Certified) {
        self.up = up;
        self.origin = surface.origin(hole.removed);
        self.covered.clear();
        self.corners.clear();
        self.corners.resize(hole.n_ring(), None);
        certified.for_each_unchained(hole, |other, corner| {
            let end = surface.origin(other);
            match corner {
                Some(corner) => self.corners[corner] = Some(end),
                None => self.covered.push(end),
            }
        });
    }

    /// Largest squared distance of the source edges that would cross the edge between two ring vertices from the line of that edge. It is
    /// the distance of two lines: that of the edges where they cross over each other, and no more elsewhere.
    pub fn largest_sq(&self, hole: &Hole, [i, j]: [u8; 2]) -> f64 {
        let (i, j) = (usize::from(i.min(j)), usize::from(i.max(j)));
        let (start, along) = (hole.points[i], sub(hole.points[j], hole.points[i]));
        let across = cross(self.up, along);
        let is_left = |p: Vector| dot(across, sub(p, start)) >= 0.0;
        // The vertex of a half disk goes to the new boundary edge, with all inner edges on one side of it.
        let apex_is_left = !hole.closed || is_left(hole.apex);
        let from_origin = sub(start, self.origin);
        let mut worst = Ratio { over: 0.0, under: 1.0 };
        let mut cross_to = |end: Vector| {
            let normal = cross(sub(end, self.origin), along);
            let height = dot(normal, from_origin);
            worst = worst.max(Ratio { over: height * height, under: length_sq(normal) });
        };
        if apex_is_left {
            self.corners[i + 1..j].iter().flatten().for_each(|&end| cross_to(end));
        } else {
            self.corners[j + 1..].iter().chain(&self.corners[..i]).flatten().for_each(|&end| cross_to(end));
        }
        self.covered.iter().filter(|&&end| is_left(end) != apex_is_left).for_each(|&end| cross_to(end));
        worst.over / worst.under
    }
}

/// A fraction whose division is put off until it is known to be the largest.
#[derive(Clone, Copy, Debug)]
struct Ratio {
    over: f64,
    under: f64,
}

impl Ratio {
    /// The larger one; this one where the other is no number.
    fn max(self, other: Self) -> Self {
        if other.over * self.under > self.over * other.under { other } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::distance::segment_segment_distance_sq;

    /// A fan of six triangles around vertex 3, which is neither the lowest nor the highest, nor in the middle.
    fn fan() -> (Surface, Hole) {
        let ring = [0, 1, 2, 4, 5, 6];
        let mut positions = vec![[0.1, 0.2, 0.5]; 7];
        for (at, v) in ring.into_iter().enumerate() {
            let angle = std::f32::consts::TAU * at as f32 / 6.0;
            positions[v as usize] = [angle.cos(), angle.sin(), 0.1 * (at % 2) as f32];
        }
        let triangles = (0..6).map(|at| [3, ring[at], ring[(at + 1) % 6]]).collect();
        let surface = Surface::new(positions, triangles);
        let mut hole = Hole::default();
        hole.gather(&surface, 3).unwrap();
        (surface, hole)
    }

    /// In the input every spoke is a source edge without a chain: an inner edge is crossed by those to the other side of it.
    #[test]
    fn an_inner_edge_is_as_far_as_the_spokes_that_cross_it() {
        let (surface, hole) = fan();
        let certified = Certified::new(&surface, 0.0);
        let mut crossings = Crossings::default();
        crossings.gather(&surface, &hole, hole.average_normal(), &certified);
        assert!(crossings.covered.is_empty() && crossings.corners.iter().all(Option::is_some));
        let spoke_sq = |corner: usize, [i, j]: [usize; 2]| {
            segment_segment_distance_sq([hole.apex, hole.points[corner]], [hole.points[i], hole.points[j]])
        };
        // The apex lies to the upper right of the middle, the corners at multiples of 60 degrees.
        for (edge, crossed_by) in
            [([0, 2], vec![1]), ([1, 5], vec![0]), ([2, 5], vec![3, 4]), ([0, 3], vec![4, 5])]
        {
            let expected = crossed_by.into_iter().map(|corner| spoke_sq(corner, edge)).fold(0.0, f64::max);
            let [i, j] = edge.map(|corner| u8::try_from(corner).unwrap());
            for edge in [[i, j], [j, i]] {
                let found = crossings.largest_sq(&hole, edge);
                assert!((found - expected).abs() < 1e-12, "{edge:?}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn the_larger_of_two_fractions_is_found_without_division() {
        let ratio = |over, under| Ratio { over, under };
        assert_eq!(ratio(1.0, 3.0).max(ratio(1.0, 2.0)).under, 2.0);
        assert_eq!(ratio(3.0, 4.0).max(ratio(1.0, 2.0)).under, 4.0);
        // Parallel lines tell nothing.
        assert_eq!(ratio(0.0, 1.0).max(ratio(0.0, 0.0)).under, 1.0);
    }
}
