//! The bracket on a one-sided Hausdorff distance, by branch and bound.
//!
//! A *piece* is a triangle cut out of a triangle of the source. Its upper bound is the largest distance of its corners
//! from one triangle of the target: the distance from a convex set is a convex function, so nothing in the piece is
//! farther. Its lower bound is the exact distance of any of its points. A piece whose upper bound is within the
//! tolerance of the largest distance found anywhere is settled; any other is cut and its parts are bounded again.
//!
//! The plain cut halves the sides. Where the two surfaces nearly touch this never ends well: a piece that straddles an
//! edge of the target is bounded by its overhang, not by the distance, and halving must go on until the pieces along
//! that edge are as small as the distance. So there is a second cut, along the points that are equally far from the
//! triangle that bounds the piece and from the one that is nearest to its worst corner. It separates what belongs to
//! the one from what belongs to the other: over an edge between coplanar triangles it is that edge, in a valley the
//! bisecting plane. The cut with the lower bound is taken.
//!
//! Rounds instead of a queue: all open pieces are cut at once, in parallel, against the bound known before the round,
//! so the result does not depend on the number of threads.

use rayon::prelude::*;

use super::samples::quarter;
use super::search::{Found, Stack, Tree};
use super::sweep::Farthest;
use crate::geometry::distance::{Segment, Triangle, point_triangle_distance_sq};
use crate::geometry::vector::{Vector, add_scaled, distance_sq, sub};

/// Rounds at most: pieces are then far below the rounding error of their corners.
const MAX_ROUNDS: usize = 128;

/// Parts that a piece is cut into at most.
const MAX_PARTS: usize = 4;

/// Steps at most towards the point in which an edge crosses the points of equal distance.
const MAX_STEPS: usize = 10;

/// Part of the range at which a value counts as zero.
const CLOSE: f64 = 1e-5;

/// Pieces that one thread takes at a time.
const PIECES_PER_CHUNK: usize = 64;

/// A triangle within a triangle of the source, with the triangle of the target that bounds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// The piece.
    pub(super) corners: Triangle,
    /// No point of the piece is farther from the target.
    pub(super) bound: Found,
}

/// A whole surface: pieces that are settled, of which only the largest bound is kept, and pieces that are open.
#[derive(Default)]
pub(super) struct Cover {
    /// Square of the largest bound of a settled piece.
    pub(super) settled_sq: f64,
    /// The open pieces.
    pub(super) open: Vec<Piece>,
}

/// When the search for a proof ends.
#[derive(Clone, Copy, Debug)]
pub(super) enum Goal {
    /// As soon as the upper bound exceeds the lower by this part of it, or is below `floor`.
    Tolerance {
        /// Relative width of the bracket.
        tolerance: f64,
        /// Distances below this are not told apart.
        floor: f64,
    },
    /// As soon as the distance is known to be at most this, or to be more.
    AtMost(f64),
}

/// What is known of a one-sided distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    /// The point with the largest distance found: a lower bound.
    pub(super) farthest: Farthest,
    /// Square of the upper bound.
    pub(super) upper_sq: f64,
    /// Pieces whose bounds were computed.
    pub(super) n_pieces: usize,
}

impl Goal {
    /// Square of the bound at which a piece is settled when the largest distance found so far is given.
    pub(super) fn settled_sq(self, lower_sq: f64) -> f64 {
        match self {
            Self::Tolerance { tolerance, floor } => {
                (lower_sq * (1.0 + tolerance) * (1.0 + tolerance)).max(floor * floor)
            }
            Self::AtMost(limit) => limit * limit,
        }
    }

    /// Whether a distance decides the matter by itself.
    fn is_refuted_by(self, lower_sq: f64) -> bool {
        matches!(self, Self::AtMost(limit) if lower_sq > limit * limit)
    }
}

/// Cuts the open pieces of a surface until the goal is reached or `max_pieces` have been bounded.
pub(super) fn refine(
    mut cover: Cover,
    mut farthest: Farthest,
    target: &Tree,
    goal: Goal,
    max_pieces: usize,
) -> Bracket {
    let mut n_pieces = cover.open.len();
    for _ in 0..MAX_ROUNDS {
        let settled_sq = goal.settled_sq(farthest.distance_sq);
        cover.settle(settled_sq);
        let is_too_much = n_pieces.saturating_add(MAX_PARTS * cover.open.len()) > max_pieces;
        if cover.open.is_empty() || is_too_much || goal.is_refuted_by(farthest.distance_sq) {
            break;
        }
        let chunks: Vec<(Vec<Piece>, Farthest)> = cover
            .open
            .par_chunks(PIECES_PER_CHUNK)
            .map_init(Stack::default, |stack, pieces| {
                let mut cutter = Cutter { target, settled_sq, stack, farthest, parts: Vec::new() };
                pieces.iter().for_each(|piece| cutter.cut(piece));
                (cutter.parts, cutter.farthest)
            })
            .collect();
        cover.open.clear();
        for (parts, found) in chunks {
            n_pieces += parts.len();
            cover.open.extend(parts);
            farthest = farthest.or(found);
        }
    }
    cover.settle(f64::INFINITY);
    Bracket { farthest, upper_sq: cover.settled_sq.max(farthest.distance_sq), n_pieces }
}

