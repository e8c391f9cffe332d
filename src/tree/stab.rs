//! Stabbing: the runs of a level, over borrowed slices whose content need not be valid.

use bytemuck::{Pod, Zeroable};
use std::ops::Range;

/// A contiguous range of slots.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Run {
    /// First slot.
    pub start: u32,
    /// Number of slots.
    pub len: u32,
}

impl Run {
    /// The slots.
    ///
    /// ```
    /// assert_eq!(nephrite::Run { start: 4, len: 2 }.range(), 4..6);
    /// ```
    pub fn range(self) -> Range<usize> {
        self.start as usize..self.start as usize + self.len as usize
    }

    /// The vertex indices of the slots in a flat buffer with `n_corners` indices per slot.
    pub fn index_range(self, n_corners: usize) -> Range<usize> {
        let slots = self.range();
        n_corners * slots.start..n_corners * slots.end
    }
}

/// The finished runs of every level: `offsets.len() == n_levels + 1`, and the runs of level `l` are
/// `runs[offsets[l]..offsets[l + 1]]`.
#[derive(Clone, Copy, Debug)]
pub struct Tree<'a> {
    offsets: &'a [u64],
    runs: &'a [Run],
    n_slots: u32,
}

impl<'a> Tree<'a> {
    /// A tree over slices of any content: offsets out of range give no runs, and runs are clamped
    /// when they are read.
    pub fn new(offsets: &'a [u64], runs: &'a [Run], n_slots: u32) -> Self {
        Self { offsets, runs, n_slots }
    }

    /// Offsets of the levels' runs.
    pub fn offsets(&self) -> &'a [u64] {
        self.offsets
    }

    /// Runs of all levels together.
    pub fn n_runs(&self) -> usize {
        self.runs.len()
    }

    /// Slots that runs may refer to.
    pub fn n_slots(&self) -> u32 {
        self.n_slots
    }

    /// Runs of `level` as stored, not clamped; empty if the offsets are out of range.
    pub fn stored_runs(&self, level: u32) -> &'a [Run] {
        let offset = |index: usize| self.offsets.get(index).and_then(|&offset| usize::try_from(offset).ok());
        let level = level as usize;
        let (Some(start), Some(end)) = (offset(level), offset(level + 1)) else { return &[] };
        self.runs.get(start..end).unwrap_or(&[])
    }

    /// The simplices alive at `level`, as runs that ascend and do not overlap. Cost: two to three
    /// cache lines, then one step per run.
    pub fn stab(&self, level: u32) -> Runs<'a> {
        Runs { stored: self.stored_runs(level).iter(), floor: 0, n_slots: self.n_slots }
    }
}

/// Iterator over the runs of one level. Each run is clamped to the slots after the run before it,
/// so that the runs of a damaged tree together never exceed the number of slots.
#[derive(Clone, Debug)]
pub struct Runs<'a> {
    stored: std::slice::Iter<'a, Run>,
    floor: u32,
    n_slots: u32,
}

impl Iterator for Runs<'_> {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        loop {
            let stored = self.stored.next()?;
            let end = stored.start.saturating_add(stored.len).min(self.n_slots);
            let start = stored.start.max(self.floor);
            if start < end {
                self.floor = end;
                return Some(Run { start, len: end - start });
            }
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, Some(self.stored.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_any_content_stay_in_range_and_do_not_overlap() {
        let run = |start, len| Run { start, len };
        let runs = [run(2, 3), run(0, 4), run(4, 0), run(3, u32::MAX), run(u32::MAX, u32::MAX), run(0, 9)];
        let offsets = [0, 6, 5, u64::MAX, 7];
        let tree = Tree::new(&offsets, &runs, 8);
        assert_eq!(tree.stab(0).collect::<Vec<_>>(), [run(2, 3), run(5, 3)]);
        for level in [1, 2, 3, 4, u32::MAX] {
            assert_eq!(tree.stab(level).next(), None);
        }
        assert_eq!(Tree::new(&[], &[], 0).stab(0).next(), None);
    }
}
