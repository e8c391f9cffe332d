//! Seams: where one point carries several vertices because their attributes differ.

use super::{Renumbering, Surface};

/// The vertices at the corners of every slot, parallel to the points that [`Surface`] keeps there.
///
/// Needed only for meshes that have seams; without one a point and its vertex are the same number.
#[derive(Clone, Debug)]
pub struct Seams {
    vertices: Vec<[u32; 3]>,
    looks: Vec<u32>,
}

impl Seams {
    /// Parts `triangles` into the points at their corners and the seams. `points` has the point of
    /// each vertex, and vertices look the same where their entries in `looks` agree; without
    /// `points` a vertex is its own point.
    pub fn part(
        triangles: Vec<[u32; 3]>,
        points: Option<Vec<u32>>,
        looks: Option<Vec<u32>>,
    ) -> (Vec<[u32; 3]>, Option<Self>) {
        let Some((points, looks)) = points.zip(looks) else { return (triangles, None) };
        let over_points = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
        (over_points, Some(Self::new(triangles, looks)))
    }

    /// Seams of a mesh whose slot `t` has the vertices `triangles[t]`, and whose vertices look the
    /// same where their entries in `looks` agree.
    pub fn new(triangles: Vec<[u32; 3]>, looks: Vec<u32>) -> Self {
        Self { vertices: triangles, looks }
    }

    /// Whether the surface looks different on either side of a common point of the triangles in two
    /// slots.
    pub fn differ(&self, surface: &Surface, slots: [u32; 2], point: u32) -> bool {
        let [a, b] = slots.map(|slot| self.looks[self.vertex(surface, slot, point) as usize]);
        a != b
    }

    /// The vertex that the triangle in `slot` has at `point`, one of its corners.
    pub fn vertex(&self, surface: &Surface, slot: u32, point: u32) -> u32 {
        let corner = surface.corners(slot).iter().position(|&corner| corner == point);
        corner.map_or(point, |corner| self.vertices[slot as usize][corner])
    }

    /// The vertices of the triangle in `slot`.
    pub fn corners(&self, slot: u32) -> [u32; 3] {
        self.vertices[slot as usize]
    }

    /// The one vertex that all triangles at `point` have there; `None` if they have several.
    pub fn only_vertex(&self, surface: &Surface, point: u32) -> Option<u32> {
        let mut vertices = surface.star(point).iter().map(|&slot| self.vertex(surface, slot, point));
        let first = vertices.next()?;
        vertices.all(|v| v == first).then_some(first)
    }

    /// Gives the triangles at `point`, which have one vertex there, the vertex `new` instead, which
    /// has the next number. It looks like the one before, whose number is returned.
    pub fn rename(&mut self, surface: &Surface, point: u32, new: u32) -> u32 {
        debug_assert_eq!(new as usize, self.looks.len());
        let star = surface.star(point);
        let old = star.first().map_or(point, |&slot| self.vertex(surface, slot, point));
        self.looks.push(self.looks[old as usize]);
        for &slot in star {
            for v in self.vertices[slot as usize].iter_mut().filter(|v| **v == old) {
                *v = new;
            }
        }
        old
    }

    /// Gives every slot its new number.
    pub fn renumber_slots(&mut self, slots: &Renumbering) {
        slots.close_up(&mut self.vertices);
    }

    /// Puts a triangle with these vertices into `slot`.
    pub fn set(&mut self, slot: u32, vertices: [u32; 3]) {
        self.vertices[slot as usize] = vertices;
    }
}
