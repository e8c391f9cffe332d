//! Removals that go together: planned in parallel on the same mesh, and carried out at once.

#![expect(clippy::vec_box, reason = "a plan is large, and moves from list to list")]

use super::candidate::Refusal;
use super::removal::{Plan, plan};
use super::state::State;
use crate::bound::Limits;
use crate::mesh::TooMany;
use rayon::prelude::*;

/// Most candidates that one thread takes at a time.
const CHUNK: usize = 16;

/// Chunks for each thread, if there are enough candidates: the last ones of a history stand for
/// thousands of input vertices each, and small chunks let idle threads steal work.
const CHUNKS_PER_THREAD: usize = 16;

/// What was found of some candidates.
#[derive(Clone, Debug)]
pub(crate) struct Judged {
    /// Of those within the limits.
    pub plans: Vec<Box<Plan>>,
    /// Of the others.
    pub refusals: Vec<(u32, Refusal)>,
}

/// Plans the removal of every vertex of the batch under `limits`, in parallel. In order, a few
/// together.
pub(crate) fn plan_all(state: &State, limits: Limits, batch: &[u32]) -> Vec<Judged> {
    let situation = state.situation();
    let plan_chunk = |chunk: &[u32]| {
        let mut scratch = state.workers.scratch();
        let mut judged = Judged { plans: vec![], refusals: Vec::with_capacity(chunk.len()) };
        for &v in chunk {
            match plan(situation, v, limits, &mut scratch) {
                Ok(plan) => judged.plans.push(plan),
                Err(refusal) => judged.refusals.push((v, refusal)),
            }
        }
        judged
    };
    // A job each: rayon would tie several together, and the thread that takes the last of these
    // would keep the others waiting.
    batch.par_chunks(chunk_len(batch.len())).with_max_len(1).map(plan_chunk).collect()
}

/// Length of the chunks into which `n` candidates are cut for the current pool.
fn chunk_len(n: usize) -> usize {
    (n / (CHUNKS_PER_THREAD * rayon::current_num_threads())).clamp(1, CHUNK)
}

/// Carries the plans out, which are [independent](Claims::take_independent) of each other, one step
/// each.
///
/// # Errors
///
/// When the errors have no room for them; nothing has changed then.
pub(crate) fn carry_out(state: &mut State, plans: &[Box<Plan>]) -> Result<(), TooMany> {
    let State { surface, names, error, recorder, .. } = state;
    let changes = plans.iter().map(|plan| plan.change());
    error.check_room(changes.clone())?;
    let change_surface = || plans.iter().for_each(|plan| surface.fill(&plan.hole, &plan.filling));
    let record = || {
        plans.iter().for_each(|plan| plan.record(recorder));
        plans.iter().for_each(|plan| plan.name_filling(names));
    };
    rayon::join(|| error.apply_all(changes), || rayon::join(change_surface, record));
    rayon::join(|| error.compact(), || surface.compact());
    Ok(())
}

/// What plans of one batch change outside their own stars. A later plan that changes the same has
/// been overtaken.
///
/// New edges and triangles have few bits for many of them, so that now and then one counts as
/// claimed that is not.
#[derive(Clone, Debug, Default)]
pub(crate) struct Claims {
    /// A bit for each source edge.
    moved: NumberSet,
    /// A bit for each [`key`] of an edge or a triangle.
    made: NumberSet,
}

impl Claims {
    /// Takes those plans that are independent of all before them, and gives the vertices of the
    /// others.
    pub(crate) fn take_independent(&mut self, plans: Vec<Box<Plan>>) -> (Vec<Box<Plan>>, Vec<u32>) {
        let (independent, overtaken): (Vec<_>, Vec<_>) = plans.into_iter().partition(|plan| self.claim(plan));
        self.clear();
        (independent, overtaken.into_iter().map(|plan| plan.hole.removed).collect())
    }

    /// Whether the plan is independent of all that was claimed so far: no other plan makes one of
    /// its edges or its only triangle, or moves a source edge that it moves. If so, claims what it
    /// changes.
    fn claim(&mut self, plan: &Plan) -> bool {
        let is_independent =
            made(plan).all(|key| !self.made.has(key)) && moved(plan).all(|edge| !self.moved.has(edge));
        // Only then: a plan may well have two edges with one key, and is not overtaken by itself.
        if is_independent {
            made(plan).for_each(|key| self.made.insert(key));
            moved(plan).for_each(|edge| self.moved.insert(edge));
        }
        is_independent
    }

    /// Takes back all claims.
    fn clear(&mut self) {
        self.moved.clear();
        self.made.clear();
    }
}

/// Source edges that the plan moves.
fn moved(plan: &Plan) -> impl Iterator<Item = u32> {
    plan.change().1.moved_edges()
}

/// Keys of the edges that the plan makes, and of its triangle where that is the only one.
fn made(plan: &Plan) -> impl Iterator<Item = u32> {
    plan.new_edges().map(|edge| key(&edge)).chain(plan.lid().map(|lid| key(&lid)))
}