impl Cover {
    /// Settles the pieces within a bound.
    fn settle(&mut self, limit_sq: f64) {
        let Self { open, settled_sq } = self;
        open.retain(|piece| {
            let is_open = piece.bound.distance_sq > limit_sq;
            if !is_open {
                *settled_sq = settled_sq.max(piece.bound.distance_sq);
            }
            is_open
        });
    }
}

/// Cuts pieces one after the other.
struct Cutter<'a> {
    target: &'a Tree,
    settled_sq: f64,
    stack: &'a mut Stack,
    farthest: Farthest,
    parts: Vec<Piece>,
}

impl Cutter<'_> {
    /// Adds the parts of a piece that bound it best.
    fn cut(&mut self, piece: &Piece) {
        let first = self.parts.len();
        let between = self.cut_between(piece);
        if between.is_some_and(|upper_sq| upper_sq <= self.settled_sq) {
            return;
        }
        let second = self.parts.len();
        let halved = self.halve(piece);
        if between.is_some_and(|upper_sq| upper_sq < halved) {
            self.parts.truncate(second);
        } else {
            self.parts.drain(first..second);
        }
    }

    /// Cuts along the points that are equally far from the bounding triangle and from the one nearest to the worst
    /// corner; the largest bound of a part, or nothing if they are one triangle.
    fn cut_between(&mut self, piece: &Piece) -> Option<f64> {
        let triangles = self.target.triangles();
        let bounding = &triangles[piece.bound.triangle as usize];
        let corner_distances_sq = piece.corners.map(|corner| point_triangle_distance_sq(corner, bounding));
        let worst = (0..3)
            .fold(0, |worst, i| if corner_distances_sq[i] > corner_distances_sq[worst] { i } else { worst });
        let nearest = self.probe(piece.corners[worst], piece.bound.triangle);
        if nearest == piece.bound.triangle {
            return None;
        }
        let nearest = &triangles[nearest as usize];
        let excess =
            |p: Vector| point_triangle_distance_sq(p, bounding) - point_triangle_distance_sq(p, nearest);
        let parts = cut_at_sign_change(&piece.corners, excess)?;
        Some(parts.into_iter().fold(0.0, |upper_sq: f64, part| upper_sq.max(self.add(part, piece))))
    }

    /// Halves the sides; the largest bound of a part.
    fn halve(&mut self, piece: &Piece) -> f64 {
        let parts = quarter(&piece.corners);
        let [_, _, centre, _] = parts;
        for middle in centre {
            self.probe(middle, piece.bound.triangle);
        }
        parts.into_iter().fold(0.0, |upper_sq: f64, part| upper_sq.max(self.add(part, piece)))
    }

    /// Finds the triangle nearest to a point of the source and notes its distance.
    fn probe(&mut self, point: Vector, hint: u32) -> u32 {
        let found = self.target.search(&[point], hint, self.stack);
        self.farthest = self.farthest.or(Farthest { distance_sq: found.distance_sq, point });
        found.triangle
    }

    /// Bounds a part of a piece and adds it; the bound, squared.
    fn add(&mut self, corners: Triangle, whole: &Piece) -> f64 {
        let bound = self.target.search(&corners, whole.bound.triangle, self.stack);
        self.parts.push(Piece { corners, bound });
        bound.distance_sq
    }
}

/// Cuts a triangle by the line on which a continuous function changes its sign, as far as its edges can tell: a corner
/// triangle and the two halves of the quadrangle that is left. Nothing if all corners have the same sign.
fn cut_at_sign_change(corners: &Triangle, f: impl Fn(Vector) -> f64) -> Option<[Triangle; 3]> {
    let values = corners.map(&f);
    // The corner that is alone on its side.
    let is_above = values.map(|value| value > 0.0);
    let apex =
        (0..3).find(|&i| is_above[i] != is_above[(i + 1) % 3] && is_above[i] != is_above[(i + 2) % 3])?;
    let others = [(apex + 1) % 3, (apex + 2) % 3];
    let [a, b, c] = [corners[apex], corners[others[0]], corners[others[1]]];
    let [ab, ac] =
        others.map(|other| crossing([corners[apex], corners[other]], [values[apex], values[other]], &f));
    let quadrangle = if distance_sq(ab, c) <= distance_sq(b, ac) {
        [[ab, b, c], [ab, c, ac]]
    } else {
        [[ab, b, ac], [ac, b, c]]
    };
    Some([[a, ab, ac], quadrangle[0], quadrangle[1]])
}

/// A point of a segment near which a function changes its sign, by regula falsi with the step of the side that stays
/// halved (the Illinois method). Any point will do; its rounding moves both sides of the cut alike.
fn crossing([a, b]: Segment, values: [f64; 2], f: impl Fn(Vector) -> f64) -> Vector {
    // Squared distances change sign like the signed square roots, which are closer to linear.
    let root = |value: f64| value.signum() * value.abs().sqrt();
    let at = |t: f64| add_scaled(a, t, sub(b, a));
    let (mut low, mut high) = ((0.0, root(values[0])), (1.0, root(values[1])));
    let mut t = 0.5;
    for _ in 0..MAX_STEPS {
        t = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let value = root(f(at(t)));
        if value.abs() <= CLOSE * (low.1 - high.1).abs() {
            break;
        }
        if (value > 0.0) == (low.1 > 0.0) {
            low = (t, value);
            high.1 *= 0.5;
        } else {
            high = (t, value);
            low.1 *= 0.5;
        }
    }
    at(if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 })
}
