//! What was last found of each vertex, and which of them are to be tried next.

use super::candidate::Refusal;
use crate::bound::Limits;
use crate::bound::accumulated::round_up;
use crate::mesh::Surface;
use rayon::prelude::*;

/// What was last found of each vertex, and the lists of those to be tried.
pub(crate) struct Candidates {
    /// The local limit that would have admitted it, or less: 0 when nothing is known, infinite when
    /// it was impossible or the vertex is gone.
    needed: Vec<f32>,
    /// The global error of its removal, or less where it was above the limit; 0 when nothing is
    /// known.
    found: Vec<f32>,
    /// Last round in which the vertex or a neighbour of it was picked.
    picked: Vec<u32>,
    /// The current round.
    round: u32,
    /// Vertices that may still be removed.
    open: Vec<u32>,
    /// Vertices below the limits of this iteration and above the ceiling, or left over below it.
    waiting: Waiting,
    /// Vertices above the last limits whose star has changed since they were tried: no later
    /// iteration will try them again.
    changed: Vec<u32>,
}

/// The part of an iteration under one ceiling.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stage {
    /// The limits of the iteration.
    pub limits: Limits,
    /// Most that a removal may err now, at most the global limit.
    pub ceiling: f64,
    /// Ceilings of the iteration before this one.
    pub step: usize,
    /// Whether no other iteration follows.
    pub is_last: bool,
}

impl Candidates {
    /// Nothing known yet, of a mesh of `n_vertices`.
    pub(crate) fn new(n_vertices: usize) -> Self {
        Self {
            needed: vec![0.0; n_vertices],
            found: vec![0.0; n_vertices],
            picked: vec![0; n_vertices],
            round: 0,
            open: (0..).take(n_vertices).collect(),
            waiting: Waiting::default(),
            changed: vec![],
        }
    }

    /// Lists every vertex that the limits may admit under the first of the rising `ceilings` that
    /// admits it. Drops vertices that are gone.
    pub(crate) fn admit(&mut self, limits: Limits, ceilings: Vec<f64>, surface: &Surface) {
        let Self { needed, found, open, waiting, .. } = self;
        open.retain(|&v| !surface.star(v).is_empty());
        *waiting = Waiting::new(ceilings);
        for &v in open.iter().filter(|&&v| is_admitted(needed[v as usize], limits)) {
            waiting.add(v, found[v as usize]);
        }
    }

    /// Vertices that may still be removed, and those that were since the last iteration began.
    pub(crate) fn open(&self) -> &[u32] {
        &self.open
    }

    /// The least local limit that could admit anything.
    pub(crate) fn least_needed(&self) -> f64 {
        self.open.iter().map(|&v| f64::from(self.needed[v as usize])).fold(f64::INFINITY, f64::min)
    }

    /// Forgets what is known of the given vertices and their neighbours, all alive.
    pub(crate) fn forget_around(&mut self, surface: &Surface, vertices: &[u32]) {
        for &v in vertices {
            for &slot in surface.star(v) {
                surface.corners(slot).into_iter().for_each(|neighbour| self.forget(neighbour));
            }
        }
    }

    /// Those above the last limits whose star changed since they were tried, with nothing known of
    /// them. In ascending order, each once.
    pub(crate) fn take_changed(&mut self) -> Vec<u32> {
        let mut changed = std::mem::take(&mut self.changed);
        changed.par_sort_unstable();
        changed.dedup();
        changed.retain(|&v| self.needed[v as usize].is_finite());
        changed.iter().for_each(|&v| self.forget(v));
        changed
    }

    /// Takes the vertices below the ceiling off their list, in ascending order: neighbours in it
    /// are neighbours on the surface.
    pub(crate) fn take_below(&mut self, stage: Stage) -> Vec<u32> {
        let mut below = self.waiting.take(stage.step);
        self.retain_below(stage, &mut below);
        below.par_sort_unstable();
        below.dedup();
        below
    }

    /// Lists the vertices under the next ceiling.
    pub(crate) fn put_off(&mut self, stage: Stage, vertices: Vec<u32>) {
        self.waiting.add_all(stage.step + 1, vertices);
    }

