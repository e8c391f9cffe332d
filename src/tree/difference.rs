//! What changes from one level to another.

use super::check::height_from_stamp;
use super::{Run, Tree};

/// Heights that a tree over at most 2^31 levels can have.
const MAX_HEIGHTS: usize = 32;

/// The run of a level at each height, empty ones too.
type RunsByHeight = [Run; MAX_HEIGHTS];

impl<'a> Tree<'a> {
    /// The simplices alive at `level` and not at `other`; `stamps` are the stored ones of all slots.
    ///
    /// The naive way compares two cuts simplex by simplex. Here they are compared height by height. With `crossing` as the
    /// bit length of `level ^ other`,
    ///
    /// * below `crossing` the levels are in different nodes, so that the whole run of `level` is gone at `other`;
    /// * above it they are in the same half of one node, and of two prefixes of one list the longer one has the rest;
    /// * at `crossing` they are in the two halves of one node, whose centre is between them. Either the run of `level` is
    ///   searched for what is not alive at `other`, or what the other half's list has behind the run of `other` for what is
    ///   alive at `level`, whichever is shorter. The latter holds only what is born or dies between the two levels.
    ///
    /// Neighbouring levels have nothing at the crossing height that only one of them has, so all is contiguous. Where runs
    /// of the other half's list come out, their slots are not those that the cut of `level` draws; the simplices are.
    /// Cost: one stamp per run of three levels, then one step per run and per simplex searched.
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
                // Stamps are deaths in the list of the lower half, births in that of the upper half.
                keep = if level < other { Keep::AtMost(stamp) } else { Keep::Above(stamp) };
            }
        }
        Difference { parts, heights_left: MAX_HEIGHTS, crossing, keep, stamps }
    }

    /// The list of the half that `level` is in, of the node of `height` whose other half `other` is in.
    fn list_of_half(&self, level: u32, other: u32, height: usize, stamps: &[u32]) -> Run {
        let centre = level.max(other) >> (height - 1) << (height - 1);
        // The whole birth list is alive just before the centre, the whole death list at the centre.
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

/// Which simplices of a searched range are kept, by their stored stamp.
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
    /// The one height at which a part is searched, and for what.
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

/// Takes the first run of simplices that are kept, and all before it, off the front of `part`.
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
