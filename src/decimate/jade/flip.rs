//! Edge flips that bring a filling nearer to the star it replaces (JADE, section 6).
//!
//! The composed criterion of the paper: an inner edge is flipped when the volume between filling
//! and removed vertex falls, the sampled local error falls, and the aspect ratio gets no worse than
//! a stated part below the star's.

use super::validity::{aspect, faces, worst_star_aspect};
use crate::bound::accumulated::Sampler;
use crate::geometry::distance::Triangle;
use crate::geometry::vector::{cross, dot, sub};
use crate::mesh::{Filling, Hole, Surface};

/// Flips inner edges while that helps. Each flip lowers the volume, so it ends; O(valence^2) flips
/// at most.
pub(crate) fn flip_edges(
    surface: &Surface,
    hole: &Hole,
    sampler: &Sampler,
    aspect_loss: f64,
    filling: &mut Filling,
) {
    let n = filling.triangles.len();
    let worst_aspect = worst_star_aspect(hole) * (1.0 - aspect_loss);
    for _ in 0..n * n {
        let flip = pairs(n)
            .filter(|&(first, second)| filling.part_start(first) == filling.part_start(second))
            .find_map(|pair| find_flip(surface, hole, sampler, worst_aspect, filling, pair));
        let Some(((first, second), flipped)) = flip else { return };
        filling.triangles[first] = flipped[0];
        filling.triangles[second] = flipped[1];
    }
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |second| (0..second).map(move |first| (first, second)))
}

type Flip = ((usize, usize), [[u8; 3]; 2]);

/// The flip of the edge between two triangles of the filling, if they have one and it helps.
fn find_flip(
    surface: &Surface,
    hole: &Hole,
    sampler: &Sampler,
    worst_aspect: f64,
    filling: &Filling,
    (first, second): (usize, usize),
) -> Option<Flip> {
    let flipped = flip(filling.triangles[first], filling.triangles[second])?;
    let place = |triangle: [u8; 3]| triangle.map(|corner| hole.points[usize::from(corner)]);
    let old = [first, second].map(|i| filling.triangle(hole, i));
    let new = flipped.map(place);
    let up = hole.average_normal();
    let is_better = volume(hole, &new) < volume(hole, &old)
        && new.iter().all(|triangle| aspect(triangle) >= worst_aspect && faces(triangle, up))
        && may_be_made(surface, hole, flipped)
        && sampled_error(hole, sampler, &new) < sampled_error(hole, sampler, &old);
    is_better.then_some(((first, second), flipped))
}

/// Two triangles `a b c` and `c b d`, rotated as they may be, turned into `a b d` and `a d c`.
fn flip(first: [u8; 3], second: [u8; 3]) -> Option<[[u8; 3]; 2]> {
    (0..3).find_map(|i| {
        let [a, b, c] = [first[i], first[(i + 1) % 3], first[(i + 2) % 3]];
        let j = (0..3).find(|&j| second[j] == c && second[(j + 1) % 3] == b)?;
        let d = second[(j + 2) % 3];
        Some([[a, b, d], [a, d, c]])
    })
}

/// Whether the edge that a flip makes, between the first and last corner of its first triangle, may
/// be made.
fn may_be_made(surface: &Surface, hole: &Hole, [[a, _, d], _]: [[u8; 3]; 2]) -> bool {
    surface.may_join(hole.ring[usize::from(a)], hole.ring[usize::from(d)])
}

/// Volume, times six, between two triangles and the removed vertex.
fn volume(hole: &Hole, triangles: &[Triangle; 2]) -> f64 {
    let one = |&[a, b, c]: &Triangle| dot(cross(sub(b, a), sub(c, a)), sub(hole.apex, a)).abs();
    triangles.iter().map(one).sum()
}

fn sampled_error(hole: &Hole, sampler: &Sampler, triangles: &[Triangle; 2]) -> f64 {
    let error_sq = |triangle| sampler.local_error_sq(triangle, hole, f64::INFINITY);
    error_sq(&triangles[0]).max(error_sq(&triangles[1]))
}
