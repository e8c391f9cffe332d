//! A bounding-volume hierarchy over triangles, with four boxes per node, in flat arrays.
//!
//! The usual tree has two children per node and a pointer to each. Four children need half the
//! levels, and their boxes lie lane by lane so that one pass of vector instructions measures all
//! four. Splits are chosen by the surface area heuristic over bins of centroids (Wald, *On fast
//! Construction of SAH-based Bounding Volume Hierarchies*, RT 2007). The tree grows level by level,
//! all nodes of a level in parallel, so no recursion depends on the input and the result does not
//! depend on the number of threads.

use rayon::prelude::*;

use crate::geometry::bounds::Bounds;
use crate::geometry::distance::Triangle;
use crate::geometry::prepared::larger;
use crate::geometry::vector::{self, Vector};

/// Children of a node.
pub(super) const LANES: usize = 4;

/// Most triangles of a leaf.
const LEAF_LEN: usize = 1;

/// Slices that a range of centroids is cut into when a split is chosen.
const N_BINS: usize = 16;

/// Up to four children with their boxes. A lane without a child has the empty box, infinitely far
/// from everything.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Lower corners, by axis and lane.
    low: [[f64; LANES]; 3],
    /// Upper corners, by axis and lane.
    high: [[f64; LANES]; 3],
    /// First triangle of a leaf, or index of the child node.
    first: [u32; LANES],
    /// Triangles of a leaf; 0 for a child node and for a lane without a child.
    n_triangles: [u32; LANES],
}

/// The child in one lane of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Child {
    /// Another node, by its index.
    Node(u32),
    /// Triangles `first .. first + n_triangles`, in the tree's order.
    Leaf {
        /// The first of them.
        first: u32,
        /// How many, at least 1.
        n_triangles: u32,
    },
}

/// A triangle on its way into a leaf.
#[derive(Clone, Copy)]
struct BoxedTriangle {
    bounds: Bounds,
    id: u32,
}

impl Node {
    const EMPTY: Self = Self {
        low: [[f64::INFINITY; LANES]; 3],
        high: [[f64::NEG_INFINITY; LANES]; 3],
        first: [0; LANES],
        n_triangles: [0; LANES],
    };

    /// The child in a lane that has one: the caller has found its distance finite.
    #[inline(always)]
    pub(super) fn child(&self, lane: usize) -> Child {
        match self.n_triangles[lane] {
            0 => Child::Node(self.first[lane]),
            n_triangles => Child::Leaf { first: self.first[lane], n_triangles },
        }
    }

    /// Squared distances from a point to the boxes; infinite for a lane without a child.
    #[inline(always)]
    pub(super) fn point_distances_sq(&self, p: Vector) -> [f64; LANES] {
        self.box_distances_sq(&Bounds { low: p, high: p })
    }

    /// Squared distances from a box to the boxes; infinite for a lane without a child.
    #[inline(always)]
    pub(super) fn box_distances_sq(&self, bounds: &Bounds) -> [f64; LANES] {
        let mut sums = [0.0; LANES];
        for axis in 0..3 {
            for (lane, sum) in sums.iter_mut().enumerate() {
                let below = self.low[axis][lane] - bounds.high[axis];
                let above = bounds.low[axis] - self.high[axis][lane];
                let outside = larger(larger(below, above), 0.0);
                *sum += outside * outside;
            }
        }
        sums
    }

    /// A node above up to four children.
    pub(super) fn of(children: &[(Bounds, Child)]) -> Self {
        let mut node = Self::EMPTY;
        for (lane, (bounds, child)) in children.iter().enumerate() {
            node.set_bounds(lane, bounds);
            (node.first[lane], node.n_triangles[lane]) = match *child {
                Child::Node(child) => (child, 0),
                Child::Leaf { first, n_triangles } => (first, n_triangles),
            };
        }
        node
    }

    /// The box of a lane.
    pub(super) fn bounds(&self, lane: usize) -> Bounds {
        Bounds { low: self.low.map(|lanes| lanes[lane]), high: self.high.map(|lanes| lanes[lane]) }
    }

    fn set_bounds(&mut self, lane: usize, bounds: &Bounds) {
        for axis in 0..3 {
            self.low[axis][lane] = bounds.low[axis];
            self.high[axis][lane] = bounds.high[axis];
        }
    }
}

