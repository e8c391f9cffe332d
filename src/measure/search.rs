//! Searches in the hierarchy: for the nearest triangle, for the triangle that bounds a convex piece
//! best, and for the part of the tree that matters to a region.
//!
//! One traversal serves the first two. For the corners of a convex piece it finds the triangle
//! whose largest distance from a corner is least. The distance to a triangle is a convex function,
//! so that largest corner distance bounds the distance of every point of the piece. For a piece of
//! one corner the result is the nearest triangle.

use multiversion::multiversion;

use super::batch::Batch;
use super::bvh::{Child, LANES, Node};
use super::found::Found;
use crate::geometry::bounds::Bounds;
use crate::geometry::distance::Triangle;
use crate::geometry::prepared::{PreparedTriangle, larger};
use crate::geometry::vector::Vector;

/// Most subtrees of a [`Front`].
const FRONT_LEN: usize = 16;

/// Triangles under a hierarchy.
#[derive(Clone, Debug)]
pub(super) struct TriangleTree {
    nodes: Vec<Node>,
    /// In the order of the leaves.
    triangles: Vec<Triangle>,
    /// The same, prepared.
    prepared: Vec<PreparedTriangle>,
}

/// Subtrees that together hold every triangle that can be nearest to some point of a region, as
/// children of their own nodes.
#[derive(Default)]
pub(super) struct Front {
    subtrees: Vec<(Bounds, Child)>,
    nodes: Vec<Node>,
}

/// Buffers that searches reuse.
#[derive(Default)]
pub(super) struct Stack {
    nodes: Vec<(f64, u32)>,
}

impl TriangleTree {
    /// Takes triangles in the order of the leaves of the nodes.
    pub(super) fn new(nodes: Vec<Node>, triangles: Vec<Triangle>) -> Self {
        let prepared = triangles.iter().map(PreparedTriangle::new).collect();
        Self { nodes, triangles, prepared }
    }

    /// The triangles, in the order of the leaves.
    pub(super) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Squared distance of a point from one triangle.
    #[inline(always)]
    pub(super) fn distance_sq(&self, p: Vector, triangle: u32) -> f64 {
        self.prepared[triangle as usize].distance_sq(p)
    }

    /// The bound that one triangle gives: its largest distance from a corner.
    pub(super) fn bound(&self, corners: &[Vector], triangle: u32) -> Found {
        let distances_sq = corners.iter().map(|&corner| self.distance_sq(corner, triangle));
        Found { distance_sq: distances_sq.fold(0.0, larger), triangle }
    }

    /// The triangle whose largest distance from one of the corners is least.
    ///
    /// The closer `hint` is to it, the fewer nodes are visited. About 0.2 us for a point with a
    /// good hint.
    pub(super) fn search(&self, corners: &[Vector], hint: u32, stack: &mut Stack) -> Found {
        let mut best = Found { distance_sq: f64::INFINITY, triangle: hint };
        self.improve(&mut best, corners, hint);
        self.walk(corners, &mut best, stack, |best, triangle| {
            if triangle != hint {
                self.improve(best, corners, triangle);
            }
        });
        best
    }

    /// Shows `improve` all triangles whose boxes are nearer to each of the corners than the best
    /// distance so far, the nearest boxes first.
    #[inline(always)]
    pub(super) fn walk(
        &self,
        corners: &[Vector],
        best: &mut Found,
        stack: &mut Stack,
        mut improve: impl FnMut(&mut Found, u32),
    ) {
        let stack = &mut stack.nodes;
        stack.clear();
        stack.push((0.0, 0));
        while let Some((distance_sq, node)) = stack.pop() {
            if distance_sq >= best.distance_sq {
                continue;
            }
            let node = &self.nodes[node as usize];
            let mut distances_sq = node.point_distances_sq(corners[0]);
            for &corner in &corners[1..] {
                let others_sq = node.point_distances_sq(corner);
                for lane in 0..LANES {
                    distances_sq[lane] = larger(distances_sq[lane], others_sq[lane]);
                }
            }
            let bottom = stack.len();
            for lane in lanes_below(&distances_sq, best.distance_sq) {
                match node.child(lane) {
                    Child::Node(child) => push_in_order(stack, bottom, (distances_sq[lane], child)),
                    Child::Leaf { first, n_triangles } => {
                        (first..first + n_triangles).for_each(|triangle| improve(best, triangle));
                    }
                }
            }
        }
    }