    /// Records that the stars of `touched` have changed; returns those that may be tried under
    /// these limits.
    pub(crate) fn touch(&mut self, Stage { limits, is_last, .. }: Stage, mut touched: Vec<u32>) -> Vec<u32> {
        touched.retain(|&v| {
            let needed = self.needed[v as usize];
            if needed.is_infinite() {
                self.forget(v);
            }
            let is_above = needed.is_finite() && f64::from(needed) > limits.local;
            if is_above && is_last {
                self.changed.push(v);
            }
            !is_above
        });
        touched
    }

    /// The given vertices below the ceiling, each once, in the order of the errors last found; ties
    /// go to the lower vertex.
    #[expect(clippy::cast_possible_truncation, reason = "the lower half of a key is the vertex")]
    pub(crate) fn sort_out(&mut self, stage: Stage, mut vertices: Vec<u32>) -> Vec<u32> {
        self.retain_below(stage, &mut vertices);
        // The bits of what is not negative are in its order.
        let key = |v: u32| u64::from(self.found[v as usize].to_bits()) << u32::BITS | u64::from(v);
        let mut keys: Vec<u64> = vertices.into_iter().map(key).collect();
        keys.sort_unstable();
        keys.dedup();
        keys.into_iter().map(|key| key as u32).collect()
    }

    /// Keeps the vertices below the ceiling. Those above it wait, or are left to a later iteration.
    fn retain_below(&mut self, Stage { limits, ceiling, .. }: Stage, vertices: &mut Vec<u32>) {
        let Self { needed, found, waiting, .. } = self;
        vertices.retain(|&v| {
            let is_within = is_admitted(needed[v as usize], limits);
            let is_below = f64::from(found[v as usize]) <= ceiling;
            if is_within && !is_below {
                waiting.add(v, found[v as usize]);
            }
            is_within && is_below
        });
    }

    /// Begins a round, in which nothing is picked yet.
    pub(crate) fn start_round(&mut self) {
        self.round += 1;
    }

    /// Picks the next vertices of the worklist, `n_most` at most and no two of the round
    /// neighbours, and takes them off it. The first of two neighbours is picked; vertices passed
    /// over go to `left`.
    pub(crate) fn pick(
        &mut self,
        surface: &Surface,
        n_most: usize,
        worklist: &mut &[u32],
        left: &mut Vec<u32>,
    ) -> Vec<u32> {
        let Self { picked, round, .. } = self;
        let mut batch = vec![];
        while let (true, [v, rest @ ..]) = (batch.len() < n_most, *worklist) {
            *worklist = rest;
            if picked[*v as usize] == *round {
                left.push(*v);
                continue;
            }
            batch.push(*v);
            for &slot in surface.star(*v) {
                surface.corners(slot).iter().for_each(|&r| picked[r as usize] = *round);
            }
        }
        batch
    }

    /// Records what a vertex needs.
    pub(crate) fn set_refusal(&mut self, v: u32, refusal: Refusal, c2: f64) {
        let (needed, found) = match refusal {
            Refusal::Above(errors) => {
                let found = round_up(errors.global);
                // What is beyond `f32` is beyond every limit.
                let is_known = found.is_finite();
                let needed =
                    if is_known { round_up(errors.local.max(errors.global / c2)) } else { f32::INFINITY };
                (needed, if is_known { found } else { 0.0 })
            }
            Refusal::Impossible => (f32::INFINITY, 0.0),
        };
        self.needed[v as usize] = needed;
        self.found[v as usize] = found;
    }

    fn forget(&mut self, v: u32) {
        self.needed[v as usize] = 0.0;
        self.found[v as usize] = 0.0;
    }
}

/// Whether what a vertex needs is within the limits. What is impossible is not, even without
/// limits.
fn is_admitted(needed: f32, limits: Limits) -> bool {
    needed.is_finite() && f64::from(needed) <= limits.local
}

/// Vertices that wait for a ceiling of the iteration.
#[derive(Clone, Debug, Default)]
struct Waiting {
    /// In ascending order.
    ceilings: Vec<f64>,
    /// For each of them; a vertex may be in several.
    lists: Vec<Vec<u32>>,
}

impl Waiting {
    fn new(ceilings: Vec<f64>) -> Self {
        Self { lists: vec![vec![]; ceilings.len()], ceilings }
    }

