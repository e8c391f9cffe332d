//! Moving the map from the star of a vertex to the filling of its hole.

use super::chains::{Chains, Portion};
use super::contents::Contents;
use super::location::Location;
use super::removal::Removal;
use super::route::{Destinations, Route};
use super::star::OUTSIDE;
use super::{Certified, NOT_ON_RIM, REACH};
use crate::bound::Replacement;
use crate::geometry::distance::point_segment_distance_sq;
use crate::mesh::{Hole, MAX_VALENCE};
use std::ops::ControlFlow;

/// Buffers of the transfer, one per thread.
#[derive(Clone, Debug, Default)]
pub struct Transfer {
    destinations: Destinations,
    route: Route,
    location: Location,
    /// Source vertices mapped into the hole.
    covered: Vec<u32>,
    /// A change while it is not known whether it is needed: most removals end above the limit.
    draft: Change,
}

/// What a removal changes in the map.
#[derive(Clone, Debug, Default)]
pub struct Change {
    /// Every vertex mapped into the hole, by label.
    pub(super) assignments: Vec<Assignment>,
    /// Every source edge that needs or needed a chain through the hole.
    pub(in crate::bound) chains: Vec<NewChain>,
    /// The new chains, one after another.
    pub(super) portions: Vec<Portion>,
    /// Labels of the filling's triangles and the edges that have portions there, by label.
    pub(super) through: Vec<(u8, u32)>,
}

/// A source vertex and where its image is from now on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Assignment {
    /// Index of its triangle in the filling.
    pub(super) label: u8,
    /// See [`Certified::rim_corner`].
    pub(super) rim_corner: u8,
    pub(super) vertex: u32,
}

/// A source edge that gets another chain.
#[derive(Clone, Copy, Debug)]
pub(in crate::bound) struct NewChain {
    pub(in crate::bound) edge: u32,
    /// Where the new one ends among the portions.
    pub(super) end: usize,
}

impl Transfer {
    /// What the removal changes, and the largest displacement; or a lower bound of that, above `limit`, alone.
    pub(super) fn change(
        &mut self,
        certified: &Certified,
        replacement: Replacement<'_>,
        limit: f64,
    ) -> Result<(f64, Change), f64> {
        let covered = self.gather(certified, replacement.hole);
        let removal = Removal { certified, replacement, covered: &covered };
        let mut draft = std::mem::take(&mut self.draft);
        draft.clear();
        let limit_sq = limit * limit;
        let largest_sq = self.walk(removal, [limit_sq, REACH * REACH * limit_sq], |edge, route| {
            route.shorten(removal);
            draft.add_chain(edge, route);
        });
        let found = largest_sq.sqrt();
        let result = if largest_sq > limit_sq {
            Err(found)
        } else {
            draft.assign(removal, &self.destinations);
            Ok((found, draft.in_order()))
        };
        self.draft = draft;
        self.covered = covered;
        result
    }

    /// The source vertices mapped into the star of `hole`, in the buffer for them, to be given back.
    fn gather(&mut self, certified: &Certified, hole: &Hole) -> Vec<u32> {
        let mut covered = std::mem::take(&mut self.covered);
        certified.gather(hole, &mut covered);
        covered
    }

