//! Moving the map from the star of a vertex to the filling of its hole.

use super::chains::Portion;
use super::dual_tree::{Crossing, DualTree};
use super::{Certified, NONE, NOT_ON_RIM};
use crate::bound::Replacement;
use crate::bound::covered::{Covered, Over};
use crate::geometry::distance::{Segment, point_segment_distance_sq, point_triangle_distance_sq};
use crate::geometry::vector::{Vector, add_scaled, dot, length_sq, sub};

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

/// The filling triangle of each source vertex that is mapped into the hole at hand.
#[derive(Clone, Debug, Default)]
struct Labels {
    stamped: Vec<u32>,
    stamp: u32,
}

/// Bits of a stamped label that hold the label; a filling has fewer than 64 triangles.
const LABEL_BITS: u32 = 6;

impl Labels {
    fn start(&mut self, n_vertices: usize) {
        self.stamp += 1;
        if self.stamped.len() != n_vertices || self.stamp >> (32 - LABEL_BITS) != 0 {
            self.stamped.clear();
            self.stamped.resize(n_vertices, 0);
            self.stamp = 1;
        }
    }

    fn set(&mut self, v: u32, label: u8) {
        self.stamped[v as usize] = self.stamp << LABEL_BITS | u32::from(label);
    }

    fn get(&self, v: u32) -> Option<u8> {
        let stamped = self.stamped[v as usize];
        (stamped >> LABEL_BITS == self.stamp).then_some((stamped & ((1 << LABEL_BITS) - 1)) as u8)
    }
}

/// One end of a part of a source edge that lies in the hole.
#[derive(Clone, Copy, Debug)]
enum End {
    /// In this triangle of the filling: a removed vertex, or a crossing of the ring edge there.
    In(u8),
    /// At this ring vertex, which every triangle around it may claim.
    At(u8),
}

/// A hole, its filling, and what the map is before the removal.
#[derive(Clone, Copy)]
pub(super) struct Removal<'a> {
    pub(super) certified: &'a Certified,
    pub(super) replacement: Replacement<'a>,
    pub(super) covered: &'a Covered,
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
        let segment = [surface.point(low), surface.point(high)];
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

