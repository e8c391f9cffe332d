//! The way of a source edge through a hole that has been filled.

use super::chains::Portion;
use super::change::Assignment;
use super::dual_tree::{Crossing, DualTree};
use super::labels::Labels;
use super::removal::{ChainInStar, Removal};
use super::star::{OUTSIDE, StarIndex};
use super::{Certified, NOT_ON_RIM};
use crate::geometry::distance::{Segment, nearest_parameter, point_segment_distance_sq};
use crate::geometry::vector::{Vector, add_scaled, sub};

/// A hole in the middle of its filling: which triangle of the star, and which of the filling.
#[derive(Clone, Debug, Default)]
pub(super) struct HoleMap {
    /// The filling's dual tree.
    pub(super) tree: DualTree,
    /// The filling's triangle for each vertex mapped into the hole.
    pub(super) labels: Labels,
    /// The star that the filling replaces.
    pub(super) star: StarIndex,
}

/// The new chain of one edge at a time.
#[derive(Clone, Debug, Default)]
pub(super) struct Route {
    /// The edge's ends, the lower one first.
    ends: [u32; 2],
    /// Their places in the input.
    segment: Segment,
    /// Its portions.
    pub(super) portions: Vec<Portion>,
    /// For each of them the filling's triangle, or [`OUTSIDE`].
    pub(super) labels: Vec<u8>,
    /// For each portion of the old chain its triangle in the star, or [`OUTSIDE`].
    old_labels: Vec<u8>,
    path: Vec<Crossing>,
}

/// Where a source edge enters or leaves the hole, or begins or ends in it.
#[derive(Clone, Copy, Debug)]
enum SpanEnd {
    /// In this triangle of the filling: at a removed vertex, or over the ring edge there.
    InTriangle(u8),
    /// At this ring vertex, which every triangle around it may claim.
    AtRingVertex(u8),
}

/// The stretch of a source edge from where it enters the hole to where it leaves it again.
#[derive(Clone, Copy, Debug)]
struct HoleSpan {
    entry: SpanEnd,
    exit: SpanEnd,
    /// Where it begins and ends, as parts of the edge.
    start: f32,
    end: f32,
}

impl HoleMap {
    /// The end of a span at a source vertex.
    fn end_at(&self, removal: Removal<'_>, v: u32) -> SpanEnd {
        match self.labels.get(v) {
            Some(label) => SpanEnd::InTriangle(label),
            None => SpanEnd::AtRingVertex(removal.ring_index(v)),
        }
    }

    /// The end of a span that comes over the ring edge of the star's triangle `i`.
    fn end_over(&self, i: u8) -> SpanEnd {
        SpanEnd::InTriangle(self.tree.at_ring_edge(i.into()))
    }

    /// Where the image of a covered vertex is from now on.
    pub(super) fn assign(&self, removal: Removal<'_>, vertex: u32) -> Assignment {
        Assignment {
            vertex,
            label: self.labels.get(vertex).unwrap_or_default(),
            rim_corner: removal.new_rim(vertex).unwrap_or(NOT_ON_RIM),
        }
    }
}

impl Route {
    /// Makes this the new chain of an edge found in the star, and returns the largest squared
    /// displacement of its new crossings. `None` if the edge enters the star in another triangle,
    /// where it is found as well, or if its chain has left the star.
    pub(super) fn follow(
        &mut self,
        hole_map: &HoleMap,
        removal: Removal<'_>,
        ChainInStar { edge, at: here }: ChainInStar,
    ) -> Option<f64> {
        let Certified { source, chains, .. } = removal.certified;
        let old = chains.of(edge);
        // Contents may list an edge in several triangles of the star, and in one that its chain has
        // left. Only the first triangle that the chain runs through follows it, so each is followed
        // once.
        let mut labels = old.iter().map(|portion| hole_map.star.label(portion.slot));
        let n_before = labels.by_ref().position(|label| label != OUTSIDE)?;
        if old[n_before].slot != removal.replacement.hole.slots[usize::from(here)] {
            return None;
        }
        self.old_labels.clear();
        self.old_labels.resize(n_before, OUTSIDE);
        self.old_labels.push(here);
        self.old_labels.extend(labels);
        self.start(removal, source.ends(edge));
        let mut largest_sq = 0.0_f64;
        let (mut start, mut at) = (0.0, 0);
        while at < old.len() {
            let first = self.old_labels[at];
            if first == OUTSIDE {
                // What lies outside stays as it is.
                self.push(old[at], OUTSIDE);
                start = old[at].end;
                at += 1;
                continue;
            }
            // A run of portions in the star is one span of the hole. Its ends keep their places:
            // they are crossings of ring edges, which stay, or ends of the edge.
            let n_inside = self.old_labels[at..].iter().take_while(|&&label| label != OUTSIDE).count();
            let last = at + n_inside - 1;
            let entry =
                if at == 0 { hole_map.end_at(removal, self.ends[0]) } else { hole_map.end_over(first) };
            let exit = if last + 1 == old.len() {
                hole_map.end_at(removal, self.ends[1])
            } else {
                hole_map.end_over(self.old_labels[last])
            };
            // In between it takes the one path through the filling's dual tree, whatever it did in
            // the star.
            let end = old[last].end;
            let span = HoleSpan { entry, exit, start, end };
            largest_sq = largest_sq.max(self.cross(&hole_map.tree, removal, span));
            start = end;
            at = last + 1;
        }
        Some(largest_sq)
    }

