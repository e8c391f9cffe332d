//! What has vanished without anything in its place, and how far it is from what is left.
//!
//! A part of the mesh that is down to its last triangle vanishes with it. What it stood for is then
//! as far from the mesh as from the nearest triangle of another part, its *host*. When the host
//! changes, the pieces at it go to the nearest triangle of those that take its place; when the host
//! vanishes, to the nearest one of all. So the distances do not add up on the way.

use super::ring::Ring;
use crate::flat::NO_INDEX;
use crate::geometry::distance::{Triangle, point_triangle_distance_sq};
use crate::geometry::vector::{max, midpoint, min};
use crate::measure::TriangleIndex;
use crate::mesh::Surface;
use std::collections::HashMap;

/// Pieces at one host; beyond that they are taken for one ball.
const MAX_PIECES: usize = 8;

/// Triangles at a corner that are looked at for a host.
const MAX_BESIDE: usize = 64;

/// A triangle that has vanished.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// Its corners; all at one place if the piece is a ball.
    pub corners: Triangle,
    /// Bound on the distance of the input's points that it stood for from it.
    pub bound: f64,
}

/// Where pieces are to go.
#[derive(Clone, Debug, Default)]
pub(crate) struct PieceMoves {
    /// Hosts and their pieces.
    pieces: Vec<(u32, Piece)>,
    /// Bound on the distance of the input's points that the pieces stand for from their hosts; 0
    /// without pieces.
    pub bound: f64,
}

/// All pieces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Vanished {
    hosted: HashMap<u32, Vec<Piece>>,
    index: Option<Index>,
}

/// Where triangles were some time ago, and what has become of them.
#[derive(Clone, Debug)]
struct Index {
    triangles: TriangleIndex,
    /// For each slot one that has come in its place, or itself; [`NO_INDEX`] if nothing has.
    merged_into: Vec<u32>,
}

impl Piece {
    /// Bound on the distance of the points that it stands for from a triangle.
    fn distance(&self, host: &Triangle) -> f64 {
        farthest_sq(&self.corners, host).sqrt() + self.bound
    }

    /// A ball around all of `pieces`.
    fn around(pieces: &[Self]) -> Self {
        let corners = || pieces.iter().flat_map(|piece| piece.corners);
        let (low, high) = corners()
            .fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), p| (min(low, p), max(high, p)));
        let center = midpoint(low, high);
        let radius = |piece: &Self| farthest_sq(&piece.corners, &[center; 3]).sqrt() + piece.bound;
        Self { corners: [center; 3], bound: pieces.iter().map(radius).fold(0.0, f64::max) }
    }
}

/// Largest squared distance of the corners from a triangle: no point between them is farther.
fn farthest_sq(corners: &Triangle, host: &Triangle) -> f64 {
    corners.iter().map(|&corner| point_triangle_distance_sq(corner, host)).fold(0.0, f64::max)
}

impl PieceMoves {
    fn add(&mut self, host: u32, piece: Piece, distance: f64) {
        self.pieces.push((host, piece));
        self.bound = self.bound.max(distance);
    }
}

impl Vanished {
    /// Where pieces at the triangles of a star go when its centre goes into neighbour `into`: to
    /// the nearest triangle of the fan. O(pieces times valence).
    pub(crate) fn moves_to_fan(&self, surface: &Surface, ring: &Ring, into: usize) -> PieceMoves {
        let mut moves = PieceMoves::default();
        for &piece in self.at(ring) {
            let target = ring.vertices[into];
            let fan = ring.slots.iter().filter(|&&slot| !surface.corners(slot).contains(&target));
            let after = |slot: u32| {
                surface.corners(slot).map(|v| surface.point(if v == ring.center { target } else { v }))
            };
            let distances = fan.map(|&slot| (slot, piece.distance(&after(slot))));
            if let Some((host, distance)) = distances.min_by(|a, b| a.1.total_cmp(&b.1)) {
                moves.add(host, piece, distance);
            }
        }
        moves
    }

    /// Where pieces at the triangles of a star go that vanishes beside `host`.
    pub(crate) fn moves_beside(&self, surface: &Surface, ring: &Ring, host: u32) -> PieceMoves {
        let triangle = surface.corners(host).map(|v| surface.point(v));
        let mut moves = PieceMoves::default();
        self.at(ring).for_each(|&piece| moves.add(host, piece, piece.distance(&triangle)));
        moves
    }

    /// Where pieces at the triangles of a star go that vanishes with nothing beside it, and `own`,
    /// which is the star itself: to the nearest triangle of all. Infinitely far if there is none.
    pub(crate) fn moves_away(&mut self, surface: &Surface, ring: &Ring, own: Piece) -> PieceMoves {
        let pieces: Vec<Piece> = self.at(ring).copied().chain([own]).collect();
        let mut moves = PieceMoves::default();
        for piece in pieces {
            match self.nearest(surface, ring, &piece) {
                Some(host) => {
                    let triangle = surface.corners(host).map(|v| surface.point(v));
                    moves.add(host, piece, piece.distance(&triangle));
                }
                None => return PieceMoves { pieces: vec![], bound: f64::INFINITY },
            }
        }
        moves
    }

