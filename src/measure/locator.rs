//! Finds the tetrahedron that contains a point.
//!
//! Meshes of simulations are a thousand times finer in one place than in another, so no grid of
//! equal cells fits them. Here tetrahedra are sorted into a tree of boxes, which are halved at the
//! median of the centres along the longest side.

use crate::geometry::barycentric::barycentric;
use crate::geometry::vector::{Vector, add, max, min, scale, sub};
use nephrite_formats::TetrahedronMesh;

/// Tetrahedra in a leaf.
const LEAF_LEN: usize = 4;

/// How far outside, in barycentric coordinates, a point still counts as inside: the rounding of
/// positions.
const TOLERANCE: f64 = 1e-5;

/// Most tetrahedra at one point that are looked at.
const MAX_PLACES: usize = 1024;

/// The corners of a tetrahedron and the barycentric coordinates of a point there.
pub(super) type Place = ([u32; 4], [f64; 4]);

/// A tree of boxes over the tetrahedra of a volume.
pub(super) struct Locator<'a> {
    volume: &'a TetrahedronMesh,
    order: Vec<u32>,
    /// Boxes of the nodes; node `i` has the children `2 i + 1` and `2 i + 2`, and `order` is halved
    /// between them.
    boxes: Vec<[Vector; 2]>,
}

impl<'a> Locator<'a> {
    /// O(n log n).
    pub(super) fn new(volume: &'a TetrahedronMesh) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "readers refuse more than u32::MAX tetrahedra")]
        let order: Vec<u32> = (0..volume.tetrahedra.len() as u32).collect();
        let mut locator = Self { volume, order, boxes: Vec::new() };
        let mut order = std::mem::take(&mut locator.order);
        // Children come after their parents, and the depth is the logarithm of the length: a stack
        // of ranges.
        let mut stack = vec![(0, 0..order.len())];
        while let Some((node, range)) = stack.pop() {
            let bounds = locator.bounds(&order[range.clone()]);
            if locator.boxes.len() <= node {
                locator.boxes.resize(node + 1, [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]);
            }
            locator.boxes[node] = bounds;
            if range.len() > LEAF_LEN {
                let sides = sub(bounds[1], bounds[0]);
                let axis = (0..3).max_by(|&i, &j| sides[i].total_cmp(&sides[j])).unwrap_or(0);
                let middle = range.len() / 2;
                order[range.clone()].select_nth_unstable_by(middle, |&a, &b| {
                    locator.centre(a)[axis].total_cmp(&locator.centre(b)[axis])
                });
                stack.push((2 * node + 1, range.start..range.start + middle));
                stack.push((2 * node + 2, range.start + middle..range.end));
            }
        }
        locator.order = order;
        locator
    }

    fn corners(&self, tetrahedron: u32) -> [Vector; 4] {
        self.volume.tetrahedra[tetrahedron as usize].map(|v| self.volume.positions[v as usize].map(f64::from))
    }

    fn centre(&self, tetrahedron: u32) -> Vector {
        scale(self.corners(tetrahedron).into_iter().fold([0.0; 3], add), 0.25)
    }

    fn bounds(&self, tetrahedra: &[u32]) -> [Vector; 2] {
        let start = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let points = tetrahedra.iter().flat_map(|&tetrahedron| self.corners(tetrahedron));
        points.fold(start, |[low, high], p| [min(low, p), max(high, p)])
    }

    /// The corners of the tetrahedron that contains a point best, and the barycentric coordinates
    /// there; `None` if the point is outside of all.
    pub(super) fn find(&self, point: Vector) -> Option<Place> {
        let mut best = None;
        let mut best_inside = -TOLERANCE;
        self.visit(point, |place, inside| {
            if inside >= best_inside {
                (best_inside, best) = (inside, Some(place));
            }
            inside <= 0.0
        });
        best
    }

    /// All tetrahedra that contain a point, as [`find`](Self::find) gives one; of very many some.
    pub(super) fn find_all(&self, point: Vector, places: &mut Vec<Place>) {
        places.clear();
        self.visit(point, |place, inside| {
            if inside >= -TOLERANCE {
                places.push(place);
            }
            places.len() < MAX_PLACES
        });
    }

    /// Calls `visit` for each tetrahedron near a point, with the least coordinate there, until it
    /// returns false.
    fn visit(&self, point: Vector, mut visit: impl FnMut(Place, f64) -> bool) {
        let mut stack = vec![(0, 0..self.order.len())];
        while let Some((node, range)) = stack.pop() {
            let Some([low, high]) = self.boxes.get(node) else { return };
            let margin = |axis: usize| TOLERANCE * (high[axis] - low[axis]);
            if (0..3).any(|i| point[i] < low[i] - margin(i) || point[i] > high[i] + margin(i)) {
                continue;
            }
            if range.len() > LEAF_LEN {
                let middle = range.start + range.len() / 2;
                stack.push((2 * node + 1, range.start..middle));
                stack.push((2 * node + 2, middle..range.end));
                continue;
            }
            for &tetrahedron in &self.order[range] {
                let Some(weights) = barycentric(point, self.corners(tetrahedron)) else { continue };
                let inside = weights.iter().copied().fold(f64::INFINITY, f64::min);
                if !visit((self.volume.tetrahedra[tetrahedron as usize], weights), inside) {
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::box_volume;

    #[test]
    fn points_are_found_where_they_are_and_nowhere_outside() {
        let volume = box_volume([5, 6, 7]);
        let locator = Locator::new(&volume);
        for i in 0..1000_u32 {
            let part = |factor: u32| f64::from(i * factor % 997) / 996.0;
            let point = [part(31), part(57), part(101)];
            let (corners, weights) = locator.find(point).unwrap();
            let mut found = [0.0; 3];
            for (&v, weight) in corners.iter().zip(weights) {
                found = add(found, scale(volume.positions[v as usize].map(f64::from), weight));
            }
            assert!((0..3).all(|axis| (found[axis] - point[axis]).abs() < 1e-6));
            assert!(locator.find([point[0] + 1.5, point[1], point[2]]).is_none());
        }
    }
}
