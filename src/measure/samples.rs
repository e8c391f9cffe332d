//! Positions of samples: spread evenly over a surface, without random numbers.
//!
//! Metro places its samples at random. Here sample `i` of `n` belongs to the element (triangle or
//! edge) that contains the fraction `(i + 1/2) / n` of the total area, so every region gets its
//! share to within one sample. Large elements are cut into equal *tiles* of a handful of samples
//! each. Inside a tile the samples follow the additive recurrence of the plastic number, a
//! two-dimensional sequence of low discrepancy (Roberts, *The Unreasonable Effectiveness of
//! Quasirandom Sequences*, 2018).

use crate::geometry::distance::{Segment, Triangle};
use crate::geometry::vector::{Vector, add_scaled, cross, length, sub};

/// Average number of samples of a tile.
const TILE_SAMPLES: f64 = 10.0;

/// Most parts into which the sides of one element are cut.
const MAX_PARTS: u32 = 4096;

/// The reciprocals of the plastic number and of its square.
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// An element with a size that can be cut into equal tiles of its own kind: a triangle or a
/// segment.
pub(super) trait Element: Copy + Send + Sync {
    /// The corners.
    fn corners(&self) -> &[Vector];
    /// Area, or length.
    fn size(&self) -> f64;
    /// Parts per side that make about `n_tiles` tiles.
    fn parts_for(n_tiles: f64) -> f64;
    /// Number of tiles if every side is cut into `parts`.
    fn n_tiles(parts: u32) -> u64;
    /// One of these tiles; neighbours in number are neighbours in space.
    fn tile(&self, parts: u32, index: u64) -> Self;
    /// The point of the element for two numbers in `[0, 1)`; uniform if they are.
    fn at(&self, u: f64, v: f64) -> Vector;
}

impl Element for Triangle {
    fn corners(&self) -> &[Vector] {
        self
    }

    fn size(&self) -> f64 {
        0.5 * length(cross(sub(self[1], self[0]), sub(self[2], self[0])))
    }

    fn parts_for(n_tiles: f64) -> f64 {
        n_tiles.sqrt()
    }

    fn n_tiles(parts: u32) -> u64 {
        u64::from(parts) * u64::from(parts)
    }

    /// Strip `r` between two lines parallel to the last side holds tiles `r^2 .. (r + 1)^2`, which
    /// point away from the first corner and towards it in turn.
    fn tile(&self, parts: u32, index: u64) -> Self {
        if parts == 1 {
            return *self;
        }
        let strip = index.isqrt();
        let place = index - strip * strip;
        let place = if strip.is_multiple_of(2) { place } else { 2 * strip - place };
        let column = place / 2;
        let node = |strip: u64, column: u64| {
            let [v, w] = [strip - column, column].map(|steps| steps as f64 / f64::from(parts));
            add_scaled(add_scaled(self[0], v, sub(self[1], self[0])), w, sub(self[2], self[0]))
        };
        if place % 2 == 0 {
            [node(strip, column), node(strip + 1, column), node(strip + 1, column + 1)]
        } else {
            [node(strip, column), node(strip + 1, column + 1), node(strip, column + 1)]
        }
    }

    fn at(&self, u: f64, v: f64) -> Vector {
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        add_scaled(add_scaled(self[0], u, sub(self[1], self[0])), v, sub(self[2], self[0]))
    }
}

impl Element for Segment {
    fn corners(&self) -> &[Vector] {
        self
    }

    fn size(&self) -> f64 {
        length(sub(self[1], self[0]))
    }

    fn parts_for(n_tiles: f64) -> f64 {
        n_tiles
    }

    fn n_tiles(parts: u32) -> u64 {
        u64::from(parts)
    }

    fn tile(&self, parts: u32, index: u64) -> Self {
        [index, index + 1].map(|steps| self.at(steps as f64 / f64::from(parts), 0.0))
    }

    fn at(&self, u: f64, _: f64) -> Vector {
        add_scaled(self[0], u, sub(self[1], self[0]))
    }
}

/// The samples of all elements of one kind.
pub(super) struct Samples<'a, E> {
    elements: &'a [E],
    /// `cumulative[i]` is the size of all elements before `i`.
    cumulative: Vec<f64>,
    /// `first_tile[i]` counts the tiles of all elements before `i`.
    first_tile: Vec<u64>,
    /// Parts of every side that make the tiles of each element.
    parts: Vec<u32>,
    n_samples: usize,
}

/// One tile with the numbers of its samples.
pub(super) struct Tile<E> {
    /// The corners.
    pub(super) corners: E,
    /// The numbers of its samples among all samples.
    samples: std::ops::Range<usize>,
}

impl<'a, E: Element> Samples<'a, E> {
    /// Spreads `n_samples` over the elements, which are cut into `n_tiles` tiles or as many as suit
    /// the samples. There are no samples if the elements have no size.
    pub(super) fn new(elements: &'a [E], n_samples: usize, n_tiles: f64) -> Self {
        let samples = Self::cut(elements, n_tiles.max(n_samples as f64 / TILE_SAMPLES));
        let n_samples = if samples.total_size() > 0.0 { n_samples } else { 0 };
        Self { n_samples, ..samples }
    }