/// The same number below 2^18 for the same vertices, hardly ever the same for others.
fn key(vertices: &[u32]) -> u32 {
    const ODD: u32 = 0x9e37_79b1;
    vertices.iter().fold(0, |key: u32, v| (key.rotate_left(5) ^ v).wrapping_mul(ODD)) >> 14
}

/// A set of numbers, a bit each.
#[derive(Clone, Debug, Default)]
struct NumberSet {
    bits: Vec<u64>,
    members: Vec<u32>,
}

impl NumberSet {
    #[inline]
    fn has(&self, number: u32) -> bool {
        let (word, bit) = place(number);
        self.bits.get(word).is_some_and(|bits| bits & bit != 0)
    }

    #[inline]
    fn insert(&mut self, number: u32) {
        let (word, bit) = place(number);
        if word >= self.bits.len() {
            self.bits.resize(word + 1, 0);
        }
        self.bits[word] |= bit;
        self.members.push(number);
    }

    /// Takes out all numbers. O(numbers).
    fn clear(&mut self) {
        for number in self.members.drain(..) {
            self.bits[place(number).0] = 0;
        }
    }
}

/// The word in which a number has its bit, and that bit.
fn place(number: u32) -> (usize, u64) {
    ((number / u64::BITS) as usize, 1 << (number % u64::BITS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bound::GlobalError;
    use crate::bound::certified::Certified;
    use crate::decimate::jade::candidate::{Scratch, Situation};
    use crate::decimate::jade::names::Names;
    use crate::decimate::jade::options::Placement;
    use crate::generate::{sphere, torus};
    use crate::mesh::{Numbering, Surface};
    use nephrite_formats::TriangleMesh;
    use std::collections::HashSet;

    /// Two pyramids on one triangle, and on one square.
    fn bipyramid(corners: u32) -> TriangleMesh {
        let around = (0..corners).map(|i| std::f32::consts::TAU * i as f32 / corners as f32);
        let mut positions: Vec<[f32; 3]> = around.map(|angle| [angle.cos(), angle.sin(), 0.0]).collect();
        positions.extend([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]);
        let sides = (0..corners).map(|i| (i, (i + 1) % corners));
        let triangles = sides.flat_map(|(i, j)| [[i, j, corners], [j, i, corners + 1]]).collect();
        TriangleMesh { positions, triangles, ..TriangleMesh::default() }
    }

    /// Plans for vertices of which no two are neighbours, the last ones first: of a bipyramid the
    /// two tops.
    fn plan_independent(surface: &Surface, error: &GlobalError) -> Vec<Plan> {
        let names = Names::new(Numbering::along_curve(surface.positions()), None, Placement::Original);
        let situation =
            Situation { surface, names: &names, error, cos_feature_angle: -1.0, aspect_loss: 0.5 };
        let mut scratch = Scratch::default();
        let mut picked = HashSet::new();
        let mut plans = vec![];
        for v in (0..u32::try_from(surface.n_vertices()).unwrap()).rev() {
            if picked.contains(&v) {
                continue;
            }
            picked.extend(surface.star(v).iter().flat_map(|&slot| surface.corners(slot)));
            plans.extend(plan(situation, v, Limits::NONE, &mut scratch).map(|plan| *plan));
        }
        plans
    }

    fn in_common<T: Eq + std::hash::Hash>(a: impl Iterator<Item = T>, b: impl Iterator<Item = T>) -> bool {
        let a: HashSet<T> = a.collect();
        b.into_iter().any(|item| a.contains(&item))
    }

    fn overlap(a: &Plan, b: &Plan) -> bool {
        in_common(a.new_edges(), b.new_edges())
            || in_common(a.lid().into_iter(), b.lid().into_iter())
            || in_common(moved(a), moved(b))
    }

    #[test]
    fn plans_that_are_carried_out_at_once_have_nothing_in_common() {
        let mut n_overtaken = 0;
        let meshes = [bipyramid(3), bipyramid(4), sphere(1), sphere(2), sphere(6), torus(4, 4), torus(7, 5)];
        for mesh in meshes {
            let mut surface = Surface::new(mesh.positions, mesh.triangles);
            let error = GlobalError::Certified(Certified::new(&surface, 0.0));
            let mut claims = Claims::default();
            let (claimed, overtaken): (Vec<_>, Vec<_>) =
                plan_independent(&surface, &error).into_iter().partition(|plan| claims.claim(plan));
            assert!(!claimed.is_empty());
            for (at, plan) in claimed.iter().enumerate() {
                assert!(claimed[..at].iter().all(|earlier| !overlap(earlier, plan)));
                // What the plan was made for is still so.
                assert!(plan.new_edges().all(|[a, b]| surface.n_faces(a, b) == 0));
                assert!(plan.lid().is_none_or(|lid| !surface.has_triangle(lid)));
                surface.fill(&plan.hole, &plan.filling);
            }
            assert!(overtaken.iter().all(|plan| claimed.iter().any(|earlier| overlap(earlier, plan))));
            n_overtaken += overtaken.len();
            claims.clear();
            assert!(overtaken.first().is_none_or(|plan| claims.claim(plan)));
        }
        assert!(n_overtaken > 1, "the two tops of a bipyramid close up in the same triangle");
    }
}
