//! The star of every vertex: which triangles meet there, while triangles come and go.
//!
//! The naive way, a `Vec` per vertex, costs an allocation per vertex and scatters the lists over
//! the heap. Here all lists share one pool: a list that outgrows its place moves to the pool's end,
//! and [`Stars::compact`] closes the gaps that moves leave. Works for any triangles at all,
//! manifold or not.

use super::Renumbering;
use crate::flat::to_index;

/// Lists of triangle slots, one per vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stars {
    lists: Vec<SlotRange>,
    pool: Vec<u32>,
}

#[derive(Clone, Copy, Debug, Default)]
struct SlotRange {
    start: u32,
    len: u32,
    capacity: u32,
}

/// Room left in each list at the start: a removal can add a triangle to a neighbour's star before
/// it takes others away.
const SPARE: u32 = 1;

/// The edge of a triangle that faces its corner `v`, in the triangle's orientation.
#[inline]
pub(crate) fn facing_edge([a, b, c]: [u32; 3], v: u32) -> (u32, u32) {
    if a == v {
        (b, c)
    } else if b == v {
        (c, a)
    } else {
        (a, b)
    }
}

impl Stars {
    /// Stars of `n_vertices` vertices in `triangles`, each list in ascending order. O(n).
    ///
    /// A counting sort like that of `Groups`, but with room left in each list.
    pub(crate) fn new(n_vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut lists = vec![SlotRange::default(); n_vertices];
        for &v in triangles.as_flattened() {
            lists[v as usize].capacity += 1;
        }
        let mut start = 0;
        for list in &mut lists {
            list.start = start;
            list.capacity += SPARE;
            start += list.capacity;
        }
        // Some lists move before the first tidying.
        let mut pool = Vec::with_capacity(start as usize + start as usize / 8);
        pool.resize(start as usize, 0);
        let mut stars = Self { lists, pool };
        for (slot, triangle) in (0..).zip(triangles) {
            for &v in triangle {
                stars.add(v, slot);
            }
        }
        stars
    }

    /// Slots of the triangles at `v`, in no particular order.
    #[inline]
    pub(crate) fn of(&self, v: u32) -> &[u32] {
        let list = self.lists[v as usize];
        &self.pool[list.start as usize..][..list.len as usize]
    }

    /// Adds `slot` to the star of `v`. O(1) amortised.
    pub(crate) fn add(&mut self, v: u32, slot: u32) {
        let list = self.lists[v as usize];
        if list.len == list.capacity {
            self.move_to_end(v);
        }
        let list = &mut self.lists[v as usize];
        self.pool[(list.start + list.len) as usize] = slot;
        list.len += 1;
    }

    /// Takes `slot` out of the star of `v`, if it is there. O(valence).
    pub(crate) fn remove(&mut self, v: u32, slot: u32) {
        let list = &mut self.lists[v as usize];
        let members = &mut self.pool[list.start as usize..][..list.len as usize];
        if let Some(at) = position(members, slot) {
            members[at] = members[members.len() - 1];
            list.len -= 1;
        }
    }

    /// Empties the star of `v`.
    pub(crate) fn clear(&mut self, v: u32) {
        self.lists[v as usize].len = 0;
    }

    /// Adds a vertex with an empty star and gives its index.
    pub(crate) fn add_vertex(&mut self) -> u32 {
        self.lists.push(SlotRange::default());
        to_index(self.lists.len() - 1)
    }

    /// Closes gaps once they make up half of the pool. O(n) when it works, O(1) otherwise.
    pub(crate) fn compact(&mut self, n_triangles_alive: usize) {
        if self.pool.len() < 6 * n_triangles_alive + 1024 {
            return;
        }
        let mut pool = Vec::with_capacity(self.lists.iter().map(|list| list.len as usize).sum());
        for list in &mut self.lists {
            let start = to_index(pool.len());
            pool.extend_from_slice(&self.pool[list.start as usize..][..list.len as usize]);
            *list = SlotRange { start, len: list.len, capacity: list.len };
        }
        self.pool = pool;
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber(&mut self, slots: &Renumbering) {
        for list in &self.lists {
            for slot in &mut self.pool[list.start as usize..][..list.len as usize] {
                *slot = slots.place(*slot);
            }
        }
    }

    fn move_to_end(&mut self, v: u32) {
        let list = &mut self.lists[v as usize];
        let start = self.pool.len();
        let capacity = list.len + list.len / 2 + 2;
        if self.pool.capacity() - start < capacity as usize {
            // An eighth more: less than a `Vec` takes by itself.
            self.pool.reserve_exact(capacity as usize + start / 8);
        }
        self.pool.extend_from_within(list.start as usize..(list.start + list.len) as usize);
        list.start = to_index(start);
        list.capacity = capacity;
        self.pool.resize(start + capacity as usize, 0);
    }
}

/// Where `slot` is in `members`: blocks are searched without a branch per entry, so that removing
/// the rim of a fan, each time out of the star of its hub, stays cheap at valences of a hundred
/// thousand.
fn position(members: &[u32], slot: u32) -> Option<usize> {
    const BLOCK: usize = 64;
    let holds = |block: &[u32]| block.iter().fold(false, |found, &member| found | (member == slot));
    let start = BLOCK * members.chunks(BLOCK).position(holds)?;
    members[start..].iter().position(|&member| member == slot).map(|at| start + at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn stars_agree_with_sets(operations in prop::collection::vec((0_u32..6, 0_u32..40, any::<bool>()), 0..400)) {
            let triangles = [[0, 1, 2], [2, 1, 3]];
            let mut stars = Stars::new(6, &triangles);
            let mut sets: Vec<BTreeSet<u32>> =
                (0..6).map(|v| (0..2).filter(|&t| triangles[t as usize].contains(&v)).collect()).collect();
            for (i, (v, slot, insert)) in operations.into_iter().enumerate() {
                if insert && sets[v as usize].insert(slot) {
                    stars.add(v, slot);
                } else if !insert {
                    sets[v as usize].remove(&slot);
                    stars.remove(v, slot);
                }
                if i % 50 == 49 {
                    stars.compact(0);
                }
            }
            for (v, set) in (0..).zip(&sets) {
                prop_assert_eq!(&stars.of(v).iter().copied().collect::<BTreeSet<u32>>(), set);
                prop_assert_eq!(stars.of(v).len(), set.len());
            }
        }
    }
}
