//! Candidates in the order of their costs.
//!
//! A fusion changes the costs of some sixty tetrahedra. Computing and moving them all at once would
//! cost more than the fusion. But the quadric of a fused vertex is the sum of the quadrics it
//! replaces, so costs only rise: an old cost is a lower bound. A candidate is therefore evaluated
//! again only when it comes to the front, and goes back if it costs more than the next one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Slots by cost, the least first, ties by slot. Each slot is in it at most once.
#[derive(Clone, Debug, Default)]
pub(super) struct CostQueue {
    heap: BinaryHeap<Reverse<u64>>,
}

impl CostQueue {
    /// All slots of `costs` at once. O(n).
    pub(super) fn new(costs: impl Iterator<Item = (u32, f64)>) -> Self {
        Self { heap: costs.map(|(slot, cost)| Reverse(key(slot, cost))).collect() }
    }

    pub(super) fn push(&mut self, slot: u32, cost: f64) {
        self.heap.push(Reverse(key(slot, cost)));
    }

    /// Takes the candidate with the least cost.
    pub(super) fn pop(&mut self) -> Option<u32> {
        #[expect(clippy::cast_possible_truncation, reason = "the lower half is the slot")]
        self.heap.pop().map(|Reverse(key)| key as u32)
    }

    /// Whether a candidate of this cost would come first.
    pub(super) fn is_first(&self, slot: u32, cost: f64) -> bool {
        self.heap.peek().is_none_or(|&Reverse(first)| key(slot, cost) <= first)
    }
}

/// Orders by cost, then by slot: the bits of positive floats order as they do.
fn key(slot: u32, cost: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, reason = "the order needs no more digits")]
    let cost = (cost.max(0.0) as f32).min(f32::MAX);
    u64::from(cost.to_bits()) << 32 | u64::from(slot)
}

/// Raises the lower bound `known` of a candidate's cost to `cost`; true if that is more.
#[expect(clippy::cast_possible_truncation, reason = "the order needs no more digits")]
pub(super) fn raise_bound(known: &mut f32, cost: f64) -> bool {
    let cost = cost as f32;
    let is_more = cost > *known;
    *known = known.max(cost);
    is_more
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_come_by_cost_then_by_slot() {
        let mut queue = CostQueue::new([(7, 2.0), (3, 1e-30), (9, 2.0)].into_iter());
        assert!(queue.is_first(0, 0.0) && !queue.is_first(0, 1.0));
        queue.push(1, f64::INFINITY);
        queue.push(2, -1e-12);
        let order: Vec<u32> = std::iter::from_fn(|| queue.pop()).collect();
        assert_eq!(order, [2, 3, 7, 9, 1]);
        assert!(queue.is_first(0, 1.0));
    }
}
