//! The bracket on a one-sided Hausdorff distance, by branch and bound.
//!
//! A *piece* is a convex polygon cut out of a triangle of the source. Its upper bound is the
//! largest distance of its corners from one triangle of the target: the distance from a convex set
//! is a convex function, so no point of the piece is farther. Its lower bound is the exact distance
//! of any of its points. A piece is settled if its upper bound is within the tolerance of the
//! largest distance found anywhere. Any other piece is cut, and its parts are bounded again.
//!
//! The plain cut halves a piece. Where the two surfaces nearly touch, this takes very long: a piece
//! that straddles an edge of the target is bounded by its overhang, not by the distance, and
//! halving must go on until the pieces along that edge are as small as the distance. So most cuts
//! run along the points that are equally far from the triangle that bounds the piece and from the
//! triangle nearest to its worst corner. Such a cut separates what belongs to one triangle from
//! what belongs to the other: along an edge between coplanar triangles it is that edge, in a valley
//! it is the bisecting plane.
//!
//! Rounds replace a queue: all open pieces are cut at once, in parallel, against the bound known
//! before the round, so the result does not depend on the number of threads.

use rayon::prelude::*;

use super::batch::Quarter;
use super::found::{Farthest, Found};
use super::polygon::Polygon;
use super::search::{Stack, TriangleTree};
use crate::geometry::distance::Triangle;
use crate::geometry::vector::Vector;

/// Most rounds; by then pieces are far smaller than the rounding error of their corners.
const MAX_ROUNDS: usize = 128;

/// After this many cuts a piece is halved, and the best triangles for its halves are searched for
/// in the whole tree. Where distances change more along a piece than from triangle to triangle,
/// only small pieces have good bounds.
const CUTS_PER_BISECTION: u32 = 6;

/// Most cuts that a quarter of a tile gets at once; most need one or two.
const EARLY_CUTS: usize = 4;

/// Squared distances from two triangles count as equal if they differ by less than this part of the
/// settled bound, squared: a cut need not be better than what it must prove.
const CLOSE: f64 = 0.2;

/// Pieces that one thread takes at a time.
const PIECES_PER_CHUNK: usize = 64;

/// A piece of the source, with the triangle of the target that bounds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    polygon: Polygon,
    /// No point of the piece is farther from the target.
    bound: Found,
    /// Cuts that made it.
    n_cuts: u32,
}

/// A whole surface: pieces that are settled, of which only the largest bound is kept, and pieces
/// that are open.
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
    /// Ends if the upper bound exceeds the lower one by at most this part of it, or is below
    /// `floor`.
    Tolerance {
        /// Relative width of the bracket.
        tolerance: f64,
        /// Distances below this are not distinguished.
        floor: f64,
    },
    /// Ends once the distance is known to be at most this, or more.
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
    /// Squared bound at which a piece is settled, given the largest squared distance found so far.
    pub(super) fn settled_sq(self, lower_sq: f64) -> f64 {
        match self {
            Self::Tolerance { tolerance, floor } => {
                (lower_sq * (1.0 + tolerance) * (1.0 + tolerance)).max(floor * floor)
            }
            Self::AtMost(limit) => limit * limit,
        }
    }

    /// Whether one distance decides the question.
    fn is_refuted_by(self, lower_sq: f64) -> bool {
        matches!(self, Self::AtMost(limit) if lower_sq > limit * limit)
    }
}

/// Cuts the open pieces of a surface until the goal is reached or `max_pieces` have been bounded.
pub(super) fn refine(
    Parts { mut cover, mut n_pieces, mut farthest }: Parts,
    target: &TriangleTree,
    goal: Goal,
    max_pieces: usize,
) -> Bracket {
    for _ in 0..MAX_ROUNDS {
        let settled_sq = goal.settled_sq(farthest.distance_sq);
        cover.settle(settled_sq);
        let is_too_much = n_pieces.saturating_add(2 * cover.open.len()) > max_pieces;
        if cover.open.is_empty() || is_too_much || goal.is_refuted_by(farthest.distance_sq) {
            break;
        }
        let chunks: Vec<Parts> = cover
            .open
            .par_chunks(PIECES_PER_CHUNK)
            .map(|pieces| {
                let mut cutter = Cutter::new(target, settled_sq);
                pieces.iter().for_each(|piece| cutter.cut(piece));
                cutter.into_parts()
            })
            .collect();
        cover.open.clear();
        for parts in chunks {
            n_pieces += parts.n_pieces;
            cover.merge(parts.cover);
            farthest = farthest.or(parts.farthest);
        }
    }
    cover.settle(f64::INFINITY);
    Bracket { farthest, upper_sq: cover.settled_sq.max(farthest.distance_sq), n_pieces }
}

impl Cover {
    /// Adds a piece, which is settled if its bound is within `limit_sq`.
    pub(super) fn add(&mut self, piece: Piece, limit_sq: f64) {
        if piece.bound.distance_sq > limit_sq {
            self.open.push(piece);
        } else {
            self.settled_sq = self.settled_sq.max(piece.bound.distance_sq);
        }
    }

