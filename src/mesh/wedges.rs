//! Attributes at points: which vertex each triangle has at a point that carries several.
//!
//! A *wedge* is a vertex of the mesh: a point with one set of attributes (H. Hoppe, "Efficient
//! implementation of progressive meshes", 1998, section 2). A *seam* runs where the wedges on
//! either side of an edge look different. Without seams a point and its wedge are the same number,
//! and nothing here is needed.

use super::{Renumbering, Surface};

/// The wedges at the corners of every slot, parallel to the points that [`Surface`] keeps there.
#[derive(Clone, Debug)]
pub(crate) struct Wedges {
    corners: Vec<[u32; 3]>,
    /// Wedges that differ at most in the normal have the same entry.
    looks: Vec<u32>,
}

impl Wedges {
    /// Parts `triangles` into the points at their corners and the wedges. `points` has the point of
    /// each wedge, and wedges look the same if their entries in `looks` agree; without `points` a
    /// wedge is its own point.
    pub(crate) fn part(
        triangles: Vec<[u32; 3]>,
        points: Option<Vec<u32>>,
        looks: Option<Vec<u32>>,
    ) -> (Vec<[u32; 3]>, Option<Self>) {
        let Some((points, looks)) = points.zip(looks) else { return (triangles, None) };
        let over_points = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
        (over_points, Some(Self { corners: triangles, looks }))
    }

    /// The wedges of the triangle in `slot`.
    pub(crate) fn corners(&self, slot: u32) -> [u32; 3] {
        self.corners[slot as usize]
    }

    /// The wedge that the triangle in `slot` has at `point`, one of its corners.
    pub(crate) fn at(&self, surface: &Surface, slot: u32, point: u32) -> u32 {
        let corner = surface.corners(slot).iter().position(|&corner| corner == point);
        corner.map_or(point, |corner| self.corners[slot as usize][corner])
    }

    /// The one wedge that all triangles at `point` have there; `None` if they have several.
    pub(crate) fn only_at(&self, surface: &Surface, point: u32) -> Option<u32> {
        let mut wedges = surface.star(point).iter().map(|&slot| self.at(surface, slot, point));
        let first = wedges.next()?;
        wedges.all(|wedge| wedge == first).then_some(first)
    }

    /// Whether a seam runs along an edge: whether the surface looks different in the two slots
    /// beside it, at one of its ends.
    pub(crate) fn differ(&self, surface: &Surface, slots: [u32; 2], edge: [u32; 2]) -> bool {
        edge.into_iter().any(|point| {
            let [a, b] = slots.map(|slot| self.looks[self.at(surface, slot, point) as usize]);
            a != b
        })
    }

    /// Puts a triangle with these wedges into `slot`.
    pub(crate) fn set(&mut self, slot: u32, corners: [u32; 3]) {
        self.corners[slot as usize] = corners;
    }

    /// Gives the triangle in `slot` another wedge in the place of `from`.
    pub(crate) fn rename(&mut self, slot: u32, from: u32, to: u32) {
        let corners = &mut self.corners[slot as usize];
        *corners = corners.map(|wedge| if wedge == from { to } else { wedge });
    }

    /// Gives the triangles at `point`, which have one wedge there, the new wedge `new`, which has
    /// the next number and looks like the one before. Returns the one before.
    pub(crate) fn replace_at(&mut self, surface: &Surface, point: u32, new: u32) -> u32 {
        debug_assert_eq!(new as usize, self.looks.len());
        let star = surface.star(point);
        let old = star.first().map_or(point, |&slot| self.at(surface, slot, point));
        self.add_copy(old);
        star.iter().for_each(|&slot| self.rename(slot, old, new));
        old
    }

    /// A new wedge that looks like `wedge`.
    pub(crate) fn add_copy(&mut self, wedge: u32) {
        self.looks.push(self.looks[wedge as usize]);
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        slots.close_up(&mut self.corners);
    }
}
