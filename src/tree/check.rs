//! The structural checker: every invariant of a tree and of what is stored in it.

use super::{Group, LayoutOrder, Lifetime, List, Run, Tree, n_heights};
use rayon::prelude::*;
use std::ops::Range;

/// What is wrong with a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeFault {
    /// Offsets are not those of the runs.
    #[error("run offset {index} is {found}, which is below the one before or beyond the {n_runs} runs")]
    Offset {
        /// Which offset.
        index: u64,
        /// Its value.
        found: u64,
        /// Runs there are.
        n_runs: u64,
    },
    /// More runs than heights, or a run that belongs to no height that is left.
    #[error("level {level} has a run at slot {start} that belongs to no node")]
    ForeignRun {
        /// The level.
        level: u32,
        /// First slot of the run.
        start: u32,
    },
    /// A run is not a prefix of its list.
    #[error(
        "level {level}, height {height}: run is slots {found:?}, expected to begin at {start} and reach {end} or more"
    )]
    RunRange {
        /// The level.
        level: u32,
        /// The height.
        height: u32,
        /// Slots of the run.
        found: Run,
        /// First slot of the list.
        start: u32,
        /// End of the group before.
        end: u32,
    },
    /// No run reaches the last slots.
    #[error("runs reach slot {found} of {expected}")]
    Coverage {
        /// Slots that the nodes cover.
        found: u32,
        /// Slots there are.
        expected: u32,
    },
    /// The stored stamp is impossible in the group of the slot.
    #[error("slot {slot}: stamp {found} is impossible for level {level} at height {height}")]
    Stamp {
        /// Which slot.
        slot: u32,
        /// Its stored stamp.
        found: u32,
        /// Level of the group.
        level: u32,
        /// Height of the group.
        height: u32,
    },
    /// The two lists of a node hold different simplices or lifetimes.
    #[error("node {node} of height {height}: birth list and death list differ")]
    Lists {
        /// Which node.
        node: u32,
        /// Its height.
        height: u32,
    },
}

/// A slot and the level of its group.
type Member = (u32, u32);

impl Tree<'_> {
    /// Checks the whole tree: offsets, runs, groups, stamps, and that both lists of every node hold
    /// the same.
    ///
    /// `stamps[slot]` is the stored stamp; `payload` has `n_corners` numbers per slot. `visit` is
    /// called once for each slot with its lifetime. Cost: `O(n_slots log n_slots)` time, 8 bytes
    /// per slot of the largest node and 4 bytes per level.
    ///
    /// # Errors
    ///
    /// The first [`TreeFault`] in the order of the slots, or the error of `visit`.
    pub fn check<E: From<TreeFault>>(
        &self,
        stamps: &[u32],
        payload: &[u32],
        n_corners: usize,
        mut visit: impl FnMut(u32, Lifetime) -> Result<(), E>,
    ) -> Result<(), E> {
        self.check_offsets()?;
        let n_levels = self.n_levels();
        let members = Members { stamps, payload, n_corners, n_levels };
        let mut n_taken = vec![0u32; n_levels as usize];
        let (mut births, mut deaths): (Vec<Member>, Vec<Member>) = (Vec::new(), Vec::new());
        let mut node = Group::new(0, 0);
        let (mut list_start, mut end) = (0, 0);
        for group in LayoutOrder::new(n_levels) {
            if group.is_first_of_node() {
                members.check_same(node, &mut births, &mut deaths)?;
                node = group;
            }
            if group.is_first_of_list(n_levels) {
                list_start = end;
            }
            let slots = self.take_group(group, list_start..end, stamps, &mut n_taken)?;
            end = slots.end;
            for slot in slots {
                visit(slot, members.lifetime(group, slot)?)?;
                match group.list {
                    List::Birth if group.height == 0 => {}
                    List::Birth => births.push((slot, group.level)),
                    List::Death => deaths.push((slot, group.level)),
                }
            }
        }
        members.check_same(node, &mut births, &mut deaths)?;
        if end != self.n_slots() {
            return Err(TreeFault::Coverage { found: end, expected: self.n_slots() }.into());
        }
        for level in 0..n_levels {
            if let Some(run) = self.stored_runs(level).get(n_taken[level as usize] as usize) {
                return Err(TreeFault::ForeignRun { level, start: run.start }.into());
            }
        }
        Ok(())
    }

    fn n_levels(&self) -> u32 {
        u32::try_from(self.offsets().len().saturating_sub(1)).unwrap_or(u32::MAX)
    }

    fn check_offsets(&self) -> Result<(), TreeFault> {
        let n_runs = self.n_runs() as u64;
        let most_per_level = u64::from(n_heights(self.n_levels()));
        let mut before = 0;
        for (index, &found) in (0..).zip(self.offsets()) {
            let largest = if index == 0 { 0 } else { n_runs.min(before + most_per_level) };
            if found < before || found > largest {
                return Err(TreeFault::Offset { index, found, n_runs });
            }
            before = found;
        }
        if before == n_runs {
            Ok(())
        } else {
            let index = u64::from(self.n_levels());
            Err(TreeFault::Offset { index, found: before, n_runs })
        }
    }

    /// The slots of `group`: what the run of its level adds to `list`, the part of the list before
    /// the group.
    fn take_group(
        &self,
        group: Group,
        list: Range<u32>,
        stamps: &[u32],
        n_taken: &mut [u32],
    ) -> Result<Range<u32>, TreeFault> {
        let Group { height, level, .. } = group;
        let taken = &mut n_taken[level as usize];
        let run = self.stored_runs(level).get(*taken as usize).copied();
        // The run belongs to this height if its first member does. That member is alive at `level`,
        // so its stored stamp gives the height, whichever list it is in.
        let run = run.filter(|run| {
            let stamp = stamps.get(run.start as usize).copied();
            stamp.and_then(|stamp| height_from_stamp(level, stamp)) == Some(height)
        });
        let Some(run) = run else {
            let empty = list.end..list.end;
            return if list.is_empty() {
                Ok(empty)
            } else {
                let found = Run { start: list.start, len: 0 };
                Err(TreeFault::RunRange { level, height, found, start: list.start, end: list.end })
            };
        };
        *taken += 1;
        let run_end = run.start.checked_add(run.len).filter(|&run_end| run_end <= self.n_slots());
        match run_end {
            Some(run_end) if run.start == list.start && run_end >= list.end && run.len > 0 => {
                Ok(list.end..run_end)
            }
            _ => Err(TreeFault::RunRange { level, height, found: run, start: list.start, end: list.end }),
        }
    }
}