    /// Adds another cover.
    pub(super) fn merge(&mut self, other: Self) {
        self.settled_sq = self.settled_sq.max(other.settled_sq);
        self.open.extend(other.open);
    }

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

/// The parts of pieces that were cut.
#[derive(Default)]
pub(super) struct Parts {
    /// The pieces.
    pub(super) cover: Cover,
    /// How many were bounded.
    pub(super) n_pieces: usize,
    /// The farthest of the points that were probed.
    pub(super) farthest: Farthest,
}

impl Parts {
    /// Whole triangles of the source, which may be segments and points, each with the triangle of
    /// the target that bounds it best.
    pub(super) fn whole(triangles: &[Triangle], target: &TriangleTree) -> Self {
        let look = |stack: &mut Stack, triangle: &Triangle| {
            let bound = target.search(triangle, 0, stack);
            let farthest = triangle.iter().fold(Farthest::default(), |farthest, &point| {
                let distance_sq = target.search(&[point], bound.triangle, stack).distance_sq;
                farthest.or(Farthest { distance_sq, point })
            });
            (Piece { polygon: Polygon::from(*triangle), bound, n_cuts: 0 }, farthest)
        };
        let looked_at: Vec<(Piece, Farthest)> = triangles.par_iter().map_init(Stack::default, look).collect();
        let farthest = looked_at.iter().fold(Farthest::default(), |farthest, piece| farthest.or(piece.1));
        let open = looked_at.into_iter().map(|(piece, _)| piece).collect();
        Self { cover: Cover { settled_sq: 0.0, open }, n_pieces: triangles.len(), farthest }
    }

    /// Adds other parts.
    pub(super) fn merge(&mut self, other: Self) {
        self.cover.merge(other.cover);
        self.n_pieces += other.n_pieces;
        self.farthest = self.farthest.or(other.farthest);
    }
}

/// Cuts pieces one after the other.
pub(super) struct Cutter<'a> {
    target: &'a TriangleTree,
    settled_sq: f64,
    stack: Stack,
    parts: Parts,
}

impl<'a> Cutter<'a> {
    /// Cuts what is not within a bound.
    pub(super) fn new(target: &'a TriangleTree, settled_sq: f64) -> Self {
        Self { target, settled_sq, stack: Stack::default(), parts: Parts::default() }
    }

    /// All that was cut.
    pub(super) fn into_parts(self) -> Parts {
        self.parts
    }

    /// Adds a quarter of a tile, or its parts after a few cuts, so that they need not wait for
    /// another round.
    pub(super) fn settle_or_cut(&mut self, quarter: &Quarter) {
        let piece = Piece { polygon: Polygon::from(quarter.corners), bound: quarter.bound, n_cuts: 0 };
        if quarter.bound.distance_sq <= self.settled_sq {
            self.add(piece);
            return;
        }
        let bottom = self.parts.cover.open.len();
        if !self.cut_towards(&piece, quarter.nearest[self.worst_corner(&piece)].triangle) {
            self.bisect(&piece);
        }
        for _ in 1..EARLY_CUTS {
            if self.parts.cover.open.len() == bottom {
                return;
            }
            let piece = self.parts.cover.open.swap_remove(bottom);
            self.cut(&piece);
        }
    }

    /// Adds the parts of a piece.
    fn cut(&mut self, piece: &Piece) {
        if (piece.n_cuts + 1).is_multiple_of(CUTS_PER_BISECTION) || !self.cut_between(piece) {
            self.bisect(piece);
        }
    }

    /// Cuts along the points that are equally far from the bounding triangle and from the one
    /// nearest to the worst corner. False if there are no such points.
    fn cut_between(&mut self, piece: &Piece) -> bool {
        let bounding = piece.bound.triangle;
        let corners = piece.polygon.corners();
        let worst = self.worst_corner(piece);
        let nearest = self.probe(corners[worst], bounding);
        self.cut_towards(piece, nearest)
    }

    /// Cuts along the points that are equally far from the bounding triangle and from another one.
    /// False if there are no such points.
    fn cut_towards(&mut self, piece: &Piece, nearest: u32) -> bool {
        let (target, bounding) = (self.target, piece.bound.triangle);
        if nearest == bounding {
            return false;
        }
        let excess = |p: Vector| target.distance_sq(p, bounding) - target.distance_sq(p, nearest);
        let Some([beyond, within]) = piece.polygon.cut_at_sign_change(CLOSE * self.settled_sq, excess) else {
            return false;
        };
        for (polygon, owner) in [(beyond, nearest), (within, bounding)] {
            let bound = target.bound(polygon.corners(), owner);
            self.add(Piece { polygon, bound, n_cuts: piece.n_cuts + 1 });
        }
        true
    }

    /// Halves a piece and searches for the triangles that bound the halves best.
    fn bisect(&mut self, piece: &Piece) {
        let halves = piece.polygon.bisect();
        for polygon in halves.iter().flatten().chain(halves.is_none().then_some(&piece.polygon)) {
            let bound = self.target.search(polygon.corners(), piece.bound.triangle, &mut self.stack);
            self.probe(polygon.corners()[0], bound.triangle);
            self.add(Piece { polygon: *polygon, bound, n_cuts: piece.n_cuts + 1 });
        }
    }

    /// Place of the corner that is farthest from the bounding triangle.
    fn worst_corner(&self, piece: &Piece) -> usize {
        let distance_sq = |&corner: &Vector| self.target.distance_sq(corner, piece.bound.triangle);
        let distances_sq = piece.polygon.corners().iter().map(distance_sq).enumerate();
        distances_sq.fold((0, -1.0), |worst, next| if next.1 > worst.1 { next } else { worst }).0
    }

    /// Finds the triangle nearest to a point of the source and notes its distance.
    fn probe(&mut self, point: Vector, hint: u32) -> u32 {
        let found = self.target.search(&[point], hint, &mut self.stack);
        let probed = Farthest { distance_sq: found.distance_sq, point };
        self.parts.farthest = self.parts.farthest.or(probed);
        found.triangle
    }

    fn add(&mut self, part: Piece) {
        self.parts.n_pieces += 1;
        self.parts.cover.add(part, self.settled_sq);
    }
}