    /// Replaces the best triangle if this one bounds all corners better.
    #[inline(always)]
    fn improve(&self, best: &mut Found, corners: &[Vector], triangle: u32) {
        let candidate = &self.prepared[triangle as usize];
        let mut distance_sq = 0.0;
        for &corner in corners {
            distance_sq = larger(distance_sq, candidate.distance_sq(corner));
            if distance_sq >= best.distance_sq {
                return;
            }
        }
        *best = Found { distance_sq, triangle };
    }

    /// Finds the distances of all points of a batch, and triangles that bound its tile.
    ///
    /// Only triangles of the front, which must be that of a region around the tile, and the
    /// triangle `hint` are considered. The box of the tile walks down the tree instead of each
    /// point, and every triangle that can be nearest to one of the points is compared with all of
    /// them at once.
    pub(super) fn search_batch(&self, batch: &mut Batch, front: &Front, hint: u32, stack: &mut Stack) {
        search_batch(self, batch, front, hint, &mut stack.nodes);
    }

    /// The smallest subtrees that together hold every triangle within `radius_sq` of the region.
    pub(super) fn front(&self, region: &Bounds, radius_sq: f64, front: &mut Front) {
        let Front { subtrees, nodes } = front;
        subtrees.clear();
        subtrees.push((*region, Child::Node(0)));
        let mut place = 0;
        while place < subtrees.len() {
            let Child::Node(node) = subtrees[place].1 else {
                place += 1;
                continue;
            };
            let node = &self.nodes[node as usize];
            let distances_sq = node.box_distances_sq(region);
            let is_near = |&lane: &usize| distances_sq[lane] <= radius_sq;
            if subtrees.len() - 1 + (0..LANES).filter(is_near).count() > FRONT_LEN {
                place += 1;
                continue;
            }
            subtrees.swap_remove(place);
            subtrees.extend((0..LANES).filter(is_near).map(|lane| (node.bounds(lane), node.child(lane))));
        }
        nodes.clear();
        nodes.extend(subtrees.chunks(LANES).map(Node::of));
    }
}

/// [`TriangleTree::search_batch`], also compiled for wider vectors, which are used if the machine
/// has them. The operations and their order are the same, hence the bits too; the time is two
/// thirds.
#[multiversion(targets("x86_64+avx2"))]
fn search_batch(
    tree: &TriangleTree,
    batch: &mut Batch,
    front: &Front,
    hint: u32,
    stack: &mut Vec<(f64, u32)>,
) {
    batch.improve(&tree.prepared[hint as usize], hint);
    let region = *batch.region();
    stack.clear();
    let mut roots = front.nodes.iter();
    loop {
        let node = match stack.pop() {
            Some((distance_sq, _)) if distance_sq >= batch.reach_sq() => continue,
            Some((_, node)) => &tree.nodes[node as usize],
            None => match roots.next() {
                Some(root) => root,
                None => break,
            },
        };
        let distances_sq = node.box_distances_sq(&region);
        let bottom = stack.len();
        for lane in lanes_below(&distances_sq, batch.reach_sq()) {
            match node.child(lane) {
                Child::Node(child) => push_in_order(stack, bottom, (distances_sq[lane], child)),
                Child::Leaf { first, n_triangles } => {
                    for triangle in (first..first + n_triangles).filter(|&triangle| triangle != hint) {
                        batch.improve(&tree.prepared[triangle as usize], triangle);
                    }
                }
            }
        }
    }
}