    /// Moves pieces as planned, away from the star.
    pub(crate) fn carry_out(&mut self, ring: &Ring, moves: PieceMoves) {
        for slot in &ring.slots {
            self.hosted.remove(slot);
        }
        for (host, piece) in moves.pieces {
            let pieces = self.hosted.entry(host).or_default();
            pieces.push(piece);
            if pieces.len() > MAX_PIECES {
                *pieces = vec![Piece::around(pieces)];
            }
        }
    }

    /// After the collapse of the ring's centre: the triangles that have gone are to be looked for
    /// at one that took their place, or else at `host`.
    pub(crate) fn follow(&mut self, surface: &Surface, ring: &Ring, host: Option<u32>) {
        let Some(Index { merged_into, .. }) = &mut self.index else { return };
        let successor =
            ring.slots.iter().copied().find(|&slot| surface.is_alive(slot)).or(host).unwrap_or(NO_INDEX);
        let gone = ring.slots.iter().filter(|&&slot| !surface.is_alive(slot));
        gone.for_each(|&slot| merged_into[slot as usize] = successor);
    }

    fn at<'a>(&'a self, ring: &'a Ring) -> impl Iterator<Item = &'a Piece> {
        let slots = if self.hosted.is_empty() { &[][..] } else { &ring.slots[..] };
        slots.iter().filter_map(|slot| self.hosted.get(slot)).flatten()
    }

    /// A triangle near a piece, if there is one outside of the star: the nearest one, as far as the
    /// index is up to date. The index is made anew whenever half of its triangles have gone.
    fn nearest(&mut self, surface: &Surface, ring: &Ring, piece: &Piece) -> Option<u32> {
        if surface.n_triangles() <= ring.len() {
            return None;
        }
        let is_stale = |index: &Index| index.triangles.len() >= 2 * surface.n_triangles();
        if self.index.as_ref().is_none_or(is_stale) {
            self.index = Some(Index::new(surface));
        }
        let found = self.index.as_mut().and_then(|index| index.nearest(surface, ring, piece));
        found.or_else(|| {
            self.index = Some(Index::new(surface));
            self.index.as_mut()?.nearest(surface, ring, piece)
        })
    }
}

impl Index {
    fn new(surface: &Surface) -> Self {
        let (slots, triangles): (Vec<u32>, Vec<Triangle>) =
            surface.iter().map(|(slot, corners)| (slot, corners.map(|v| surface.point(v)))).unzip();
        let n_slots = u32::try_from(surface.n_slots()).unwrap_or(u32::MAX);
        Self { triangles: TriangleIndex::new(&slots, &triangles), merged_into: (0..n_slots).collect() }
    }

    fn nearest(&mut self, surface: &Surface, ring: &Ring, piece: &Piece) -> Option<u32> {
        let Self { triangles, merged_into } = self;
        let found = triangles.nearest(&piece.corners, |slot| {
            let slot = follow_merges(merged_into, slot);
            if slot == NO_INDEX || ring.slots.contains(&slot) {
                return f64::INFINITY;
            }
            farthest_sq(&piece.corners, &surface.corners(slot).map(|v| surface.point(v)))
        });
        found.map(|(slot, _)| follow_merges(merged_into, slot))
    }
}

/// What has come in the place of the triangle in `slot`; the way there is made shorter.
fn follow_merges(merged_into: &mut [u32], slot: u32) -> u32 {
    let mut at = slot;
    while at != NO_INDEX {
        let next = merged_into[at as usize];
        if next == at {
            break;
        }
        if next != NO_INDEX {
            merged_into[at as usize] = merged_into[next as usize];
        }
        at = next;
    }
    at
}

/// For a star that vanishes with the collapse of its centre: a triangle that has a corner in common
/// with it and stays, and a bound on the distance of the star from it. `None` if there is none.
pub(crate) fn beside(surface: &Surface, ring: &Ring) -> Option<(u32, f64)> {
    let corners = of_star(surface, ring);
    let around = ring.vertices.iter().flat_map(|&r| surface.star(r).iter().take(MAX_BESIDE));
    let stays = around.filter(|slot| !ring.slots.contains(slot));
    let distances =
        stays.map(|&slot| (slot, farthest_sq(&corners, &surface.corners(slot).map(|v| surface.point(v)))));
    let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    nearest.map(|(slot, distance_sq)| (slot, distance_sq.sqrt()))
}

/// The corners of a star that vanishes: all its triangles have them.
pub(crate) fn of_star(surface: &Surface, ring: &Ring) -> Triangle {
    let around = |i: usize| surface.point(ring.vertices[i.min(ring.vertices.len() - 1)]);
    [surface.point(ring.center), around(0), around(1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::{Vector, distance_sq};

    #[test]
    fn a_ball_holds_what_it_stands_for() {
        let at = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
        let pieces = [Piece { corners: at(0.0), bound: 0.5 }, Piece { corners: at(7.0), bound: 0.0 }];
        let ball = Piece::around(&pieces);
        let far: Vector = [100.0, 3.0, -4.0];
        for piece in pieces {
            assert!(piece.distance(&[far; 3]) <= ball.distance(&[far; 3]) + 1e-12);
            assert!(distance_sq(piece.corners[0], far).sqrt() <= ball.distance(&[far; 3]));
        }
    }
}
