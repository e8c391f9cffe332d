//! Moving the map from the star of a vertex to the filling of its hole.

use super::NOT_ON_RIM;
use super::chains::Portion;
use super::dual_tree::{Crossing, DualTree};
use super::labels::Labels;
use super::removal::Removal;
use crate::bound::Replacement;
use crate::geometry::distance::{Segment, point_segment_distance_sq};
use crate::geometry::vector::{add_scaled, dot, length_sq, sub};

/// Buffers of the transfer, one per thread.
#[derive(Clone, Debug, Default)]
pub struct Transfer {
    tree: DualTree,
    labels: Labels,
    edges: Vec<u32>,
    old: Vec<Portion>,
    new: Vec<Portion>,
    path: Vec<Crossing>,
}

/// What a removal changes in the map.
#[derive(Clone, Debug)]
pub struct Change {
    /// The new triangle of every vertex mapped into the hole.
    pub(super) assignments: Vec<Assignment>,
    /// Every source edge that needs or needed a chain, and where its new one ends among the portions.
    pub(super) chains: Vec<(u32, usize)>,
    /// The new chains, one after another.
    pub(super) portions: Vec<Portion>,
}

/// A source vertex and where its image is from now on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Assignment {
    pub(super) vertex: u32,
    /// Index of its triangle in the filling.
    pub(super) label: u8,
    /// See [`Certified::rim_corner`].
    pub(super) rim_corner: u8,
}

/// One end of a part of a source edge that lies in the hole.
#[derive(Clone, Copy, Debug)]
enum End {
    /// In this triangle of the filling: a removed vertex, or a crossing of the ring edge there.
    In(u8),
    /// At this ring vertex, which every triangle around it may claim.
    At(u8),
}

impl Transfer {
    /// Largest displacement inside the hole, or the first one found above `limit`.
    pub(super) fn displacement(&mut self, removal: Removal<'_>, limit: f64) -> f64 {
        let limit_sq = limit * limit;
        let mut largest_sq = self.assign_vertices(removal, limit_sq);
        if largest_sq > limit_sq {
            return largest_sq.sqrt();
        }
        self.collect_edges(removal);
        for at in 0..self.edges.len() {
            largest_sq = largest_sq.max(self.reroute(removal, self.edges[at]));
            if largest_sq > limit_sq {
                break;
            }
        }
        largest_sq.sqrt()
    }

    /// What the removal changes. Right after [`Self::displacement`] of the same removal, whose labels and edges it uses.
    pub(super) fn change(&mut self, removal: Removal<'_>) -> Change {
        let edges = std::mem::take(&mut self.edges);
        let (mut chains, mut portions) = (Vec::with_capacity(edges.len()), vec![]);
        for &edge in &edges {
            self.reroute(removal, edge);
            removal.shorten(edge, &mut self.new);
            portions.extend_from_slice(&self.new);
            chains.push((edge, portions.len()));
        }
        self.edges = edges;
        let assign = |&vertex: &u32| Assignment {
            vertex,
            label: self.labels.get(vertex).unwrap_or_default(),
            rim_corner: removal.new_rim(vertex).unwrap_or(NOT_ON_RIM),
        };
        Change { assignments: removal.covered.vertices.iter().map(assign).collect(), chains, portions }
    }

    /// Gives every vertex mapped into the hole a triangle of the filling; the largest squared displacement, or the
    /// first above the limit.
    fn assign_vertices(&mut self, removal: Removal<'_>, limit_sq: f64) -> f64 {
        let Removal { replacement: Replacement { surface, hole, filling }, covered, .. } = removal;
        self.tree.build(hole, filling);
        self.labels.start(surface.n_vertices());
        let mut largest_sq = 0.0_f64;
        for (at, (&v, &p)) in covered.vertices.iter().zip(&covered.points).enumerate() {
            let (label, distance_sq) = match removal.rim_edge(v) {
                Some(i) => (self.tree.at_ring_edge(i), point_segment_distance_sq(p, removal.ring_edge(i))),
                None => removal.near(at, p, largest_sq),
            };
            self.labels.set(v, label);
            largest_sq = largest_sq.max(distance_sq);
            if largest_sq > limit_sq {
                break;
            }
        }
        largest_sq
    }

    /// Source edges whose chain, old or new, has more than one portion and passes through the hole; in ascending order.
    fn collect_edges(&mut self, removal: Removal<'_>) {
        let Removal { certified, replacement: Replacement { hole, .. }, covered } = removal;
        self.edges.clear();
        for &v in &covered.vertices {
            let Some(label) = self.labels.get(v) else { continue };
            for &edge in certified.source.at(v) {
                let [low, high] = certified.source.ends(edge);
                let other = low ^ high ^ v;
                let is_moved = match self.labels.get(other) {
                    _ if certified.chains.has(edge) => true,
                    Some(other_label) => v < other && other_label != label,
                    None => !removal.has_corner(label, other),
                };
                if is_moved {
                    self.edges.push(edge);
                }
            }
        }
        for &slot in &hole.slots {
            self.edges.extend(certified.chains.edges_through(slot));
        }
        self.edges.sort_unstable();
        self.edges.dedup();
    }

