//! Grouping by counting sort.

use std::ops::Range;

/// Items grouped by a number: those of a group lie side by side, in the order they had.
///
/// Memory: 4 bytes per group beside the items.
#[derive(Clone, Debug, Default)]
pub(crate) struct Groups<T> {
    /// Where each group starts in `members`, and where the last one ends.
    starts: Vec<u32>,
    members: Vec<T>,
}

impl<T: Copy + Default> Groups<T> {
    /// Groups items by the numbers beside them, below `n_groups`. Goes through `items` twice; they
    /// are fewer than `u32::MAX`. O(groups + items).
    pub(crate) fn new(n_groups: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        // Counts stand two places behind their groups, so that after adding up each group has its
        // start one place behind, and after placing its items its end: the start of the next group.
        let mut starts = vec![0; n_groups + 2];
        items.clone().for_each(|(group, _)| starts[group as usize + 2] += 1);
        let mut n_before = 0;
        for start in &mut starts {
            n_before += *start;
            *start = n_before;
        }
        let mut members = vec![T::default(); n_before as usize];
        items.for_each(|(group, item)| {
            let next = &mut starts[group as usize + 1];
            members[*next as usize] = item;
            *next += 1;
        });
        starts.pop();
        Self { starts, members }
    }
}

impl<T> Groups<T> {
    /// Places of the members of `group`.
    #[inline]
    pub(crate) fn range(&self, group: u32) -> Range<usize> {
        self.starts[group as usize] as usize..self.starts[group as usize + 1] as usize
    }

    /// Members of `group`.
    #[inline]
    pub(crate) fn of(&self, group: u32) -> &[T] {
        &self.members[self.range(group)]
    }

    /// The member at a place of a [`range`](Self::range).
    #[inline]
    pub(crate) fn member(&self, at: usize) -> &T {
        &self.members[at]
    }

    /// The members of one group after another.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut [T]> {
        let mut rest = self.members.as_mut_slice();
        self.starts
            .windows(2)
            .map(move |ends| rest.split_off_mut(..(ends[1] - ends[0]) as usize).unwrap_or_default())
    }

    /// Where each group starts, and where the last one ends; and the members.
    pub(crate) fn into_parts(self) -> (Vec<u32>, Vec<T>) {
        (self.starts, self.members)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against a list per group.
        #[test]
        fn groups_hold_their_items_in_order(items in prop::collection::vec((0_u32..9, 0_u8..255), 0..60)) {
            let mut groups = Groups::new(9, items.iter().copied());
            let of = |group| -> Vec<u8> { items.iter().filter(|item| item.0 == group).map(|item| item.1).collect() };
            for group in 0..9 {
                let expected = of(group);
                prop_assert_eq!(groups.of(group), &expected[..]);
                let members: Vec<u8> = groups.range(group).map(|at| *groups.member(at)).collect();
                prop_assert_eq!(members, expected);
            }
            let lists: Vec<Vec<u8>> = groups.iter_mut().map(|members| members.to_vec()).collect();
            prop_assert_eq!(lists, (0..9).map(of).collect::<Vec<_>>());
            let (starts, members) = groups.into_parts();
            prop_assert_eq!((starts.len(), starts[9] as usize), (10, members.len()));
        }
    }
}