/// Height of a slot that is alive at `level` and stores `stamp`: a death above `level` or a birth
/// at or below it.
pub(super) fn height_from_stamp(level: u32, stamp: u32) -> Option<u32> {
    let other_end = if stamp > level { stamp - 1 } else { stamp };
    let height = u32::BITS - (level ^ other_end).leading_zeros();
    // A stored birth equal to the level would be a death list of height 0, which does not exist.
    (height > 0 || stamp > level).then_some(height)
}

/// What is stored in the slots.
struct Members<'a> {
    stamps: &'a [u32],
    payload: &'a [u32],
    n_corners: usize,
    n_levels: u32,
}

impl Members<'_> {
    fn lifetime(&self, group: Group, slot: u32) -> Result<Lifetime, TreeFault> {
        let found = self.stamps.get(slot as usize).copied().unwrap_or(0);
        let Group { level, height, .. } = group;
        group.lifetime(found, self.n_levels).ok_or(TreeFault::Stamp { slot, found, level, height })
    }

    /// What two slots of one node must share to be the same simplex: lifetime and payload.
    fn key(&self, list: List, (slot, level): Member) -> (u32, u32, &[u32]) {
        let stamp = self.stamps.get(slot as usize).copied().unwrap_or(0);
        let (birth, last) = match list {
            List::Birth => (level, stamp.wrapping_sub(1)),
            List::Death => (stamp, level),
        };
        let start = slot as usize * self.n_corners;
        (birth, last, self.payload.get(start..start + self.n_corners).unwrap_or(&[]))
    }

    /// Compares the lists of a node as sets and empties them.
    fn check_same(
        &self,
        node: Group,
        births: &mut Vec<Member>,
        deaths: &mut Vec<Member>,
    ) -> Result<(), TreeFault> {
        births.par_sort_unstable_by_key(|&member| self.key(List::Birth, member));
        deaths.par_sort_unstable_by_key(|&member| self.key(List::Death, member));
        let is_same = births.len() == deaths.len()
            && births
                .par_iter()
                .zip(deaths.par_iter())
                .all(|(&birth, &death)| self.key(List::Birth, birth) == self.key(List::Death, death));
        births.clear();
        deaths.clear();
        if is_same {
            return Ok(());
        }
        let Group { height, level, .. } = node;
        Err(TreeFault::Lists { node: level >> height, height })
    }
}