    /// Puts the new chain of `edge` into `self.new`; the largest squared displacement of a crossing that is new.
    fn reroute(&mut self, removal: Removal<'_>, edge: u32) -> f64 {
        let Removal { certified, replacement: Replacement { surface, hole, .. }, .. } = removal;
        let [low, high] = certified.source.ends(edge);
        let segment = [surface.origin(low), surface.origin(high)];
        self.old.clear();
        self.old.extend(certified.chains.of(edge));
        if self.old.is_empty() {
            self.old.push(Portion { slot: removal.only_slot(low, high), end: 1.0 });
        }
        self.new.clear();
        let mut largest_sq = 0.0_f64;
        let mut start = 0.0;
        let mut at = 0;
        while at < self.old.len() {
            let portion = self.old[at];
            if removal.star_index(portion.slot).is_none() {
                self.new.push(portion);
                start = portion.end;
                at += 1;
                continue;
            }
            let last =
                (at..self.old.len()).take_while(|&i| removal.star_index(self.old[i].slot).is_some()).last();
            let last = last.unwrap_or(at);
            let entry =
                if at == 0 { self.end_at(removal, low) } else { self.end_over(removal, portion.slot) };
            let is_last = last + 1 == self.old.len();
            let exit = if is_last {
                self.end_at(removal, high)
            } else {
                self.end_over(removal, self.old[last].slot)
            };
            let first = self.find_path(removal, entry, exit);
            let end = self.old[last].end;
            let mut into = first;
            for crossing in 0..self.path.len() {
                let Crossing { edge: [i, j], into: next } = self.path[crossing];
                let target = [hole.points[usize::from(i)], hole.points[usize::from(j)]];
                let (s, distance_sq) = cross_nearest(segment, start, end, target);
                self.new.push(Portion { slot: hole.slots[usize::from(into)], end: s });
                largest_sq = largest_sq.max(distance_sq);
                start = s;
                into = next;
            }
            self.new.push(Portion { slot: hole.slots[usize::from(into)], end });
            start = end;
            at = last + 1;
        }
        largest_sq
    }

    /// The end of a part at a source vertex.
    fn end_at(&self, removal: Removal<'_>, v: u32) -> End {
        match self.labels.get(v) {
            Some(label) => End::In(label),
            None => End::At(removal.ring_index(v)),
        }
    }

    /// The end of a part that comes over the ring edge of the star triangle in `slot`.
    fn end_over(&self, removal: Removal<'_>, slot: u32) -> End {
        End::In(self.tree.at_ring_edge(removal.star_index(slot).unwrap_or_default()))
    }

    /// Puts the path between two ends into `self.path` and returns the triangle it starts in. An end at a ring vertex
    /// is taken in the triangle around that vertex that makes the path shortest.
    fn find_path(&mut self, removal: Removal<'_>, entry: End, exit: End) -> u8 {
        let any_triangle = |end| match end {
            End::In(triangle) => triangle,
            End::At(corner) => self.tree.at_ring_vertex(corner),
        };
        let mut first = any_triangle(entry);
        self.path.clear();
        self.tree.path(first, any_triangle(exit), &mut self.path);
        if let End::At(corner) = entry {
            let n_turns = self.path.iter().take_while(|crossing| crossing.edge.contains(&corner)).count();
            if n_turns > 0 {
                first = self.path[n_turns - 1].into;
                self.path.drain(..n_turns);
            }
        }
        if let End::At(corner) = exit {
            let n_turns =
                self.path.iter().rev().take_while(|crossing| crossing.edge.contains(&corner)).count();
            self.path.truncate(self.path.len() - n_turns);
        }
        debug_assert!(usize::from(first) < removal.replacement.filling.triangles.len());
        first
    }
}

/// Where the source edge, between `start` and `end`, comes nearest to `target`, as a part of the edge, and the squared
/// distance there.
#[expect(
    clippy::cast_possible_truncation,
    reason = "any f32 between start and end will do, it is exact from then on"
)]
fn cross_nearest(segment: Segment, start: f32, end: f32, target: Segment) -> (f32, f64) {
    let s = nearest_parameter(segment, target) as f32;
    let s = if s.is_nan() { start } else { s.clamp(start, end) };
    let direction = sub(segment[1], segment[0]);
    let point = if s == 1.0 { segment[1] } else { add_scaled(segment[0], s.into(), direction) };
    (s, point_segment_distance_sq(point, target))
}

/// Parameter on the line of `first`, unclamped at best effort, at which it is nearest to `second`.
fn nearest_parameter([a, b]: Segment, [c, d]: Segment) -> f64 {
    let (u, v, w) = (sub(b, a), sub(d, c), sub(a, c));
    let (uu, uv, vv) = (length_sq(u), dot(u, v), length_sq(v));
    let (uw, vw) = (dot(u, w), dot(v, w));
    let determinant = uu * vv - uv * uv;
    let s =
        if determinant > 1e-12 * uu * vv { ((uv * vw - vv * uw) / determinant).clamp(0.0, 1.0) } else { 0.5 };
    let t = (uv * s + vw) / vv;
    if t < 0.0 {
        -uw / uu
    } else if t > 1.0 {
        (uv - uw) / uu
    } else {
        s
    }
}