    /// Gives every source edge that the removal moves its new chain and, as long as nothing is above the limit, shows it to `take`.
    /// Largest squared displacement inside the hole, or a lower bound of it above the limit: vertices come first, then the edges
    /// that have no chain yet, which are fewer than the others, and what is above the limit by then is not followed up.
    #[inline]
    fn walk(
        &mut self,
        removal: Removal<'_>,
        [limit_sq, reach_sq]: [f64; 2],
        mut take: impl FnMut(u32, &mut Route),
    ) -> f64 {
        let mut largest_sq = self.place_vertices(removal, [limit_sq, reach_sq]);
        if largest_sq > limit_sq {
            return largest_sq;
        }
        let Self { destinations, route, .. } = self;
        let mut go_on = |largest_sq: &mut f64, edge, found_sq, route: &mut Route| {
            *largest_sq = largest_sq.max(found_sq);
            if *largest_sq <= limit_sq {
                take(edge, route);
            }
            if *largest_sq <= reach_sq { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let _ = removal.try_each_split_edge(&destinations.labels, |edge, ends| {
            let found_sq = route.split(destinations, removal, ends);
            go_on(&mut largest_sq, edge, found_sq, route)
        });
        if largest_sq > limit_sq {
            return largest_sq;
        }
        let _ = removal.try_each_chained_edge(|met| match route.follow(destinations, removal, met) {
            Some(found_sq) => go_on(&mut largest_sq, met.edge, found_sq, route),
            None => ControlFlow::Continue(()),
        });
        largest_sq
    }

    /// Gives every vertex mapped into the hole a triangle of the filling; the largest squared displacement, or the
    /// first above `reach_sq`.
    fn place_vertices(&mut self, removal: Removal<'_>, [limit_sq, reach_sq]: [f64; 2]) -> f64 {
        let Removal { replacement: Replacement { surface, hole, filling }, covered, .. } = removal;
        let Destinations { tree, labels, star } = &mut self.destinations;
        tree.build(hole, filling);
        star.set(&hole.slots);
        labels.start(surface.n_vertices());
        self.location.build(hole, filling);
        let mut largest_sq = 0.0_f64;
        let mut before = 0;
        for &v in covered {
            let p = surface.origin(v);
            let (label, distance_sq) = match removal.rim_edge(v) {
                Some(i) => (tree.at_ring_edge(i), point_segment_distance_sq(p, removal.ring_edge(i))),
                None => {
                    let enough_sq = limit_sq.max(largest_sq);
                    // Most lie over the triangle that the one before them lies over.
                    match self.location.height_sq(before.into(), p) {
                        Some(height_sq) if height_sq <= enough_sq => (before, height_sq),
                        _ => removal.near(p, self.location.find(p, before.into()), enough_sq),
                    }
                }
            };
            labels.set(v, label);
            before = label;
            largest_sq = largest_sq.max(distance_sq);
            if largest_sq > reach_sq {
                break;
            }
        }
        largest_sq
    }
}

impl Change {
    /// Gives the source edges that the removal moves their new chains.
    pub(super) fn set_chains(&self, chains: &mut Chains) {
        let mut start = 0;
        for chain in &self.chains {
            chains.set(chain.edge, &self.portions[start..chain.end]);
            start = chain.end;
        }
    }

    /// Empties the slots of `hole` and fills those of its filling, and shows `take` each vertex with the slot it is mapped into.
    pub(super) fn fill_slots(
        &self,
        hole: &Hole,
        contents: &mut Contents,
        mut take: impl FnMut(Assignment, u32),
    ) {
        hole.slots.iter().for_each(|&slot| contents.clear(slot));
        let (mut assignments, mut through) = (self.assignments.as_slice(), self.through.as_slice());
        for (label, &slot) in (0..).zip(&hole.slots) {
            let vertices = take_while(&mut assignments, |assignment| assignment.label == label);
            let edges = take_while(&mut through, |&(through, _)| through == label);
            contents.fill(
                slot,
                vertices.iter().map(|assignment| assignment.vertex),
                edges.iter().map(|&(_, edge)| edge),
            );
            vertices.iter().for_each(|&assignment| take(assignment, slot));
        }
    }

    fn clear(&mut self) {
        self.assignments.clear();
        self.chains.clear();
        self.portions.clear();
        self.through.clear();
    }

    /// Adds where the vertices go.
    fn assign(&mut self, removal: Removal<'_>, destinations: &Destinations) {
        let assign = |&vertex: &u32| Assignment {
            vertex,
            label: destinations.labels.get(vertex).unwrap_or_default(),
            rim_corner: removal.new_rim(vertex).unwrap_or(NOT_ON_RIM),
        };
        self.assignments.extend(removal.covered.iter().map(assign));
    }

    /// A copy in order of the labels.
    fn in_order(&self) -> Self {
        Self {
            assignments: by_label(&self.assignments, |assignment| assignment.label),
            chains: self.chains.clone(),
            portions: self.portions.clone(),
            through: by_label(&self.through, |&(label, _)| label),
        }
    }

    fn add_chain(&mut self, edge: u32, route: &Route) {
        self.portions.extend_from_slice(&route.portions);
        self.chains.push(NewChain { edge, end: self.portions.len() });
        if route.portions.len() < 2 {
            return;
        }
        let mut seen = 0_u64;
        for &label in route.labels.iter().filter(|&&label| label != OUTSIDE) {
            if seen & (1 << label) == 0 {
                seen |= 1 << label;
                self.through.push((label, edge));
            }
        }
    }
}

/// The items in order of their labels, which are below [`MAX_VALENCE`], by counting.
fn by_label<T: Copy>(items: &[T], label: impl Fn(&T) -> u8) -> Vec<T> {
    let mut starts = [0; MAX_VALENCE + 1];
    let mut n_labels = 0;
    for item in items {
        let label = usize::from(label(item));
        starts[label + 1] += 1;
        n_labels = n_labels.max(label + 1);
    }
    for at in 1..n_labels {
        starts[at + 1] += starts[at];
    }
    let mut ordered = items.to_vec();
    for item in items {
        let start = &mut starts[usize::from(label(item))];
        ordered[*start] = *item;
        *start += 1;
    }
    ordered
}

/// Takes the leading ones off `rest`.
fn take_while<'a, T>(rest: &mut &'a [T], is_leading: impl Fn(&T) -> bool) -> &'a [T] {
    let n_leading = rest.iter().take_while(|&item| is_leading(item)).count();
    let (leading, others) = rest.split_at(n_leading);
    *rest = others;
    leading
}
