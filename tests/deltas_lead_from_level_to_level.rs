//! Promise: the triangles that leave and enter between two levels turn one cut into the other,
//! forwards and backwards, in time proportional to the change.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{Difference, Lod, Run, StoreOptions};
use std::collections::HashMap;
use support::synthetic::{Random, decimate, grid};

/// The set of triangles that are alive, by their vertex indices. Each has a random number, and the
/// sum of these numbers stands for the set.
struct Followed<'a> {
    lod: &'a Lod,
    ids: HashMap<[u32; 3], usize>,
    is_alive: Vec<bool>,
    keys: Vec<u64>,
    sum: u64,
}

impl<'a> Followed<'a> {
    fn new(lod: &'a Lod) -> Self {
        let mut random = Random(3);
        let mut ids = HashMap::new();
        for triangle in lod.indices().chunks_exact(3) {
            let next_id = ids.len();
            ids.entry([triangle[0], triangle[1], triangle[2]]).or_insert(next_id);
        }
        let keys: Vec<u64> = ids.iter().map(|_| random.next()).collect();
        Self { lod, is_alive: vec![false; ids.len()], ids, keys, sum: 0 }
    }

    fn triangles(&self, runs: impl Iterator<Item = Run>) -> Vec<usize> {
        let slots = runs.flat_map(Run::range);
        let triangle = |slot: usize| std::array::from_fn(|corner| self.lod.indices()[3 * slot + corner]);
        slots.map(|slot| self.ids[&triangle(slot)]).collect()
    }

    fn sum_of(&self, level: u32) -> u64 {
        let alive = self.triangles(self.lod.at_level(level).runs());
        alive.iter().fold(0, |sum, &id| sum.wrapping_add(self.keys[id]))
    }

    /// Removes or adds triangles; each must have been in the opposite state.
    fn change(&mut self, runs: Difference, enters: bool) -> usize {
        let changed = self.triangles(runs);
        for &id in &changed {
            assert!(self.is_alive[id] != enters, "already so");
            self.is_alive[id] = enters;
            let key = self.keys[id];
            self.sum = if enters { self.sum.wrapping_add(key) } else { self.sum.wrapping_sub(key) };
        }
        changed.len()
    }
}

/// Goes from level to level along `levels` and compares with the direct cut each time.
fn follow(lod: &Lod, levels: impl Iterator<Item = u32>) {
    let mut followed = Followed::new(lod);
    let direct: Vec<u64> = (0..lod.n_levels()).map(|level| followed.sum_of(level)).collect();
    for id in followed.triangles(lod.at_level(0).runs()) {
        followed.is_alive[id] = true;
    }
    followed.sum = direct[0];
    let mut before = 0;
    for level in levels {
        let delta = lod.delta(before, level);
        let n_before = delta.before().n_simplices();
        let n_leaving = followed.change(delta.leaving(), false);
        let n_entering = followed.change(delta.entering(), true);
        assert_eq!(followed.sum, direct[level as usize], "from {before} to {level}");
        assert_eq!(n_before - n_leaving + n_entering, delta.after().n_simplices());
        before = level;
    }
}

fn lod(side: usize, levels: Option<u32>) -> Lod {
    let mesh = grid(side);
    let history = decimate(&mesh, usize::MAX, 5);
    Lod::from_bytes(&support::file_bytes(&mesh, &history, levels)).unwrap()
}

fn lod_in_windows(side: usize, window_levels: u32) -> Lod {
    let mesh = grid(side);
    let history = decimate(&mesh, usize::MAX, 5);
    let options = StoreOptions { window_levels: Some(window_levels), ..StoreOptions::default() };
    Lod::from_bytes(&support::file_bytes_with(&mesh, &history, &options)).unwrap()
}

#[test]
fn a_hundred_thousand_random_pairs_agree_with_direct_cuts() {
    for (levels, n_pairs) in [(None, 60_000), (Some(u32::MAX), 30_000), (Some(17), 10_000)] {
        let lod = lod(24, levels);
        let mut random = Random(9);
        let n_levels = lod.n_levels() as usize;
        follow(&lod, (0..n_pairs).map(|_| u32::try_from(random.below(n_levels)).unwrap()));
    }
}

#[test]
fn the_chain_of_neighbours_leads_down_and_back() {
    for levels in [None, Some(u32::MAX), Some(2), Some(1)] {
        let lod = lod(30, levels);
        follow(&lod, (0..lod.n_levels()).chain((0..lod.n_levels()).rev()));
    }
}

#[test]
fn deltas_lead_across_the_borders_of_windows() {
    for window_levels in [1, 5, 16] {
        let lod = lod_in_windows(24, window_levels);
        follow(&lod, (0..lod.n_levels()).chain((0..lod.n_levels()).rev()));
        let mut random = Random(10);
        let n_levels = lod.n_levels() as usize;
        follow(&lod, (0..5_000).map(|_| u32::try_from(random.below(n_levels)).unwrap()));
    }
}

#[test]
fn neighbours_differ_by_a_run_per_height_at_most() {
    let lod = lod(60, None);
    // Of the interval tree: the bits of the last level, and one more.
    let n_heights = (u32::BITS - (lod.n_levels() - 1).leading_zeros() + 1) as usize;
    for level in 1..lod.n_levels() {
        for delta in [lod.delta(level - 1, level), lod.delta(level, level - 1)] {
            assert!(delta.leaving().count() <= n_heights && delta.entering().count() <= n_heights);
        }
        assert_eq!(lod.delta(level, level).leaving().chain(lod.delta(level, level).entering()).count(), 0);
    }
    assert_eq!(lod.delta(u32::MAX, u32::MAX).after().level(), lod.n_levels() - 1);
}
