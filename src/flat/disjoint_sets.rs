//! Disjoint sets.

use super::to_index;

/// Disjoint sets of the numbers below a count. Each set has one *root* among its members.
///
/// Reference: R. E. Tarjan: "Efficiency of a good but not linear set union algorithm" (Journal of
/// the ACM 22, 1975), with path halving.
#[derive(Clone, Debug)]
pub(crate) struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    /// A set for each number below `len`.
    pub(crate) fn new(len: usize) -> Self {
        Self { parents: (0..).take(len).collect() }
    }

    /// The root of the set that `member` is in.
    pub(crate) fn root(&mut self, mut member: u32) -> u32 {
        loop {
            let parent = self.parents[member as usize];
            if parent == member {
                return member;
            }
            let above = self.parents[parent as usize];
            self.parents[member as usize] = above;
            member = above;
        }
    }

    /// Joins the sets of two members; false if they were one before. The smaller root stays, so
    /// that the sets do not depend on the order of joining.
    pub(crate) fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// Adds a number, the next one, and makes it the root of the sets with the given roots. Returns
    /// it.
    pub(crate) fn push_over(&mut self, roots: &[u32]) -> u32 {
        let new = to_index(self.parents.len());
        self.parents.push(new);
        roots.iter().for_each(|&root| self.parents[root as usize] = new);
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against labels that are all rewritten with every join.
        #[test]
        fn members_have_one_root_where_they_were_joined(pairs in prop::collection::vec((0_u32..40, 0_u32..40), 0..60)) {
            let mut sets = DisjointSets::new(40);
            let mut labels: Vec<u32> = (0..40).collect();
            for (a, b) in pairs {
                let [of_a, of_b] = [a, b].map(|member| labels[member as usize]);
                prop_assert_eq!(sets.join(a, b), of_a != of_b);
                labels.iter_mut().filter(|label| **label == of_a.max(of_b)).for_each(|label| *label = of_a.min(of_b));
            }
            let roots: Vec<u32> = (0..40).map(|member| sets.root(member)).collect();
            prop_assert_eq!(roots, labels);
        }
    }

    #[test]
    fn a_new_root_stands_for_all_below_it() {
        let mut sets = DisjointSets::new(4);
        assert_eq!(sets.push_over(&[0, 2]), 4);
        assert_eq!(sets.push_over(&[4, 3]), 5);
        assert_eq!([0, 1, 2, 3, 4, 5].map(|member| sets.root(member)), [5, 1, 5, 5, 5, 5]);
    }
}
