//! Laying lifetimes out: the order of the slots, and the runs of every level.

use super::{Group, LayoutOrder, Lifetime, List, Run, n_heights};
use rayon::prelude::*;
use std::ops::Range;

/// Groups shorter than this are sorted by one thread each, longer ones by all threads.
const PARALLEL_SORT_LEN: usize = 1 << 14;

/// Lifetimes that cannot be laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeError {
    /// Slots are counted in 32 bits.
    #[error("{found} stored simplices, at most {max} are possible")]
    TooManySlots {
        /// Slots that the lifetimes need.
        found: u64,
        /// Most that can be.
        max: u64,
    },
    /// A lifetime reaches beyond the last level.
    #[error("lifetime {id} ends at level {found}, there are {n_levels} levels")]
    BeyondLastLevel {
        /// Which lifetime.
        id: u32,
        /// Its death.
        found: u32,
        /// Levels there are.
        n_levels: u32,
    },
}

/// Where every lifetime is stored: the structure of a tree, without the simplices.
///
/// Memory: 4 bytes per slot and 4 bytes per height and level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    n_levels: u32,
    n_lifetimes: u32,
    /// End of each group in slots, `height * n_levels + level`.
    ends: Vec<u32>,
    /// Lifetime in each slot.
    slots: Vec<u32>,
}

impl Layout {
    /// Lays out the lifetimes `0..n_ids`. Ids for which `lifetime_of` returns `None` are left out.
    /// Within a group, ids ascend.
    ///
    /// `lifetime_of` is called twice for each id and must return the same both times. Cost:
    /// `O(n_ids + n_levels log n_levels)`.
    ///
    /// # Errors
    ///
    /// [`TreeError`] if slots do not fit in 32 bits or a lifetime ends after the last level.
    pub fn build(
        n_levels: u32,
        n_ids: u32,
        lifetime_of: impl Fn(u32) -> Option<Lifetime>,
    ) -> Result<Self, TreeError> {
        let mut ends = vec![0u32; n_heights(n_levels) as usize * n_levels as usize];
        let (n_lifetimes, n_slots) = count_groups(n_levels, n_ids, &lifetime_of, &mut ends)?;

        let mut start = 0;
        for group in LayoutOrder::new(n_levels) {
            let count = std::mem::replace(&mut ends[group_index(n_levels, group.height, group.level)], start);
            start += count;
        }

        // Until all ids are placed, each entry is the next free slot of its group; afterwards it is
        // the end of the group.
        let mut slots = vec![0u32; n_slots as usize];
        let mut place = |height, level, id| {
            let slot = &mut ends[group_index(n_levels, height, level)];
            slots[*slot as usize] = id;
            *slot += 1;
        };
        for id in 0..n_ids {
            let Some(lifetime) = lifetime_of(id) else { continue };
            let height = lifetime.height();
            place(height, lifetime.birth(), id);
            if height > 0 {
                place(height, lifetime.last(), id);
            }
        }
        Ok(Self { n_levels, n_lifetimes, ends, slots })
    }

    /// Sorts the ids inside each group by `key`, and equal keys by id. The simplices of a cut do
    /// not change, but neighbours in `key`, such as a space-filling curve, become neighbours in
    /// memory.
    pub fn sort_groups_by_key<K: Ord + Send>(&mut self, key: impl Fn(u32) -> K + Sync) {
        let (short, long): (Vec<_>, Vec<_>) =
            self.groups_mut().into_iter().partition(|ids| ids.len() < PARALLEL_SORT_LEN);
        long.into_iter().for_each(|ids| ids.par_sort_by_cached_key(|&id| key(id)));
        short.into_par_iter().for_each(|ids| ids.sort_by_cached_key(|&id| key(id)));
    }

    /// Calls `order` for stretches of at most `max_len` ids of each group; `order` may permute its
    /// stretch. Short stretches limit the memory that `order` takes.
    ///
    /// Stretches run on all threads of the current rayon pool, each with a state from `init` that
    /// no other thread uses at the same time. The result must not depend on that state.
    ///
    /// # Panics
    ///
    /// If `max_len` is 0.
    pub fn order_stretches<S>(
        &mut self,
        max_len: usize,
        init: impl Fn() -> S + Sync + Send,
        order: impl Fn(&mut S, &mut [u32]) + Sync + Send,
    ) {
        let stretches: Vec<_> =
            self.groups_mut().into_iter().flat_map(|ids| ids.chunks_mut(max_len)).collect();
        stretches.into_par_iter().for_each_init(init, order);
    }

    /// Lifetimes laid out.
    pub fn n_lifetimes(&self) -> u32 {
        self.n_lifetimes
    }

