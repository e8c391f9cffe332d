//! Where the wedges at a vertex go when it is collapsed.

use super::ring::Ring;
use crate::mesh::{Surface, Wedges};

/// For each triangle of the ring, in its order: the wedge that it has at the centre, and the wedge
/// at neighbour `into` that the collapse along this edge puts there. A triangle takes the wedge of
/// `into` on its own side of the edge, going round from there until the wedge at the centre
/// changes; what lies beyond takes the nearer one.
pub(super) fn wedge_targets(
    wedges: &Wedges,
    surface: &Surface,
    ring: &Ring,
    into: usize,
    pairs: &mut Vec<[u32; 2]>,
) {
    let (n, target) = (ring.len(), ring.vertices[into]);
    let at_center = |i: usize| wedges.at(surface, ring.slots[i], ring.center);
    let at_target = |i: usize| wedges.at(surface, ring.slots[i], target);
    let before = if into > 0 { Some(into - 1) } else { ring.is_cycle().then(|| n - 1) };
    let after = (into < n).then_some(into);
    let [before, after] = [before.or(after), after.or(before)].map(Option::unwrap_or_default);
    pairs.clear();
    pairs.extend((0..n).map(|i| {
        // Steps from the edge to the triangle, this way round and that; at the end of a chain both
        // begin alike.
        let (forward, backward) = ((i + n - after) % n, (before + n - i) % n);
        let same = |place: usize| at_center(place) == at_center(i);
        let ahead = (0..forward).all(|step| same((after + step) % n));
        let behind = (0..backward).all(|step| same((before + n - step) % n));
        let is_ahead = if ahead == behind { forward <= backward } else { ahead };
        [at_center(i), at_target(if is_ahead { after } else { before })]
    }));
}
