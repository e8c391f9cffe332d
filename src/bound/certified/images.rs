//! What the map takes onto the star of a vertex, and how far: what has to be known before the
//! vertex may move.
//!
//! A vertex that moves takes its star along. No triangle meets another one than before, so every
//! source vertex keeps its triangle and every crossing its edge, and only the nearest points in
//! them are new. Nothing outside the star changes, and the link stays where it is.

use super::route::point_at;
use super::{Certified, NOT_ON_RIM};
use crate::geometry::distance::{Segment, closest_on_segment, closest_weights};
use crate::geometry::vector::{Vector, add_scaled, dot, length_sq, scale, sub};
use crate::mesh::{Surface, facing_edge};

/// A point of the input whose image moves with the vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Image {
    /// The point of the input.
    pub source: Vector,
    /// What it is mapped to.
    pub onto: Onto,
}

/// Part of a star that contains its vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Onto {
    /// The vertex itself.
    Vertex,
    /// The edge from the vertex to this point.
    Edge(Vector),
    /// The triangle of the vertex and these two points.
    Triangle(Segment),
}

impl Image {
    /// From the source to its image, and the vertex's share in the image, when the vertex is at
    /// `apex`.
    pub(crate) fn displacement(&self, apex: Vector) -> (Vector, f64) {
        match self.onto {
            Onto::Vertex => (sub(self.source, apex), 1.0),
            Onto::Edge(end) => {
                let image = closest_on_segment(self.source, [apex, end]);
                let along = sub(apex, end);
                let share = dot(sub(image, end), along) / length_sq(along);
                (sub(self.source, image), if share.is_finite() { share } else { 1.0 })
            }
            Onto::Triangle([a, b]) => {
                let [share, of_a, of_b] = closest_weights(self.source, &[apex, a, b]);
                let image = add_scaled(add_scaled(scale(apex, share), of_a, a), of_b, b);
                (sub(self.source, image), share)
            }
        }
    }
}

impl Certified {
    /// Puts everything that is mapped onto the star of the inner vertex `v` into `images`. False if
    /// it is not clear which edge a crossing is on; then `v` has to stay.
    ///
    /// O(vertices and edges mapped into the star).
    pub(crate) fn images_at(&self, surface: &Surface, v: u32, images: &mut Vec<Image>) -> bool {
        images.clear();
        images.push(Image { source: surface.origin(v), onto: Onto::Vertex });
        let mut edges = vec![];
        for &slot in surface.star(v) {
            let (from, to) = facing_edge(surface.corners(slot), v);
            let onto = Onto::Triangle([from, to].map(|corner| surface.point(corner)));
            // A vertex on the rim of the mesh is mapped to an edge there, which the star of an
            // inner vertex has in its link.
            let vertices = self.contents.vertices(slot).iter().copied();
            let moving = vertices.filter(|&x| self.rim_corner[x as usize] == NOT_ON_RIM);
            images.extend(moving.map(|x| Image { source: surface.origin(x), onto }));
            edges.extend_from_slice(self.contents.edges(slot));
        }
        edges.sort_unstable();
        edges.dedup();
        edges.into_iter().all(|edge| self.crossings_at(surface, v, edge, images))
    }

    fn crossings_at(&self, surface: &Surface, v: u32, edge: u32, images: &mut Vec<Image>) -> bool {
        let segment = self.source.ends(edge).map(|end| surface.origin(end));
        let mut portions = self.chains.of(edge).iter().copied();
        let Some(mut before) = portions.next() else { return true };
        for after in portions {
            let [from, into] = [before.slot, after.slot].map(|slot| surface.corners(slot));
            if from.contains(&v) && into.contains(&v) {
                let mut shared = from.into_iter().filter(|&corner| corner != v && into.contains(&corner));
                let (Some(end), None) = (shared.next(), shared.next()) else { return false };
                let source = point_at(segment, before.end);
                images.push(Image { source, onto: Onto::Edge(surface.point(end)) });
            }
            before = after;
        }
        true
    }
}

/// Largest squared displacement of the images when their vertex is at `apex`.
pub(crate) fn largest_sq(images: &[Image], apex: Vector) -> f64 {
    images.iter().map(|image| length_sq(image.displacement(apex).0)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::distance_sq;

    #[test]
    fn displacements_are_distances_and_shares_weigh_the_apex() {
        let apex = [0.0, 0.0, 0.0];
        let at = |onto| Image { source: [0.25, 0.25, 2.0], onto }.displacement(apex);
        let (vertex, share) = at(Onto::Vertex);
        assert!((length_sq(vertex) - 4.125).abs() < 1e-12 && share == 1.0);
        let (edge, share) = at(Onto::Edge([1.0, 0.0, 0.0]));
        assert!((length_sq(edge) - distance_sq([0.25, 0.25, 2.0], [0.25, 0.0, 0.0])).abs() < 1e-12);
        assert!((share - 0.75).abs() < 1e-12);
        let (triangle, share) = at(Onto::Triangle([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
        assert!((length_sq(triangle) - 4.0).abs() < 1e-12 && (share - 0.5).abs() < 1e-12);
    }
}
