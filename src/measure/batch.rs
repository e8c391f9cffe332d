//! The samples of one tile, compared with a triangle all at once.

use super::found::Found;
use crate::geometry::bounds::Bounds;
use crate::geometry::distance::Triangle;
use crate::geometry::prepared::{PreparedTriangle, larger, smaller};
use crate::geometry::vector::{Vector, midpoint};

/// Most points of a batch, corners of the tile included.
pub(super) const BATCH_LEN: usize = 32;

/// Number of points that are compared at once.
const GROUP_LEN: usize = 4;

/// Corners of the quarters of a triangular tile.
const N_CORNERS: usize = 6;

/// A quarter of a triangular tile.
pub(super) struct Quarter {
    /// Its corners.
    pub(super) corners: Triangle,
    /// The triangle whose largest distance from the corners is least, among those compared.
    pub(super) bound: Found,
    /// The triangle nearest to each corner.
    pub(super) nearest: [Found; 3],
}

/// Corners of the quarters of a triangular tile, as places in a batch: places 0 to 2 are the
/// corners of the tile, and place `3 + i` is the middle of the side opposite to corner `i`.
const QUARTERS: [[usize; 3]; 4] = [[0, 5, 4], [5, 1, 3], [3, 4, 5], [4, 3, 2]];

/// The samples in a tile, coordinate by coordinate, with the least distances found so far. If the
/// tile is a triangle, the corners of its quarters come first, so that each quarter is bounded.
///
/// After `len`, up to the next multiple of a group, the last point is repeated.
pub(super) struct Batch {
    coordinates: [[f64; BATCH_LEN]; 3],
    nearest_sq: [f64; BATCH_LEN],
    /// Corners of quarters, 6 or none.
    n_corners: usize,
    len: usize,
    padded_len: usize,
    region: Bounds,
    /// The triangles that bound the quarters.
    bounds: [Found; 4],
    /// The triangles nearest to the corners of the quarters.
    nearest: [Found; N_CORNERS],
    reach_sq: f64,
    /// A triangle that is nearest to the last point.
    hint: u32,
}

impl Batch {
    /// An empty batch.
    pub(super) fn new() -> Self {
        Self {
            coordinates: [[0.0; BATCH_LEN]; 3],
            nearest_sq: [f64::INFINITY; BATCH_LEN],
            n_corners: 0,
            len: 0,
            padded_len: 0,
            region: Bounds::EMPTY,
            bounds: [Found::NOTHING; 4],
            nearest: [Found::NOTHING; N_CORNERS],
            reach_sq: f64::INFINITY,
            hint: 0,
        }
    }

    /// Replaces the content by a tile, given by its corners, and the points in it. Points for which
    /// there is no room stay in the iterator.
    pub(super) fn fill(&mut self, tile: &[Vector], points: &mut impl Iterator<Item = Vector>) {
        self.region = Bounds::around(tile.iter().copied());
        self.bounds = [Found::NOTHING; 4];
        self.nearest = [Found::NOTHING; N_CORNERS];
        self.reach_sq = f64::INFINITY;
        self.len = 0;
        if let &[a, b, c] = tile {
            for corner in [a, b, c, midpoint(b, c), midpoint(c, a), midpoint(a, b)] {
                self.push(corner);
            }
        }
        self.n_corners = self.len;
        for point in points.take(BATCH_LEN - self.len) {
            self.push(point);
        }
        self.padded_len = self.len.next_multiple_of(GROUP_LEN);
        for place in self.len..self.padded_len {
            self.set(place, self.point(self.len - 1));
        }
    }

    fn push(&mut self, p: Vector) {
        self.set(self.len, p);
        self.len += 1;
    }

    fn set(&mut self, place: usize, p: Vector) {
        for (coordinates, value) in self.coordinates.iter_mut().zip(p) {
            coordinates[place] = value;
        }
        self.nearest_sq[place] = f64::INFINITY;
    }

    fn point(&self, place: usize) -> Vector {
        self.coordinates.each_ref().map(|coordinates| coordinates[place])
    }

    /// The box around the tile.
    pub(super) fn region(&self) -> &Bounds {
        &self.region
    }

    /// The quarters of a triangular tile; none for a segment.
    pub(super) fn quarters(&self) -> impl Iterator<Item = Quarter> {
        let n_quarters = if self.n_corners == 0 { 0 } else { QUARTERS.len() };
        QUARTERS.into_iter().zip(self.bounds).take(n_quarters).map(|(places, bound)| Quarter {
            corners: places.map(|place| self.point(place)),
            bound,
            nearest: places.map(|place| self.nearest[place]),
        })
    }

    /// A triangle that is nearest to one of the points: a good hint for a nearby tile.
    pub(super) fn hint(&self) -> u32 {
        self.hint
    }

    /// Largest squared distance of a point from the triangles compared. A triangle farther from the
    /// tile than this is nearest to none of the points.
    #[inline(always)]
    pub(super) fn reach_sq(&self) -> f64 {
        self.reach_sq
    }

    /// The samples, corners left out, with their squared distances.
    pub(super) fn samples(&self) -> impl Iterator<Item = (Vector, f64)> {
        (self.n_corners..self.len).map(|place| (self.point(place), self.nearest_sq[place]))
    }

    /// Compares all points with one more triangle.
    #[inline(always)]
    pub(super) fn improve(&mut self, triangle: &PreparedTriangle, id: u32) {
        let mut distances_sq = [0.0; BATCH_LEN];
        let [x, y, z] = &self.coordinates;
        let mut reach_sq = [0.0; GROUP_LEN];
        for start in (0..self.padded_len).step_by(GROUP_LEN) {
            let group = start..start + GROUP_LEN;
            let found = &mut distances_sq[group.clone()];
            triangle.distances_sq([&x[group.clone()], &y[group.clone()], &z[group.clone()]], found);
            let nearest = &mut self.nearest_sq[group];
            for lane in 0..GROUP_LEN {
                nearest[lane] = smaller(nearest[lane], found[lane]);
                reach_sq[lane] = larger(reach_sq[lane], nearest[lane]);
            }
        }
        self.reach_sq = reach_sq.into_iter().fold(0.0, larger);
        if self.len > 0 && distances_sq[self.len - 1] <= self.nearest_sq[self.len - 1] {
            self.hint = id;
        }
        if self.n_corners > 0 {
            for (nearest, &distance_sq) in self.nearest.iter_mut().zip(&distances_sq) {
                if distance_sq < nearest.distance_sq {
                    *nearest = Found { distance_sq, triangle: id };
                }
            }
            for (bound, places) in self.bounds.iter_mut().zip(QUARTERS) {
                let distance_sq = places.map(|place| distances_sq[place]).into_iter().fold(0.0, larger);
                if distance_sq < bound.distance_sq {
                    *bound = Found { distance_sq, triangle: id };
                }
            }
        }
    }
}
