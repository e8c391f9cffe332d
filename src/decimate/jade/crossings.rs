//! Source edges at the removed vertex, and how far the inner edges of a filling would be from where
//! they cross them.
//!
//! A removal that the proof refuses fails at such a crossing four times out of five. Their
//! distances cost little and do not depend on the triangles beside the edge: what no choice of
//! inner edges can avoid ends a candidate before anything else of it is looked at.

use crate::bound::certified::Certified;
use crate::geometry::prepared::larger;
use crate::geometry::vector::{Vector, cross, dot, length_sq, sub};
use crate::mesh::{Hole, Surface};

/// Of two lines more nearly parallel than this, as the squared sine, the distance is not worth
/// asking for.
const PARALLEL: f64 = 1e-12;

/// Source edges at the vertex of a hole, as far as they get a chain if they cross an edge inside
/// it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Crossings {
    /// Where the removed vertex is in the input.
    origin: Vector,
    /// Normal of the hole's average plane.
    up: Vector,
    /// Per ring vertex, the source edge that ends there; of length 0 if there is none.
    to_corners: Vec<SourceEdge>,
    /// The others, to covered vertices.
    to_covered: Vec<SourceEdge>,
}

/// A source edge, seen from the removed vertex.
#[derive(Clone, Copy, Debug, Default)]
struct SourceEdge {
    along: Vector,
    length_sq: f64,
}

impl Crossings {
    /// Makes these the edges at the vertex of `hole`, whose average plane has the normal `up`,
    /// given the source vertices mapped into its star. O(valence).
    pub(crate) fn gather(
        &mut self,
        surface: &Surface,
        hole: &Hole,
        up: Vector,
        certified: &Certified,
        covered: &[u32],
    ) {
        self.up = up;
        self.origin = surface.origin(hole.removed);
        self.to_covered.clear();
        self.to_corners.clear();
        self.to_corners.resize(hole.n_ring(), SourceEdge::default());
        certified.for_each_unchained(hole, covered, |other, corner| {
            let along = sub(surface.origin(other), self.origin);
            let edge = SourceEdge { along, length_sq: length_sq(along) };
            match corner {
                Some(corner) => self.to_corners[corner] = edge,
                None => self.to_covered.push(edge),
            }
        });
    }

    /// Largest squared distance of the source edges that would cross the edge between two ring
    /// vertices from the line of that edge. It is the distance of two lines: that of the edges
    /// where they cross over each other, and no more elsewhere.
    pub(crate) fn largest_sq(&self, hole: &Hole, [i, j]: [u8; 2]) -> f64 {
        let (i, j) = (usize::from(i.min(j)), usize::from(i.max(j)));
        let (start, along) = (hole.points[i], sub(hole.points[j], hole.points[i]));
        let across = cross(self.up, along);
        // The vertex of a half disk goes to the new boundary edge, with all inner edges on one side
        // of it.
        let apex_is_left = !hole.closed || dot(across, sub(hole.apex, start)) >= 0.0;
        let from_origin = sub(start, self.origin);
        let level = dot(across, from_origin);
        // With the two directions d and a and the way w from line to line: d x a . w = d . a x w,
        // |d x a|^2 = |d|^2 |a|^2 - (d . a)^2.
        let moment = cross(along, from_origin);
        let along_sq = length_sq(along);
        let mut worst = Ratio { over: 0.0, under: 1.0 };
        let mut cross_with = |edge: &SourceEdge| {
            if edge.length_sq <= 0.0 {
                return;
            }
            let height = dot(edge.along, moment);
            let lean = dot(edge.along, along);
            let full_sq = edge.length_sq * along_sq;
            let under = larger(full_sq - lean * lean, PARALLEL * full_sq);
            worst = worst.max(Ratio { over: height * height, under });
        };
        if apex_is_left {
            self.to_corners[i + 1..j].iter().for_each(&mut cross_with);
        } else {
            self.to_corners[j + 1..].iter().chain(&self.to_corners[..i]).for_each(&mut cross_with);
        }
        let is_left = |edge: &&SourceEdge| dot(across, edge.along) >= level;
        self.to_covered.iter().filter(|edge| is_left(edge) != apex_is_left).for_each(cross_with);
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
    /// The larger one; this one if the other is NaN.
    fn max(self, other: Self) -> Self {
        if other.over * self.under > self.over * other.under { other } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::distance::segment_segment_distance_sq;

    /// A fan of six triangles around vertex 3, which is neither the lowest nor the highest, nor in
    /// the middle.
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

    /// In the input every spoke is a source edge without a chain: an inner edge is crossed by those
    /// to the other side of it.
    #[test]
    fn an_inner_edge_is_as_far_as_the_spokes_that_cross_it() {
        let (surface, hole) = fan();
        let certified = Certified::new(&surface, 0.0);
        let mut crossings = Crossings::default();
        crossings.gather(&surface, &hole, hole.average_normal(), &certified, &[]);
        assert!(crossings.to_covered.is_empty());
        assert!(crossings.to_corners.iter().all(|edge| edge.length_sq > 0.0));
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
        // Parallel lines do not count.
        assert_eq!(ratio(0.0, 1.0).max(ratio(0.0, 0.0)).under, 1.0);
    }
}
