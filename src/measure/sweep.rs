//! One pass over a surface: the distances of its vertices and samples from the other surface, and a
//! first bound.
//!
//! The plain way searches the whole hierarchy for every sample. The samples of one tile lie close
//! together, so here a tile is one search, and the corners of its quarters, which take part in it,
//! give first upper bounds for the proof. The tiles of a chunk lie close together too, so each of
//! these searches begins at the few nodes that matter to the chunk.

use std::ops::Range;

use rayon::prelude::*;

use super::batch::Batch;
use super::found::Farthest;
use super::prove::{Cutter, Parts};
use super::samples::{Element, Samples, Tile};
use super::search::{Front, Stack, TriangleTree};
use crate::geometry::bounds::Bounds;
use crate::geometry::distance::{Segment, Triangle};
use crate::geometry::vector::{self, Vector};

/// Vertices that one thread takes at a time.
const VERTICES_PER_CHUNK: usize = 512;

/// Tiles that one thread takes at a time.
const TILES_PER_CHUNK: u64 = 64;

/// Sums over the distances of samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SampleSums {
    /// How many samples.
    pub(super) n: usize,
    /// Sum of their distances.
    pub(super) sum: f64,
    /// Sum of the squares of their distances.
    pub(super) sum_sq: f64,
    /// The sample that is farthest away.
    pub(super) farthest: Farthest,
}

impl SampleSums {
    fn count(&mut self, point: Vector, distance_sq: f64) {
        self.n += 1;
        self.sum += distance_sq.sqrt();
        self.sum_sq += distance_sq;
        self.farthest = self.farthest.or(Farthest { distance_sq, point });
    }

    fn merge(self, other: Self) -> Self {
        Self {
            n: self.n + other.n,
            sum: self.sum + other.sum,
            sum_sq: self.sum_sq + other.sum_sq,
            farthest: self.farthest.or(other.farthest),
        }
    }
}

/// Distances of points from a surface; NaN for a point that is not finite. Neighbours in the slice
/// should be neighbours in space.
pub(super) fn point_distances(points: &[Vector], target: &TriangleTree) -> Vec<f64> {
    let mut distances = vec![0.0; points.len()];
    let chunks = distances.par_chunks_mut(VERTICES_PER_CHUNK).zip(points.par_chunks(VERTICES_PER_CHUNK));
    chunks.for_each_init(Stack::default, |stack, (distances, points)| {
        let mut hint = 0;
        for (distance, &point) in distances.iter_mut().zip(points) {
            if !point.iter().all(|coordinate| coordinate.is_finite()) {
                *distance = f64::NAN;
                continue;
            }
            let found = target.search(&[point], hint, stack);
            hint = found.triangle;
            *distance = found.distance_sq.sqrt();
        }
    });
    distances
}

/// The tally of points with known distances.
pub(super) fn tally_points(points: &[Vector], distances: &[f64]) -> SampleSums {
    let mut tally = SampleSums::default();
    for (&point, &distance) in points.iter().zip(distances) {
        tally.count(point, distance * distance);
    }
    tally
}

/// The tally of all samples on edges.
pub(super) fn sweep_edges(samples: &Samples<'_, Segment>, target: &TriangleTree) -> SampleSums {
    sweep(samples, target, |walk, tiles| {
        let mut tally = SampleSums::default();
        for tile in samples.tiles(tiles) {
            walk.visit(&tile, target, |point, distance_sq| tally.count(point, distance_sq));
        }
        tally
    })
    .into_iter()
    .fold(SampleSums::default(), SampleSums::merge)
}

/// The tally of all samples inside triangles, and the proven bound of all tiles: tiles above
/// `settled_sq` stay open.
pub(super) fn sweep_faces(
    samples: &Samples<'_, Triangle>,
    target: &TriangleTree,
    settled_sq: f64,
) -> (SampleSums, Parts) {
    let chunks = sweep(samples, target, |walk, tiles| {
        let mut tally = SampleSums::default();
        let mut cutter = Cutter::new(target, settled_sq);
        for tile in samples.tiles(tiles) {
            walk.visit(&tile, target, |point, distance_sq| tally.count(point, distance_sq));
            walk.batch.quarters().for_each(|quarter| cutter.settle_or_cut(&quarter));
        }
        (tally, cutter.into_parts())
    });
    let mut total = SampleSums::default();
    let mut all = Parts::default();
    for (tally, parts) in chunks {
        total = total.merge(tally);
        all.merge(parts);
    }
    (total, all)
}

/// Distances of all samples inside triangles, in the order of the samples.
pub(super) fn face_distances(samples: &Samples<'_, Triangle>, target: &TriangleTree) -> Vec<f64> {
    sweep(samples, target, |walk, tiles| {
        let mut distances = Vec::new();
        for tile in samples.tiles(tiles) {
            walk.visit(&tile, target, |_, distance_sq| distances.push(distance_sq.sqrt()));
        }
        distances
    })
    .concat()
}

/// Passes every chunk of tiles to a visitor, in parallel; the results are in the order of the
/// tiles.
fn sweep<E: Element, T: Send>(
    samples: &Samples<'_, E>,
    target: &TriangleTree,
    visit: impl Fn(&mut Walk, Range<u64>) -> T + Sync,
) -> Vec<T> {
    let n_tiles = samples.n_tiles();
    (0..n_tiles.div_ceil(TILES_PER_CHUNK))
        .into_par_iter()
        .map_init(Walk::new, |walk, chunk| {
            let start = chunk * TILES_PER_CHUNK;
            let tiles = start..(start + TILES_PER_CHUNK).min(n_tiles);
            let corners = samples
                .tiles(tiles.clone())
                .map(|tile| Bounds::around(tile.corners.corners().iter().copied()));
            walk.enter(&corners.fold(Bounds::EMPTY, |all, tile| all.union(&tile)), target);
            visit(walk, tiles)
        })
        .collect()
}

/// A walk over the tiles of a chunk, on which each search starts from what the last one found.
struct Walk {
    hint: u32,
    front: Front,
    stack: Stack,
    batch: Batch,
}

impl Walk {
    fn new() -> Self {
        Self { hint: 0, front: Front::default(), stack: Stack::default(), batch: Batch::new() }
    }

    /// Finds the nodes of the target that matter to a region.
    fn enter(&mut self, region: &Bounds, target: &TriangleTree) {
        let centre = vector::midpoint(region.low, region.high);
        let found = target.search(&[centre], 0, &mut self.stack);
        self.hint = found.triangle;
        // No point of the region is farther than its centre by more than half its diagonal.
        let radius = found.distance_sq.sqrt() + vector::length(vector::sub(region.high, centre));
        target.front(region, radius * radius * (1.0 + 1e-9), &mut self.front);
    }

    /// Passes the squared distance of each sample of a tile within the region to `count`, and
    /// leaves the bounds of the tile in the batch.
    fn visit<E: Element>(
        &mut self,
        tile: &Tile<E>,
        target: &TriangleTree,
        mut count: impl FnMut(Vector, f64),
    ) {
        let mut points = tile.points().peekable();
        loop {
            self.batch.fill(tile.corners.corners(), &mut points);
            target.search_batch(&mut self.batch, &self.front, self.hint, &mut self.stack);
            self.hint = self.batch.hint();
            self.batch.samples().for_each(|(point, distance_sq)| count(point, distance_sq));
            if points.peek().is_none() {
                return;
            }
        }
    }
}
