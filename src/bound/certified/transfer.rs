//! Moving the map from the star of a vertex to the filling of its hole.

use super::change::MapChange;
use super::location::Location;
use super::removal::Removal;
use super::route::{HoleMap, Route};
use super::{Certified, REACH};
use crate::bound::replacement::Replacement;
use crate::geometry::distance::point_segment_distance_sq;
use crate::mesh::Hole;
use std::ops::ControlFlow;

/// Buffers of the transfer, one per thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct Transfer {
    hole_map: HoleMap,
    route: Route,
    location: Location,
    /// Source vertices mapped into the hole.
    covered: Vec<u32>,
    /// A change while it is not known whether it is needed: most removals end above the limit.
    draft: MapChange,
}

impl Transfer {
    /// What the removal changes, and the largest displacement; or a lower bound of that, above
    /// `limit`, alone.
    pub(super) fn change(
        &mut self,
        certified: &Certified,
        replacement: Replacement<'_>,
        limit: f64,
    ) -> Result<(f64, MapChange), f64> {
        let covered = self.gather(certified, replacement.hole);
        let removal = Removal { certified, replacement, covered: &covered };
        let mut draft = std::mem::take(&mut self.draft);
        draft.clear();
        let limit_sq = limit * limit;
        let largest_sq = self.walk(removal, [limit_sq, REACH * REACH * limit_sq], |edge, route| {
            route.shorten(removal);
            draft.add_chain(edge, &route.portions, &route.labels);
        });
        let found = largest_sq.sqrt();
        let result = if largest_sq > limit_sq {
            Err(found)
        } else {
            draft.assignments.extend(removal.covered.iter().map(|&v| self.hole_map.assign(removal, v)));
            Ok((found, draft.in_order()))
        };
        self.draft = draft;
        self.covered = covered;
        result
    }

    /// The source vertices mapped into the star of `hole`, in the buffer for them, to be given
    /// back.
    fn gather(&mut self, certified: &Certified, hole: &Hole) -> Vec<u32> {
        let mut covered = std::mem::take(&mut self.covered);
        certified.gather(hole, &mut covered);
        covered
    }

    /// Gives every source edge that the removal moves its new chain and, as long as nothing is
    /// above the limit, shows it to `take`. Largest squared displacement inside the hole, or a
    /// lower bound of it above the limit: vertices come first, then the edges that have no chain
    /// yet, which are fewer than the others, and what is above the limit by then is not followed
    /// up.
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
        let Self { hole_map, route, .. } = self;
        let mut go_on = |largest_sq: &mut f64, edge, found_sq, route: &mut Route| {
            *largest_sq = largest_sq.max(found_sq);
            if *largest_sq <= limit_sq {
                take(edge, route);
            }
            if *largest_sq <= reach_sq { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let _ = removal.try_each_split_edge(&hole_map.labels, |edge, ends| {
            let found_sq = route.split(hole_map, removal, ends);
            go_on(&mut largest_sq, edge, found_sq, route)
        });
        if largest_sq > limit_sq {
            return largest_sq;
        }
        let _ = removal.try_each_chained_edge(|chain| match route.follow(hole_map, removal, chain) {
            Some(found_sq) => go_on(&mut largest_sq, chain.edge, found_sq, route),
            None => ControlFlow::Continue(()),
        });
        largest_sq
    }

    /// Gives every vertex mapped into the hole a triangle of the filling; the largest squared
    /// displacement, or the first above `reach_sq`.
    fn place_vertices(&mut self, removal: Removal<'_>, [limit_sq, reach_sq]: [f64; 2]) -> f64 {
        let Removal { replacement: Replacement { surface, hole, filling }, covered, .. } = removal;
        let HoleMap { tree, labels, star } = &mut self.hole_map;
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
