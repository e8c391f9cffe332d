//! The way of a source edge through a hole that has been filled.

use super::Certified;
use super::chains::Portion;
use super::dual_tree::{Crossing, DualTree};
use super::labels::Labels;
use super::removal::Removal;
use super::star::{OUTSIDE, Star};
use crate::geometry::distance::{Segment, point_segment_distance_sq};
use crate::geometry::vector::{Vector, add_scaled, dot, length_sq, sub};

/// Where the vertices of a hole have gone.
#[derive(Clone, Debug, Default)]
pub(super) struct Destinations {
    /// The filling's dual tree.
    pub(super) tree: DualTree,
    /// The filling's triangle for each vertex mapped into the hole.
    pub(super) labels: Labels,
    /// The star that the filling replaces.
    pub(super) star: Star,
}

/// The new chain of one edge at a time.
#[derive(Clone, Debug, Default)]
pub(super) struct Route {
    /// The edge's ends, the lower one first.
    ends: [u32; 2],
    /// Its portions.
    pub(super) portions: Vec<Portion>,
    /// For each of them the filling's triangle, or [`OUTSIDE`].
    pub(super) labels: Vec<u8>,
    /// For each portion of the old chain its triangle in the star, or [`OUTSIDE`].
    old_labels: Vec<u8>,
    path: Vec<Crossing>,
}

/// A source edge with a chain, met in a triangle of the star.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub(super) edge: u32,
    /// Index of the triangle in the star.
    pub(super) at: u8,
}

/// One end of a part of a source edge that lies in the hole.
#[derive(Clone, Copy, Debug)]
enum End {
    /// In this triangle of the filling: a removed vertex, or a crossing of the ring edge there.
    In(u8),
    /// At this ring vertex, which every triangle around it may claim.
    At(u8),
}

/// A part of a source edge that enters the hole and leaves it again.
#[derive(Clone, Copy, Debug)]
struct Part {
    entry: End,
    exit: End,
    /// Where it begins and ends, as parts of the edge.
    start: f32,
    end: f32,
}

impl Destinations {
    /// The end of a part at a source vertex.
    fn end_at(&self, removal: Removal<'_>, v: u32) -> End {
        match self.labels.get(v) {
            Some(label) => End::In(label),
            None => End::At(removal.ring_index(v)),
        }
    }

    /// The end of a part that comes over the ring edge of the star's triangle `i`.
    fn end_over(&self, i: u8) -> End {
        End::In(self.tree.at_ring_edge(i.into()))
    }
}

impl Route {
    /// Makes this the new chain of the edge met; the largest squared displacement of a crossing that is new. Nothing where the edge
    /// does not first come into the star here: it is met elsewhere, or its chain has left the star.
    pub(super) fn follow(
        &mut self,
        destinations: &Destinations,
        removal: Removal<'_>,
        met: Met,
    ) -> Option<f64> {
        let Met { edge, at: here } = met;
        let Certified { source, chains, .. } = removal.certified;
        let old = chains.of(edge);
        let mut labels = old.iter().map(|portion| destinations.star.label(portion.slot));
        let n_before = labels.by_ref().position(|label| label != OUTSIDE)?;
        if old[n_before].slot != removal.replacement.hole.slots[usize::from(here)] {
            return None;
        }
        self.old_labels.clear();
        self.old_labels.resize(n_before, OUTSIDE);
        self.old_labels.push(here);
        self.old_labels.extend(labels);
        let ends = source.ends(edge);
        self.ends = ends;
        let segment = ends.map(|v| removal.replacement.surface.origin(v));
        self.portions.clear();
        self.labels.clear();
        let mut largest_sq = 0.0_f64;
        let mut start = 0.0;
        let mut at = 0;
        while at < old.len() {
            let first = self.old_labels[at];
            if first == OUTSIDE {
                self.push(old[at], OUTSIDE);
                start = old[at].end;
                at += 1;
                continue;
            }
            let entry =
                if at == 0 { destinations.end_at(removal, ends[0]) } else { destinations.end_over(first) };
            while self.old_labels.get(at + 1).is_some_and(|&label| label != OUTSIDE) {
                at += 1;
            }
            let is_last = at + 1 == old.len();
            let exit = if is_last {
                destinations.end_at(removal, ends[1])
            } else {
                destinations.end_over(self.old_labels[at])
            };
            let end = old[at].end;
            largest_sq =
                largest_sq.max(self.cross(destinations, removal, segment, Part { entry, exit, start, end }));
            start = end;
            at += 1;
        }
        Some(largest_sq)
    }

    /// Makes this the chain of the edge with the given ends, which had none and lies in the hole; the largest squared displacement of
    /// a crossing.
    pub(super) fn split(&mut self, destinations: &Destinations, removal: Removal<'_>, ends: [u32; 2]) -> f64 {
        self.ends = ends;
        let segment = ends.map(|v| removal.replacement.surface.origin(v));
        self.portions.clear();
        self.labels.clear();
        let [entry, exit] = ends.map(|v| destinations.end_at(removal, v));
        self.cross(destinations, removal, segment, Part { entry, exit, start: 0.0, end: 1.0 })
    }

    /// Takes out what the chain does not need: going over an edge and straight back, and turning about a vertex that is
    /// its own image.
    pub(super) fn shorten(&mut self, removal: Removal<'_>) {
        let &mut Self { ends: [low, high], ref mut portions, ref mut labels, .. } = self;
        let touches = |portion: Portion, label, v| removal.touches(portion.slot, label, v);
        let mut kept = 0;
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

    /// Appends the portions of one part; the largest squared displacement of its crossings.
    fn cross(
        &mut self,
        destinations: &Destinations,
        removal: Removal<'_>,
        segment: Segment,
        part: Part,
    ) -> f64 {
        let hole = removal.replacement.hole;
        let mut into = self.find_path(&destinations.tree, part.entry, part.exit);
        let mut start = part.start;
        let mut largest_sq = 0.0_f64;
        for &Crossing { edge: [i, j], into: next } in &self.path {
            let target = [hole.points[usize::from(i)], hole.points[usize::from(j)]];
            let (s, distance_sq) = cross_nearest(segment, start, part.end, target);
            self.portions.push(Portion { slot: hole.slots[usize::from(into)], end: s });
            self.labels.push(into);
            largest_sq = largest_sq.max(distance_sq);
            start = s;
            into = next;
        }
        self.push(Portion { slot: hole.slots[usize::from(into)], end: part.end }, into);
        largest_sq
    }

    /// Puts the path between two ends into `self.path` and returns the triangle it starts in. An end at a ring vertex
    /// is taken in the triangle around that vertex that makes the path shortest.
    fn find_path(&mut self, tree: &DualTree, entry: End, exit: End) -> u8 {
        let any_triangle = |end| match end {
            End::In(triangle) => triangle,
            End::At(corner) => tree.at_ring_vertex(corner),
        };
        let mut first = any_triangle(entry);
        self.path.clear();
        tree.path(first, any_triangle(exit), &mut self.path);
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
    (s, point_segment_distance_sq(point_at(segment, s), target))
}

/// The point of a source edge where a portion ends.
pub(super) fn point_at([low, high]: Segment, end: f32) -> Vector {
    if end == 1.0 { high } else { add_scaled(low, end.into(), sub(high, low)) }
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