/// Builds the tree over `triangles`, at least one. Returns its nodes, the root first, and the order
/// in which its leaves count the triangles: `order[i]` is the place in `triangles` of what a leaf
/// calls `i`.
///
/// `O(n log n)` for any mesh that is not an exponential spiral; each level is built in parallel.
pub(super) fn build(triangles: &[Triangle]) -> (Vec<Node>, Vec<u32>) {
    let mut primitives: Vec<BoxedTriangle> = triangles
        .par_iter()
        .zip(0..u32::MAX)
        .map(|(triangle, id)| BoxedTriangle { bounds: Bounds::around(*triangle), id })
        .collect();
    let mut nodes = Vec::new();
    let mut pending: Vec<(u32, &mut [BoxedTriangle])> = vec![(0, &mut primitives)];
    while !pending.is_empty() {
        let level: Vec<(Node, Vec<SubRange<'_>>)> =
            pending.into_par_iter().with_min_len(16).map(|(first, slice)| build_node(first, slice)).collect();
        let n_built = nodes.len() + level.len();
        pending = Vec::new();
        for (mut node, parts) in level {
            for part in parts {
                node.first[part.lane] = narrow(n_built + pending.len());
                pending.push((part.first, part.primitives));
            }
            nodes.push(node);
        }
    }
    (nodes, primitives.iter().map(|primitive| primitive.id).collect())
}

/// A child node that is still to be built.
struct SubRange<'a> {
    lane: usize,
    first: u32,
    primitives: &'a mut [BoxedTriangle],
}

/// Splits the triangles from `first` on in four, as evenly as their areas allow. Returns the node
/// with its leaves complete, and the parts whose nodes must still be built.
fn build_node(first: u32, primitives: &mut [BoxedTriangle]) -> (Node, Vec<SubRange<'_>>) {
    let mut node = Node::EMPTY;
    let mut parts = Vec::with_capacity(LANES);
    let mut first = first;
    let mut lane = 0;
    let (left, right) = split(primitives);
    let ((a, b), (c, d)) = if left.len() + right.len() > 8192 {
        rayon::join(|| split(left), || split(right))
    } else {
        (split(left), split(right))
    };
    for primitives in [a, b, c, d] {
        if primitives.is_empty() {
            continue;
        }
        let n = narrow(primitives.len());
        let bounds = primitives.iter().fold(Bounds::EMPTY, |bounds, other| bounds.union(&other.bounds));
        node.set_bounds(lane, &bounds);
        if primitives.len() <= LEAF_LEN {
            (node.first[lane], node.n_triangles[lane]) = (first, n);
        } else {
            parts.push(SubRange { lane, first, primitives });
        }
        first += n;
        lane += 1;
    }
    (node, parts)
}

/// Reorders the triangles and cuts them in two where the surface area heuristic is least. A range
/// that fits a leaf stays whole, with nothing on the right.
fn split(primitives: &mut [BoxedTriangle]) -> (&mut [BoxedTriangle], &mut [BoxedTriangle]) {
    if primitives.len() <= LEAF_LEN {
        return (primitives, &mut []);
    }
    let centres = primitives.iter().fold(Bounds::EMPTY, |bounds, primitive| {
        let centre = primitive.bounds.center_twice();
        bounds.union(&Bounds { low: centre, high: centre })
    });
    let extent = vector::sub(centres.high, centres.low);
    let axis = (0..3).fold(0, |widest, axis| if extent[axis] > extent[widest] { axis } else { widest });
    let middle = primitives.len() / 2;
    if extent[axis] <= 0.0 {
        return primitives.split_at_mut(middle);
    }
    let bin_of = |primitive: &BoxedTriangle| {
        let offset = primitive.bounds.low[axis] + primitive.bounds.high[axis] - centres.low[axis];
        truncate(offset / extent[axis] * N_BINS as f64).min(N_BINS - 1)
    };
    let cut = cheapest_cut(primitives, bin_of);
    let n_left = partition(primitives, |primitive| bin_of(primitive) < cut);
    // The first and the last bin hold the extreme centroids, so neither side is empty unless the
    // bins underflow.
    let n_left = if n_left == 0 || n_left == primitives.len() { middle } else { n_left };
    primitives.split_at_mut(n_left)
}