impl Removal<'_> {
    /// Index in the star of the triangle in `slot`.
    fn star_index(&self, slot: u32) -> Option<usize> {
        self.replacement.hole.slots.iter().position(|&s| s == slot)
    }

    #[expect(clippy::cast_possible_truncation, reason = "ring indices stay below MAX_VALENCE + 1")]
    fn ring_index(&self, v: u32) -> u8 {
        let found = self.replacement.hole.ring.iter().position(|&r| r == v);
        debug_assert!(found.is_some(), "a source edge that ends in the hole ends at its ring");
        found.unwrap_or_default() as u8
    }

    /// The slot of an edge that is all in one triangle. Between two vertices that are alive it is a mesh edge, and in
    /// the hole only when it ends at the removed vertex.
    fn only_slot(&self, low: u32, high: u32) -> u32 {
        match [low, high].map(|v| self.certified.slot_of[v as usize]) {
            [NONE, NONE] => self.replacement.hole.slots[0],
            [NONE, slot] | [slot, _] => slot,
        }
    }

    /// A triangle near the covered vertex at index `at`, and its squared distance: the one that the vertex lies over
    /// where that is no farther than `enough_sq`, the nearest one otherwise.
    fn near(&self, at: usize, p: Vector, enough_sq: f64) -> (u8, f64) {
        let is_over = |&(_, &triangle): &(u8, &[u8; 3])| self.covered.is_over(at, Over::new(triangle));
        let candidates =
            if self.covered.has_sides() { self.replacement.filling.triangles.as_slice() } else { &[] };
        if let Some((label, _)) = (0..).zip(candidates).find(is_over) {
            let distance_sq = point_triangle_distance_sq(
                p,
                &self.replacement.filling.triangle(self.replacement.hole, label.into()),
            );
            if distance_sq <= enough_sq {
                return (label, distance_sq);
            }
        }
        self.nearest(p)
    }

    /// Whether the filling's triangle `label` has the corner `v`.
    fn has_corner(&self, label: u8, v: u32) -> bool {
        self.replacement.filling.corners(self.replacement.hole, label.into()).contains(&v)
    }

    fn nearest(&self, p: Vector) -> (u8, f64) {
        (0..)
            .zip(0..self.replacement.filling.triangles.len())
            .map(|(label, i)| {
                (
                    label,
                    point_triangle_distance_sq(
                        p,
                        &self.replacement.filling.triangle(self.replacement.hole, i),
                    ),
                )
            })
            .fold((0, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best })
    }

    /// End points of the ring edge after ring vertex `i`; for the last one of a chain, of the new boundary edge.
    fn ring_edge(&self, i: usize) -> Segment {
        [self.replacement.hole.points[i], self.replacement.hole.points[self.replacement.hole.next(i)]]
    }

    /// For a source vertex on the boundary: the ring edge that its boundary edge is, or becomes.
    fn rim_edge(&self, v: u32) -> Option<usize> {
        let hole = self.replacement.hole;
        let new_edge = hole.n_ring() - 1;
        if v == hole.removed {
            return (!hole.closed).then_some(new_edge);
        }
        let corner = self.certified.rim_corner[v as usize];
        if corner == NOT_ON_RIM {
            return None;
        }
        let slot = self.certified.slot_of[v as usize];
        let corners = self.replacement.surface.corners(slot);
        let (from, to) = (corners[usize::from(corner)], corners[(usize::from(corner) + 1) % 3]);
        let is_replaced = from == hole.removed || to == hole.removed;
        Some(if is_replaced { new_edge } else { self.star_index(slot).unwrap_or_default() })
    }

    /// The corner of its new triangle at which the boundary edge of `v` starts.
    fn new_rim(&self, v: u32) -> Option<u8> {
        let from = self.rim_edge(v)?;
        let to = self.replacement.hole.next(from);
        let runs = |&[a, b, c]: &[u8; 3]| {
            (0..)
                .zip([[a, b], [b, c], [c, a]])
                .find(|&(_, [i, j])| usize::from(i) == from && usize::from(j) == to)
        };
        self.replacement.filling.triangles.iter().find_map(runs).map(|(corner, _)| corner)
    }

    /// Takes out what a chain does not need: going over an edge and straight back, and turning about a vertex that is
    /// its own image.
    fn shorten(&self, edge: u32, portions: &mut Vec<Portion>) {
        let [low, high] = self.certified.source.ends(edge);
        let mut kept = 0;
        for at in 0..portions.len() {
            let portion = portions[at];
            if kept >= 2 && portions[kept - 2].slot == portion.slot {
                kept -= 1;
                portions[kept - 1].end = portion.end;
            } else if kept >= 1 && portions[kept - 1].slot == portion.slot {
                portions[kept - 1].end = portion.end;
            } else if kept == 1
                && self.stays(low)
                && self.touches(portions[0].slot, low)
                && self.touches(portion.slot, low)
            {
                portions[0] = portion;
            } else {
                portions[kept] = portion;
                kept += 1;
            }
        }
        while kept >= 2
            && self.stays(high)
            && self.touches(portions[kept - 1].slot, high)
            && self.touches(portions[kept - 2].slot, high)
        {
            kept -= 1;
            portions[kept - 1].end = 1.0;
        }
        portions.truncate(kept);
    }

    fn stays(&self, v: u32) -> bool {
        v != self.replacement.hole.removed && self.certified.is_alive(v)
    }

    /// Whether the triangle in `slot`, after the removal, has the corner `v`.
    fn touches(&self, slot: u32, v: u32) -> bool {
        match self.star_index(slot) {
            Some(i) if i < self.replacement.filling.triangles.len() => {
                self.replacement.filling.corners(self.replacement.hole, i).contains(&v)
            }
            Some(_) => false,
            None => self.replacement.surface.corners(slot).contains(&v),
        }
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