    /// Cuts the elements into about `n_tiles` tiles without samples, at least one per element.
    pub(super) fn cut(elements: &'a [E], n_tiles: f64) -> Self {
        let mut total = 0.0;
        let mut cumulative = vec![total];
        cumulative.extend(elements.iter().map(|element| {
            total += element.size();
            total
        }));
        let mut n_before = 0;
        let mut first_tile = vec![n_before];
        let mut parts = Vec::with_capacity(elements.len());
        for sizes in cumulative.windows(2) {
            // NaN if no element has a size; it rounds to 0.
            let share = (sizes[1] - sizes[0]) / total * n_tiles;
            let n = round(E::parts_for(share)).clamp(1, MAX_PARTS);
            n_before += E::n_tiles(n);
            first_tile.push(n_before);
            parts.push(n);
        }
        Self { elements, cumulative, first_tile, parts, n_samples: 0 }
    }

    /// Tiles of all elements.
    pub(super) fn n_tiles(&self) -> u64 {
        self.first_tile[self.elements.len()]
    }

    /// Size of all elements.
    pub(super) fn total_size(&self) -> f64 {
        self.cumulative[self.elements.len()]
    }

    /// Consecutive tiles.
    pub(super) fn tiles(&self, range: std::ops::Range<u64>) -> impl Iterator<Item = Tile<E>> {
        let mut element = self.first_tile.partition_point(|&first| first <= range.start) - 1;
        range.map(move |tile| {
            while self.first_tile[element + 1] <= tile {
                element += 1;
            }
            let parts = self.parts[element];
            let index = tile - self.first_tile[element];
            let [start, end] = [index, index + 1].map(|index| self.first_sample_after(element, index));
            Tile { corners: self.elements[element].tile(parts, index), samples: start..end }
        })
    }

    /// Number of the first sample that is not before tile `index` of an element.
    fn first_sample_after(&self, element: usize, index: u64) -> usize {
        let [start, end] = [self.cumulative[element], self.cumulative[element + 1]];
        let n_tiles = E::n_tiles(self.parts[element]);
        let before =
            if index == n_tiles { end } else { start + (end - start) * (index as f64 / n_tiles as f64) };
        let n_samples = self.n_samples as f64;
        round_up((before / self.total_size() * n_samples - 0.5).clamp(0.0, n_samples))
    }
}

impl<E: Element> Tile<E> {
    /// The samples' positions.
    pub(super) fn points(&self) -> impl Iterator<Item = Vector> {
        self.samples.clone().map(|i| {
            let [u, v] = STEPS.map(|step| fraction(0.5 + i as f64 * step));
            self.corners.at(u, v)
        })
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what is out of range is clamped"
)]
fn round(x: f64) -> u32 {
    x.round() as u32
}

/// The fractional part of a number that is not negative. `f64::fract` would be a function call.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "as many samples as fit a u64")]
fn fraction(x: f64) -> f64 {
    x - (x as u64) as f64
}

/// Smallest integer not below a number; 0 for NaN.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts samples, never negative")]
fn round_up(x: f64) -> usize {
    x.ceil() as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::distance::point_triangle_distance_sq;

    const TRIANGLES: [Triangle; 3] = [
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 3.0, 1.0]],
        [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 3.0]],
    ];

    #[test]
    fn tiles_are_a_partition() {
        for parts in [1, 2, 3, 8] {
            let tiles: Vec<Triangle> =
                (0..Triangle::n_tiles(parts)).map(|index| TRIANGLES[0].tile(parts, index)).collect();
            let part = 6.0 / tiles.len() as f64;
            assert!(tiles.iter().all(|tile| (tile.size() - part).abs() < 1e-12));
            // Equal areas that add up: a partition, unless two tiles overlap, and then their
            // centroids coincide.
            let centroid = |tile: &Triangle| tile.at(1.0 / 3.0, 1.0 / 3.0);
            for (i, first) in tiles.iter().enumerate() {
                assert!(point_triangle_distance_sq(centroid(first), &TRIANGLES[0]) < 1e-24);
                for second in &tiles[..i] {
                    assert!(length(sub(centroid(first), centroid(second))) > 1e-3);
                }
            }
        }
    }

    #[test]
    fn every_region_gets_its_share() {
        for n_samples in [1, 2, 10, 1000, 54_321] {
            let samples = Samples::new(&TRIANGLES, n_samples, 0.0);
            let points: Vec<Vector> = samples
                .tiles(0..samples.n_tiles())
                .flat_map(|tile| tile.points().collect::<Vec<_>>())
                .collect();
            assert_eq!(points.len(), n_samples);
            let total: f64 = TRIANGLES.iter().map(Element::size).sum();
            for (triangle, z) in TRIANGLES.iter().zip([0.0, 1.0, 2.0]) {
                let n = points.iter().filter(|p| p[2] >= z && p[2] < z + 1.0).count();
                let share = triangle.size() / total * n_samples as f64;
                assert!((n as f64 - share).abs() <= 1.0, "{n} samples, the share is {share}");
            }
        }
    }

    #[test]
    fn moments_of_a_triangle() {
        let samples = Samples::new(&TRIANGLES[..1], 100_000, 0.0);
        let x: Vec<f64> = samples
            .tiles(0..samples.n_tiles())
            .flat_map(|tile| tile.points().collect::<Vec<_>>())
            .map(|p| p[0])
            .collect();
        let mean = x.iter().sum::<f64>() / x.len() as f64;
        let mean_sq = x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64;
        assert!((mean - 4.0 / 3.0).abs() < 1e-4, "mean {mean}");
        assert!((mean_sq - 16.0 / 6.0).abs() < 3e-4, "mean square {mean_sq}");
    }
}