    /// Lists `v` under the first ceiling that is no lower than `error`. If there is none, a later
    /// iteration will admit it.
    fn add(&mut self, v: u32, error: f32) {
        // Counted, not searched: a search would branch on what cannot be predicted.
        let step = self.ceilings.iter().filter(|&&ceiling| ceiling < f64::from(error)).count();
        if let Some(list) = self.lists.get_mut(step) {
            list.push(v);
        }
    }

    /// Lists the vertices under one ceiling, if it exists.
    fn add_all(&mut self, step: usize, vertices: Vec<u32>) {
        if let Some(list) = self.lists.get_mut(step) {
            list.extend(vertices);
        }
    }

    /// Takes the list of one ceiling.
    fn take(&mut self, step: usize) -> Vec<u32> {
        self.lists.get_mut(step).map(std::mem::take).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bound::Errors;
    use crate::generate::torus;
    use std::collections::BTreeSet;

    const CEILINGS: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

    fn stage(step: usize) -> Stage {
        let limits = Limits { local: 4.0, global: 4.0 };
        Stage { limits, ceiling: CEILINGS[step], step, is_last: false }
    }

    /// Candidates of a torus of which every vertex `v` is known to err by `v` eighths, from 2 on.
    fn some() -> (Surface, Candidates) {
        let mesh = torus(8, 6);
        let surface = Surface::new(mesh.positions, mesh.triangles);
        let mut candidates = Candidates::new(surface.n_vertices());
        for v in 2..48 {
            let error = f64::from(v) / 8.0;
            candidates.set_refusal(v, Refusal::Above(Errors { local: 0.0, global: error }), 1.0);
        }
        candidates.set_refusal(1, Refusal::Impossible, 1.0);
        candidates.admit(stage(0).limits, CEILINGS.to_vec(), &surface);
        (surface, candidates)
    }

    #[test]
    fn vertices_wait_for_the_first_ceiling_that_admits_them() {
        let (_, mut candidates) = some();
        let taken: Vec<Vec<u32>> = (0..4).map(|step| candidates.take_below(stage(step))).collect();
        let expected = [
            [0].into_iter().chain(2..9).collect(),
            Vec::from_iter(9..17),
            (17..25).collect(),
            (25..33).collect(),
        ];
        assert_eq!(taken, expected);
    }

    #[test]
    fn what_is_put_off_or_has_become_worse_is_not_lost() {
        let (_, mut candidates) = some();
        let mut below = candidates.take_below(stage(0));
        let put_off = below.split_off(4);
        candidates.put_off(stage(0), put_off.clone());
        candidates.set_refusal(0, Refusal::Above(Errors { local: 0.0, global: 3.5 }), 1.0);
        candidates.set_refusal(9, Refusal::Above(Errors { local: 0.0, global: 2.5 }), 1.0);
        assert_eq!(candidates.sort_out(stage(0), below.clone()), &below[1..]);
        let second = candidates.take_below(stage(1));
        assert_eq!(second, put_off.into_iter().chain(10..17).collect::<Vec<_>>());
        assert!(candidates.take_below(stage(2)).contains(&9));
        assert!(candidates.take_below(stage(3)).contains(&0));
        // Behind the last ceiling a later iteration admits them again.
        candidates.put_off(stage(3), vec![32]);
        assert!(candidates.open().contains(&32));
    }

    #[test]
    fn a_round_picks_no_two_neighbours_and_leaves_nobody_out() {
        let (surface, mut candidates) = some();
        candidates.start_round();
        let all: Vec<u32> = (0..48).collect();
        let (mut worklist, mut left, mut batches) = (all.as_slice(), vec![], vec![]);
        while !worklist.is_empty() {
            batches.push(candidates.pick(&surface, 3, &mut worklist, &mut left));
        }
        assert!(batches.iter().all(|batch| batch.len() <= 3));
        let picked: BTreeSet<u32> = batches.into_iter().flatten().collect();
        let is_neighbour = |a: u32, b: u32| a != b && surface.n_faces(a, b) > 0;
        assert!(picked.iter().all(|&a| !picked.iter().any(|&b| is_neighbour(a, b))));
        assert!(left.iter().all(|&a| picked.iter().any(|&b| is_neighbour(a, b))));
        assert_eq!(picked.len() + left.len(), all.len());
    }
}