    /// The id of the lifetime in each slot.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    /// The groups that are not empty and their slots, in the order of the slots.
    pub fn groups(&self) -> impl Iterator<Item = (Group, Range<usize>)> + '_ {
        let mut start = 0;
        LayoutOrder::new(self.n_levels).filter_map(move |group| {
            let end = self.end(group.height, group.level) as usize;
            let range = std::mem::replace(&mut start, end)..end;
            (!range.is_empty()).then_some((group, range))
        })
    }

    /// The ids of each group that is not empty, in the order of the slots.
    fn groups_mut(&mut self) -> Vec<&mut [u32]> {
        let lens: Vec<usize> = self.groups().map(|(_, range)| range.len()).collect();
        let mut rest = self.slots.as_mut_slice();
        lens.into_iter().filter_map(|len| rest.split_off_mut(..len)).collect()
    }

    /// The runs of all levels, level by level: offsets (`n_levels + 1` of them) and runs, as
    /// [`Tree`](super::Tree) takes them.
    pub fn runs(&self) -> (Vec<u64>, Vec<Run>) {
        let height_starts = self.height_starts();
        let mut offsets = Vec::with_capacity(self.n_levels as usize + 1);
        let mut runs = Vec::new();
        offsets.push(0);
        for level in 0..self.n_levels {
            for height in (0..n_heights(self.n_levels)).rev() {
                let run = self.run(height, level, height_starts[height as usize]);
                if run.len > 0 {
                    runs.push(run);
                }
            }
            offsets.push(runs.len() as u64);
        }
        (offsets, runs)
    }

    fn end(&self, height: u32, level: u32) -> u32 {
        self.ends[group_index(self.n_levels, height, level)]
    }

    /// First slot of each height.
    fn height_starts(&self) -> Vec<u32> {
        let mut starts = vec![0; n_heights(self.n_levels) as usize];
        let mut end = 0;
        for group in LayoutOrder::new(self.n_levels) {
            if group.level == 0 {
                starts[group.height as usize] = end;
            }
            end = self.end(group.height, group.level);
        }
        starts
    }

    /// The prefix that is alive at `level` in its node of `height`. It starts at the end of the
    /// last group before its list, and ends at the end of the group of `level`.
    fn run(&self, height: u32, level: u32, height_start: u32) -> Run {
        let half = (1u32 << height) >> 1;
        let node_start = level >> height << height;
        let start = match Group::new(height, level).list {
            List::Death => self.end(height, node_start + half - 1),
            List::Birth if node_start == 0 => height_start,
            // Before a birth list comes the death list of the node before, which ends with the
            // centre of that node. A node of height 0 has one group.
            List::Birth => self.end(height, node_start - half.max(1)),
        };
        Run { start, len: self.end(height, level) - start }
    }
}

fn group_index(n_levels: u32, height: u32, level: u32) -> usize {
    height as usize * n_levels as usize + level as usize
}

/// Counts the members of each group into `counts`; gives the number of lifetimes and of slots.
fn count_groups(
    n_levels: u32,
    n_ids: u32,
    lifetime_of: impl Fn(u32) -> Option<Lifetime>,
    counts: &mut [u32],
) -> Result<(u32, u32), TreeError> {
    let mut n_lifetimes = 0;
    let mut n_slots = 0u64;
    for id in 0..n_ids {
        let Some(lifetime) = lifetime_of(id) else { continue };
        if lifetime.death() > n_levels {
            return Err(TreeError::BeyondLastLevel { id, found: lifetime.death(), n_levels });
        }
        let height = lifetime.height();
        counts[group_index(n_levels, height, lifetime.birth())] += 1;
        n_lifetimes += 1;
        n_slots += 1;
        if height > 0 {
            counts[group_index(n_levels, height, lifetime.last())] += 1;
            n_slots += 1;
        }
    }
    let max = u64::from(u32::MAX);
    let n_slots = u32::try_from(n_slots).map_err(|_| TreeError::TooManySlots { found: n_slots, max })?;
    Ok((n_lifetimes, n_slots))
}

#[cfg(test)]
#[expect(clippy::cast_possible_truncation, reason = "a few hundred lifetimes")]
mod tests {
    use super::*;
    use crate::tree::{Tree, TreeFault};
    use proptest::prelude::*;

    #[test]
    fn a_level_is_stabbed() {
        // Alive throughout, at level 0, and from level 1 on.
        let lifetimes = [(0, 4), (0, 1), (1, 4)];
        let lifetime = |id: u32| Lifetime::new(lifetimes[id as usize].0, lifetimes[id as usize].1);
        let layout = Layout::build(4, 3, lifetime).unwrap();
        let (offsets, runs) = layout.runs();
        let tree = crate::tree::Tree::new(&offsets, &runs, u32::try_from(layout.slots().len()).unwrap());
        let alive = tree.stab(1).flat_map(|run| &layout.slots()[run.range()]);
        assert!(alive.eq(&[0, 2]));
    }