/// The bin, from 1 on, before which a cut gives the least sum of area times count.
fn cheapest_cut(primitives: &[BoxedTriangle], bin_of: impl Fn(&BoxedTriangle) -> usize) -> usize {
    let mut bins = [(Bounds::EMPTY, 0usize); N_BINS];
    for primitive in primitives {
        let (bounds, count) = &mut bins[bin_of(primitive)];
        *bounds = bounds.union(&primitive.bounds);
        *count += 1;
    }
    let mut costs = [0.0; N_BINS];
    let mut accumulate = |order: &mut dyn Iterator<Item = usize>, after: usize| {
        let (mut bounds, mut count) = (Bounds::EMPTY, 0usize);
        for bin in order {
            bounds = bounds.union(&bins[bin].0);
            count += bins[bin].1;
            if let Some(cost) = costs.get_mut(bin + after) {
                *cost += bounds.half_area() * count as f64;
            }
        }
    };
    accumulate(&mut (0..N_BINS), 1);
    accumulate(&mut (0..N_BINS).rev(), 0);
    (1..N_BINS).fold(1, |best, cut| if costs[cut] < costs[best] { cut } else { best })
}

/// Moves the elements that satisfy `is_left` to the front and returns their number.
fn partition(primitives: &mut [BoxedTriangle], is_left: impl Fn(&BoxedTriangle) -> bool) -> usize {
    let mut n_left = 0;
    for i in 0..primitives.len() {
        if is_left(&primitives[i]) {
            primitives.swap(i, n_left);
            n_left += 1;
        }
    }
    n_left
}

#[expect(clippy::cast_possible_truncation, reason = "triangles are counted in u32, and nodes are fewer")]
fn narrow(index: usize) -> u32 {
    index as u32
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the argument is within 0 and the number of bins, up to rounding"
)]
fn truncate(position: f64) -> usize {
    position as usize
}

/// Panics unless the boxes contain everything below them and the leaves hold each of `triangles`
/// once.
#[cfg(test)]
pub(super) fn check_tree(nodes: &[Node], triangles: &[Triangle]) {
    let mut n_seen = vec![0u32; triangles.len()];
    let mut reached = vec![0u32; nodes.len()];
    reached[0] = 1;
    for node in nodes {
        for lane in (0..LANES).filter(|&lane| node.low[0][lane] <= node.high[0][lane]) {
            let bounds = node.bounds(lane);
            let below = match node.child(lane) {
                Child::Node(child) => {
                    reached[child as usize] += 1;
                    let child = &nodes[child as usize];
                    Bounds {
                        low: child.low.map(|lanes| lanes.into_iter().fold(f64::INFINITY, f64::min)),
                        high: child.high.map(|lanes| lanes.into_iter().fold(f64::NEG_INFINITY, f64::max)),
                    }
                }
                Child::Leaf { first, n_triangles } => {
                    let range = first as usize..(first + n_triangles) as usize;
                    n_seen[range.clone()].iter_mut().for_each(|count| *count += 1);
                    Bounds::around(triangles[range].concat())
                }
            };
            assert_eq!(bounds, below);
        }
    }
    assert!(n_seen.iter().all(|&count| count == 1), "a triangle is missing or doubled");
    assert!(reached.iter().all(|&count| count == 1), "a node is missing or doubled");
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn check(triangles: &[Triangle]) {
        let (nodes, order) = build(triangles);
        let ordered: Vec<Triangle> = order.iter().map(|&t| triangles[t as usize]).collect();
        check_tree(&nodes, &ordered);
    }

    #[test]
    fn few_and_equal_triangles() {
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
        for n in [1, 2, 3, 4, 5, 7, 100] {
            check(&vec![triangle; n]);
        }
    }

    #[test]
    fn sizes_of_every_magnitude() {
        let triangles: Vec<Triangle> = (-120..120)
            .map(|exponent| {
                let x = 2f64.powi(exponent);
                [[x, 0.0, 0.0], [2.0 * x, x, 0.0], [2.0 * x, 0.0, x]]
            })
            .collect();
        check(&triangles);
    }

    proptest! {
        #[test]
        fn the_tree_holds_every_triangle_once(
            triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-1.0..1.0)), 1..200),
        ) {
            check(&triangles);
        }
    }
}
