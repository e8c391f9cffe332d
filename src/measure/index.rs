//! Triangles that are found by where they once were.

use super::bvh;
use super::found::Found;
use super::search::{Stack, TriangleTree};
use crate::geometry::distance::Triangle;
use crate::geometry::vector::Vector;

/// Triangles of a mesh as they were at one time, each with an id.
#[derive(Clone, Debug)]
pub(crate) struct TriangleIndex {
    tree: TriangleTree,
    /// Ids in the order of the tree.
    ids: Vec<u32>,
}

impl TriangleIndex {
    /// An index of the triangles, of which there is at least one. O(n log n).
    pub(crate) fn new(ids: &[u32], triangles: &[Triangle]) -> Self {
        let (nodes, order) = bvh::build(triangles);
        let in_order = order.iter().map(|&at| triangles[at as usize]).collect();
        Self {
            tree: TriangleTree::new(nodes, in_order),
            ids: order.iter().map(|&at| ids[at as usize]).collect(),
        }
    }

    /// How many triangles there are.
    pub(crate) fn len(&self) -> usize {
        self.ids.len()
    }

    /// The id for which `distance_sq` is least, asked for those that may be nearest to the corners
    /// by where they were; nothing if it is infinite for all. Exact while the triangles are where
    /// they were, else a good guess.
    pub(crate) fn nearest(
        &self,
        corners: &[Vector],
        mut distance_sq: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let mut best = Found::NOTHING;
        self.tree.walk(corners, &mut best, &mut Stack::default(), |best, triangle| {
            let found_sq = distance_sq(self.ids[triangle as usize]);
            if found_sq < best.distance_sq {
                *best = Found { distance_sq: found_sq, triangle };
            }
        });
        best.distance_sq.is_finite().then(|| (self.ids[best.triangle as usize], best.distance_sq))
    }
}
