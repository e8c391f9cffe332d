//! What changes from one level to another.

use super::check::height_from_stamp;
use super::{Run, Tree};

/// Heights that a tree over at most 2^31 levels can have.
const MAX_HEIGHTS: usize = 32;

/// The run of a level at each height, empty ones too.
type RunsByHeight = [Run; MAX_HEIGHTS];

impl<'a> Tree<'a> {
    /// The simplices alive at `level` and not at `other`. `stamps` are the stored stamps of all
    /// slots.
    ///
    /// The naive way compares two cuts simplex by simplex. Here they are compared height by height.
    /// Let `crossing` be the bit length of `level ^ other`.
    ///
    /// * Below `crossing` the levels are in different nodes, so the whole run of `level` is gone at
    ///   `other`.
    /// * Above `crossing` the levels are in the same half of one node. Their runs are prefixes of
    ///   one list, and the longer one has the rest.
    /// * At `crossing` they are in the two halves of one node, whose centre is between them. Two
    ///   ranges hold the answer: the run of `level`, searched for simplices that are not alive at
    ///   `other`; and what the list of the other half has after the run of `other`, searched for
    ///   simplices that are alive at `level`. The shorter one is searched. The second one holds
    ///   only simplices that are born or die between the two levels.
    ///
    /// Neighbouring levels differ in nothing at the height `crossing`, so all runs are contiguous.
    /// Runs from the list of the other half have other slots than the cut of `level`, but the same
    /// simplices. Cost: one stamp per run of three levels, then one step per run and per simplex
    /// searched.
    pub fn only_at(&self, level: u32, other: u32, stamps: &'a [u32]) -> Difference<'a> {
        let crossing = (u32::BITS - (level ^ other).leading_zeros()) as usize;
        let mut parts = self.runs_by_height(level, stamps);
        let other_runs = self.runs_by_height(other, stamps);
        let mut keep = Keep::All;
        for (height, (part, other_run)) in parts.iter_mut().zip(&other_runs).enumerate() {
            if height > crossing || crossing == 0 {
                *part = without_prefix(*part, other_run.len);
            } else if height == crossing {
                let list = self.list_of_half(other, level, height, stamps);
                let rest = without_prefix(list, other_run.len);
                let stamp = if part.len < rest.len { other } else { level };
                if stamp == level {
                    *part = rest;
                }
                // Stored stamps are deaths in the list of the lower half, births in that of the
                // upper half.
                keep = if level < other { Keep::AtMost(stamp) } else { Keep::Above(stamp) };
            }
        }
        Difference { parts, heights_left: MAX_HEIGHTS, crossing, keep, stamps }
    }

    /// All simplices of the half that `level` is in, of the node of `height` whose other half
    /// contains `other`.
    fn list_of_half(&self, level: u32, other: u32, height: usize, stamps: &[u32]) -> Run {
        let centre = level.max(other) >> (height - 1) << (height - 1);
        // Just before the centre the whole birth list is alive; at the centre, the whole death
        // list.
        let all_alive = if level < other { centre - 1 } else { centre };
        self.runs_by_height(all_alive, stamps)[height]
    }

    fn runs_by_height(&self, level: u32, stamps: &[u32]) -> RunsByHeight {
        let mut by_height = [Run { start: 0, len: 0 }; MAX_HEIGHTS];
        for run in self.stab(level) {
            let stamp = stamps.get(run.start as usize).copied();
            let height =
                stamp.and_then(|stamp| height_from_stamp(level, stamp)).map(|height| height as usize);
            if let Some(entry) = height.and_then(|height| by_height.get_mut(height)) {
                *entry = run;
            }
        }
        by_height
    }
}

fn without_prefix(run: Run, len: u32) -> Run {
    let len = len.min(run.len);
    Run { start: run.start + len, len: run.len - len }
}

/// Which simplices of a searched range are kept, by stored stamp.
#[derive(Clone, Copy, Debug)]
enum Keep {
    All,
    AtMost(u32),
    Above(u32),
}

impl Keep {
    fn keeps(self, stamp: u32) -> bool {
        match self {
            Self::All => true,
            Self::AtMost(level) => stamp <= level,
            Self::Above(level) => stamp > level,
        }
    }
}

/// Iterator over the simplices that one level has and another has not, as runs that do not overlap.
#[derive(Clone, Debug)]
pub struct Difference<'a> {
    /// What is left of each height.
    parts: RunsByHeight,
    heights_left: usize,
    /// The one height at which a range is searched, and what for.
    crossing: usize,
    keep: Keep,
    stamps: &'a [u32],
}

impl Iterator for Difference<'_> {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        while let Some(height) = self.heights_left.checked_sub(1) {
            let part = &mut self.parts[height];
            let keep = if height == self.crossing { self.keep } else { Keep::All };
            let run = match keep {
                Keep::All => std::mem::replace(part, Run { start: 0, len: 0 }),
                _ => take_kept(part, keep, self.stamps),
            };
            if run.len > 0 {
                return Some(run);
            }
            self.heights_left = height;
        }
        None
    }
}

/// Takes the first run of kept simplices, and all before it, off the front of `part`.
fn take_kept(part: &mut Run, keep: Keep, stamps: &[u32]) -> Run {
    let stamps = stamps.get(part.range()).unwrap_or(&[]);
    let n_before = stamps.iter().take_while(|&&stamp| !keep.keeps(stamp)).count();
    let n_kept = stamps[n_before..].iter().take_while(|&&stamp| keep.keeps(stamp)).count();
    // Both count stamps of one part, whose length is a u32.
    let [n_before, n_kept] = [n_before, n_kept].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    *part = without_prefix(*part, n_before);
    let run = Run { start: part.start, len: n_kept };
    *part = without_prefix(*part, n_kept);
    run
}