    /// Makes this the chain of the edge with the given ends, which had none and lies in the hole;
    /// returns the largest squared displacement of a crossing.
    pub(super) fn split(&mut self, hole_map: &HoleMap, removal: Removal<'_>, ends: [u32; 2]) -> f64 {
        self.start(removal, ends);
        let [entry, exit] = ends.map(|v| hole_map.end_at(removal, v));
        self.cross(&hole_map.tree, removal, HoleSpan { entry, exit, start: 0.0, end: 1.0 })
    }

    /// Begins the chain of the edge with the given ends.
    fn start(&mut self, removal: Removal<'_>, ends: [u32; 2]) {
        self.ends = ends;
        self.segment = ends.map(|v| removal.replacement.surface.origin(v));
        self.portions.clear();
        self.labels.clear();
    }

    /// Takes out what the chain does not need: going over an edge and straight back, and turning
    /// about a vertex that is its own image.
    pub(super) fn shorten(&mut self, removal: Removal<'_>) {
        let &mut Self { ends: [low, high], ref mut portions, ref mut labels, .. } = self;
        let touches = |portion: Portion, label, v| removal.touches(portion.slot, label, v);
        let mut kept = 0;
        // Like a stack of brackets: a portion that returns to the triangle before the last takes
        // the last one with it.
        for at in 0..portions.len() {
            let (portion, label) = (portions[at], labels[at]);
            if kept >= 2 && portions[kept - 2].slot == portion.slot {
                kept -= 1;
                portions[kept - 1].end = portion.end;
            } else if kept >= 1 && portions[kept - 1].slot == portion.slot {
                portions[kept - 1].end = portion.end;
            } else if kept == 1
                && removal.stays(low)
                && touches(portions[0], labels[0], low)
                && touches(portion, label, low)
            {
                (portions[0], labels[0]) = (portion, label);
            } else {
                (portions[kept], labels[kept]) = (portion, label);
                kept += 1;
            }
        }
        while kept >= 2
            && removal.stays(high)
            && touches(portions[kept - 1], labels[kept - 1], high)
            && touches(portions[kept - 2], labels[kept - 2], high)
        {
            kept -= 1;
            portions[kept - 1].end = 1.0;
        }
        portions.truncate(kept);
        labels.truncate(kept);
    }

    fn push(&mut self, portion: Portion, label: u8) {
        self.portions.push(portion);
        self.labels.push(label);
    }

    /// Appends the portions of one span; returns the largest squared displacement of its crossings.
    fn cross(&mut self, tree: &DualTree, removal: Removal<'_>, span: HoleSpan) -> f64 {
        let hole = removal.replacement.hole;
        let mut into = self.find_path(tree, span.entry, span.exit);
        let mut start = span.start;
        let mut largest_sq = 0.0_f64;
        for &Crossing { edge: [i, j], into: next } in &self.path {
            let target = [hole.points[usize::from(i)], hole.points[usize::from(j)]];
            let (s, distance_sq) = cross_nearest(self.segment, start, span.end, target);
            self.portions.push(Portion { slot: hole.slots[usize::from(into)], end: s });
            self.labels.push(into);
            largest_sq = largest_sq.max(distance_sq);
            start = s;
            into = next;
        }
        self.push(Portion { slot: hole.slots[usize::from(into)], end: span.end }, into);
        largest_sq
    }

    /// Puts the path between two ends into `self.path` and returns the triangle it starts in. An
    /// end at a ring vertex is taken in the triangle around that vertex that makes the path
    /// shortest.
    fn find_path(&mut self, tree: &DualTree, entry: SpanEnd, exit: SpanEnd) -> u8 {
        let any_triangle = |end| match end {
            SpanEnd::InTriangle(triangle) => triangle,
            SpanEnd::AtRingVertex(corner) => tree.at_ring_vertex(corner),
        };
        let mut first = any_triangle(entry);
        self.path.clear();
        tree.path(first, any_triangle(exit), &mut self.path);
        if let SpanEnd::AtRingVertex(corner) = entry {
            let n_turns = self.path.iter().take_while(|crossing| crossing.edge.contains(&corner)).count();
            if n_turns > 0 {
                first = self.path[n_turns - 1].into;
                self.path.drain(..n_turns);
            }
        }
        if let SpanEnd::AtRingVertex(corner) = exit {
            let n_turns =
                self.path.iter().rev().take_while(|crossing| crossing.edge.contains(&corner)).count();
            self.path.truncate(self.path.len() - n_turns);
        }
        first
    }
}

/// Where the source edge, between `start` and `end`, comes nearest to `target`, as a part of the
/// edge, and the squared distance there.
#[expect(
    clippy::cast_possible_truncation,
    reason = "any f32 between start and end will do, it is exact from then on"
)]
fn cross_nearest(segment: Segment, start: f32, end: f32, target: Segment) -> (f32, f64) {
    let s = nearest_parameter(segment, target) as f32;
    let s = if s.is_nan() { start } else { s.clamp(start, end) };
    (s, point_segment_distance_sq(point_at(segment, s), target))
}

/// The point of a source edge where a portion ends.
pub(super) fn point_at([low, high]: Segment, end: f32) -> Vector {
    if end == 1.0 { high } else { add_scaled(low, end.into(), sub(high, low)) }
}
