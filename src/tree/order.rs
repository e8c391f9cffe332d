//! The order of the groups: by height from the largest, then by node; births ascending, then deaths
//! descending.

use super::Lifetime;
use std::ops::Range;

/// Number of heights of a tree over `n_levels` levels, at most 2^31: the bit length of the last
/// level, plus 1.
pub(crate) fn n_heights(n_levels: u32) -> u32 {
    u32::BITS - n_levels.saturating_sub(1).leading_zeros() + 1
}

/// Which list of its node a group belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum List {
    /// By birth ascending; also the only list of a node of height 0.
    Birth,
    /// By death descending.
    Death,
}

/// The slots of one height that share the stamp their list is sorted by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Height of the node.
    pub height: u32,
    /// Birth of all members in a birth list, last level (`death - 1`) of all members in a death
    /// list.
    pub level: u32,
    /// The list it belongs to.
    pub list: List,
}

impl Group {
    /// The group of `level` at `height`.
    pub fn new(height: u32, level: u32) -> Self {
        let is_upper_half = height > 0 && level >> (height - 1) & 1 == 1;
        Self { height, level, list: if is_upper_half { List::Death } else { List::Birth } }
    }

    /// Whether the list of this group begins with it.
    pub fn is_first_of_list(self, n_levels: u32) -> bool {
        match self.list {
            List::Birth => self.level.trailing_zeros() >= self.height,
            List::Death => self.level.trailing_ones() >= self.height || self.level == n_levels - 1,
        }
    }

    /// Whether this group is the first one of its node.
    pub fn is_first_of_node(self) -> bool {
        self.list == List::Birth && self.level.trailing_zeros() >= self.height
    }

    /// The stamp of a member that its position does not give: death in a birth list, birth in a
    /// death list.
    pub fn stored_stamp(self, lifetime: Lifetime) -> u32 {
        match self.list {
            List::Birth => lifetime.death(),
            List::Death => lifetime.birth(),
        }
    }

    /// The lifetime of a member from its stored stamp, or `None` when no member can carry that
    /// stamp.
    pub fn lifetime(self, stored_stamp: u32, n_levels: u32) -> Option<Lifetime> {
        let lifetime = match self.list {
            List::Birth => Lifetime::new(self.level, stored_stamp),
            List::Death => Lifetime::new(stored_stamp, self.level.checked_add(1)?),
        }?;
        (lifetime.death() <= n_levels && lifetime.height() == self.height).then_some(lifetime)
    }
}

/// All groups of a tree in the order of their slots: `n_heights * n_levels` of them, many empty in
/// a given tree.
#[derive(Clone, Debug)]
pub(crate) struct LayoutOrder {
    n_levels: u32,
    /// One more than the height being listed.
    heights_left: u32,
    /// First level of the node being listed; `u64` because the node behind the last one may begin
    /// at 2^32.
    node_start: u64,
    /// Levels of the node not listed yet.
    births: Range<u64>,
    deaths: Range<u64>,
}

impl LayoutOrder {
    /// The order for `n_levels` levels.
    pub(crate) fn new(n_levels: u32) -> Self {
        let mut order =
            Self { n_levels, heights_left: n_heights(n_levels), node_start: 0, births: 0..0, deaths: 0..0 };
        order.enter_node();
        order
    }

    fn enter_node(&mut self) {
        let n_levels = u64::from(self.n_levels);
        let size = 1u64 << (self.heights_left - 1);
        let centre = (self.node_start + size.div_ceil(2)).min(n_levels);
        self.births = self.node_start..centre;
        self.deaths = centre..(self.node_start + size).min(n_levels);
    }

    fn leave_node(&mut self) {
        self.node_start += 1 << (self.heights_left - 1);
        if self.node_start >= u64::from(self.n_levels) {
            self.node_start = 0;
            self.heights_left -= 1;
        }
        if self.heights_left > 0 {
            self.enter_node();
        }
    }
}

impl Iterator for LayoutOrder {
    type Item = Group;

    fn next(&mut self) -> Option<Group> {
        while self.heights_left > 0 {
            if let Some(level) = self.births.next().or_else(|| self.deaths.next_back()) {
                // Levels are below `n_levels`, a u32.
                let level = u32::try_from(level).ok()?;
                return Some(Group::new(self.heights_left - 1, level));
            }
            self.leave_node();
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_of_five_levels_is_the_one_of_the_specification() {
        let order: Vec<(u32, u32, List)> =
            LayoutOrder::new(5).map(|group| (group.height, group.level, group.list)).collect();
        let (birth, death) = (List::Birth, List::Death);
        let expected = [
            (3, 0, birth),
            (3, 1, birth),
            (3, 2, birth),
            (3, 3, birth),
            (3, 4, death),
            (2, 0, birth),
            (2, 1, birth),
            (2, 3, death),
            (2, 2, death),
            (2, 4, birth),
            (1, 0, birth),
            (1, 1, death),
            (1, 2, birth),
            (1, 3, death),
            (1, 4, birth),
            (0, 0, birth),
            (0, 1, birth),
            (0, 2, birth),
            (0, 3, birth),
            (0, 4, birth),
        ];
        assert_eq!(order, expected);
    }

    #[test]
    fn every_group_is_listed_once_and_lists_begin_where_they_say() {
        for n_levels in 1..70 {
            let mut seen = vec![0; (n_heights(n_levels) * n_levels) as usize];
            let mut list = None;
            for group in LayoutOrder::new(n_levels) {
                seen[(group.height * n_levels + group.level) as usize] += 1;
                let this = (group.height, group.level >> group.height, group.list);
                let is_new = list != Some(this);
                assert_eq!(group.is_first_of_list(n_levels), is_new, "{n_levels} {group:?}");
                list = Some(this);
            }
            assert!(seen.iter().all(|&times| times == 1), "{n_levels}");
        }
        assert_eq!(LayoutOrder::new(0).count(), 0);
    }
}