    /// Lifetimes over `n_levels` levels, some of them empty.
    fn lifetimes() -> impl Strategy<Value = (u32, Vec<(u32, u32)>)> {
        (1u32..100).prop_flat_map(|n_levels| {
            let life = (0..=n_levels, 0..=n_levels).prop_map(|(a, b)| (a.min(b), a.max(b)));
            (Just(n_levels), prop::collection::vec(life, 0..300))
        })
    }

    fn stamps(layout: &Layout, lifetime_of: impl Fn(u32) -> Option<Lifetime>) -> Vec<u32> {
        let mut stamps = vec![0; layout.slots().len()];
        for (group, range) in layout.groups() {
            for slot in range {
                stamps[slot] = group.stored_stamp(lifetime_of(layout.slots()[slot]).unwrap());
            }
        }
        stamps
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        #[test]
        fn every_stab_equals_a_linear_scan((n_levels, lives) in lifetimes(), by_key in any::<bool>()) {
            let lifetime_of = |id: u32| Lifetime::new(lives[id as usize].0, lives[id as usize].1);
            let mut layout = Layout::build(n_levels, lives.len() as u32, lifetime_of).unwrap();
            if by_key {
                layout.sort_groups_by_key(|id| id.wrapping_mul(2_654_435_761));
            }
            let (offsets, runs) = layout.runs();
            let tree = Tree::new(&offsets, &runs, layout.slots().len() as u32);
            for level in 0..n_levels {
                let mut found: Vec<u32> =
                    tree.stab(level).flat_map(|run| &layout.slots()[run.range()]).copied().collect();
                found.sort_unstable();
                let scan: Vec<u32> = (0..lives.len() as u32)
                    .filter(|&id| lives[id as usize].0 <= level && level < lives[id as usize].1)
                    .collect();
                prop_assert_eq!(found, scan);
                prop_assert!(tree.stab(level).count() as u32 <= n_heights(n_levels));
                prop_assert_eq!(tree.stab(level).collect::<Vec<_>>(), tree.stored_runs(level));
            }

            let stamps = stamps(&layout, lifetime_of);
            let mut n_visited = 0;
            let visit = |slot: u32, life: Lifetime| -> Result<(), TreeFault> {
                n_visited += 1;
                assert_eq!(Some(life), lifetime_of(layout.slots()[slot as usize]));
                Ok(())
            };
            prop_assert_eq!(tree.check(&stamps, layout.slots(), 1, visit), Ok(()));
            prop_assert_eq!(n_visited, layout.slots().len());
        }

        #[test]
        fn the_checker_finds_every_edit(
            (n_levels, lives) in lifetimes(), place in any::<prop::sample::Index>(), change in 1u32..5, what in 0..4
        ) {
            let lifetime_of = |id: u32| Lifetime::new(lives[id as usize].0, lives[id as usize].1);
            let layout = Layout::build(n_levels, lives.len() as u32, lifetime_of).unwrap();
            prop_assume!(!layout.slots().is_empty());
            let (mut offsets, mut runs) = layout.runs();
            let (mut stamps, mut payload) = (stamps(&layout, lifetime_of), layout.slots().to_vec());
            let edited = match what {
                0 => &mut stamps[place.index(layout.slots().len())],
                1 => &mut payload[place.index(layout.slots().len())],
                2 => &mut runs[place.index(layout.runs().1.len())].len,
                _ => &mut runs[place.index(layout.runs().1.len())].start,
            };
            *edited = edited.wrapping_add(change);
            if change == 4 {
                offsets[place.index(n_levels as usize + 1)] += 1;
            }
            let tree = Tree::new(&offsets, &runs, layout.slots().len() as u32);
            let height_of = |slot: usize| lifetime_of(layout.slots()[slot]).unwrap().height();
            // The payload of a height without a second list has nothing to be compared with.
            prop_assume!(what != 1 || change == 4 || height_of(place.index(layout.slots().len())) > 0);
            let visit = |_, _| Ok::<(), TreeFault>(());
            prop_assert!(tree.check(&stamps, &payload, 1, visit).is_err());
        }
    }

    #[test]
    fn a_lifetime_behind_the_last_level_is_refused() {
        let error = Layout::build(4, 1, |_| Lifetime::new(1, 5)).unwrap_err();
        assert_eq!(error, TreeError::BeyondLastLevel { id: 0, found: 5, n_levels: 4 });
    }
}