/// The lanes whose distance is below a limit.
#[inline(always)]
fn lanes_below(distances_sq: &[f64; LANES], limit_sq: f64) -> impl Iterator<Item = usize> {
    let mut lanes =
        (0..LANES).fold(0u32, |lanes, lane| lanes | u32::from(distances_sq[lane] < limit_sq) << lane);
    std::iter::from_fn(move || {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

/// Pushes a node onto the part of the stack above `bottom`, which stays sorted with the nearest on
/// top.
#[inline(always)]
fn push_in_order(stack: &mut Vec<(f64, u32)>, bottom: usize, entry: (f64, u32)) {
    stack.push(entry);
    let mut place = stack.len() - 1;
    while place > bottom && stack[place - 1].0 < entry.0 {
        stack[place] = stack[place - 1];
        place -= 1;
    }
    stack[place] = entry;
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::distance::point_triangle_distance_sq;
    use crate::geometry::vector;
    use crate::measure::bvh;

    fn tree(triangles: &[Triangle]) -> TriangleTree {
        let (nodes, order) = bvh::build(triangles);
        TriangleTree::new(nodes, order.iter().map(|&t| triangles[t as usize]).collect())
    }

    fn brute_force(triangles: &[Triangle], corners: &[Vector]) -> f64 {
        let largest = |triangle: &Triangle| {
            corners.iter().map(|&corner| point_triangle_distance_sq(corner, triangle)).fold(0.0, f64::max)
        };
        triangles.iter().map(largest).fold(f64::INFINITY, f64::min).sqrt()
    }

    fn vector() -> impl Strategy<Value = Vector> {
        prop::array::uniform3(-1.0..1.0)
    }

    /// Small triangles all over a cube, and a few large ones.
    fn triangles() -> impl Strategy<Value = Vec<Triangle>> {
        let triangle =
            (vector(), vector(), vector(), prop_oneof![9 => Just(0.1), 1 => Just(1.0), 1 => Just(0.0)])
                .prop_map(|(a, b, c, size)| {
                    [a, b, c].map(|corner| vector::add(a, vector::scale(corner, size)))
                });
        prop::collection::vec(triangle, 1..150)
    }

    proptest! {
        #[test]
        fn searches_agree_with_brute_force(triangles in triangles(), corners in prop::array::uniform3(vector())) {
            let tree = tree(&triangles);
            let mut stack = Stack::default();
            let bound = tree.search(&corners, 0, &mut stack).distance_sq.sqrt();
            prop_assert!((bound - brute_force(&triangles, &corners)).abs() < 1e-12);
            let nearest = tree.search(&[corners[0]], 0, &mut stack).distance_sq.sqrt();
            prop_assert!((nearest - brute_force(&triangles, &corners[..1])).abs() < 1e-12);
        }

        #[test]
        fn batches_agree_with_brute_force(
            triangles in triangles(),
            tile in prop::array::uniform3(vector()),
            scale in prop_oneof![Just(1.0), Just(0.1), Just(0.001)],
            n_points in 0..40usize,
        ) {
            let tree = tree(&triangles);
            let tile = tile.map(|corner| vector::add(tile[0], vector::scale(corner, scale)));
            let point = |i: usize| {
                let [u, v] = [i * 7 % 11, i * 5 % 13].map(|k| k as f64 / 24.0);
                vector::add_scaled(vector::add_scaled(tile[0], u, vector::sub(tile[1], tile[0])), v, vector::sub(tile[2], tile[0]))
            };
            let mut points = (0..n_points).map(point);
            let (mut batch, mut front, mut stack) = (Batch::new(), Front::default(), Stack::default());
            batch.fill(&tile, &mut points);
            let region = *batch.region();
            let centre = vector::midpoint(region.low, region.high);
            let radius = brute_force(&triangles, &[centre]) + vector::length(vector::sub(region.high, centre));
            tree.front(&region, radius * radius * (1.0 + 1e-9), &mut front);
            tree.search_batch(&mut batch, &front, 0, &mut stack);
            for (point, distance_sq) in batch.samples() {
                prop_assert!((distance_sq.sqrt() - brute_force(&triangles, &[point])).abs() < 1e-12);
            }
            // A bound may miss triangles that are nearest to no point, but it is valid for its
            // triangle.
            for (corners, bound) in batch.quarters().map(|quarter| (quarter.corners, quarter.bound)) {
                let own = brute_force(&tree.triangles()[bound.triangle as usize..][..1], &corners);
                prop_assert!((bound.distance_sq.sqrt() - own).abs() < 1e-12);
            }
        }
    }
}
