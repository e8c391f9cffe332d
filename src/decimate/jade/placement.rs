//! Vertices that stay move to where the error is least, between removals.
//!
//! On a smooth surface the vertices of the input lie on one side of every coarser level, and half
//! of its error is that offset. So whenever the mesh has become smaller by a good part, each vertex
//! goes where the largest displacement of what is mapped onto its star is least; removals then find
//! room under the same limit. No displacement grows, so the error of the mesh stays as proven. A
//! vertex that moved is a new one in the history: its star dies and is born again. Vertices of the
//! boundary and of seams stay where they are, and no vertex leaves the bounding box of the input.

use super::best_place::best_place;
use super::candidate::Scratch;
use super::state::State;
use super::validity::{WORST_ASPECT, aspect, worst_star_aspect};
use crate::bound::GlobalError;
use crate::bound::certified::images::largest_sq;
use crate::geometry::vector::{Vector, cross, dot, length_sq, sub};
use crate::mesh::Hole;
use rayon::prelude::*;

/// Vertices move once the mesh has at most this part of the triangles that it had when they last
/// did.
const DUE: f64 = 0.9;

/// A move must bring the largest displacement of its star down to this part.
const GAIN: f64 = 0.97;

/// Squared cosine of the angle by which a triangle's normal may turn in one move.
const TURN_COS_SQ: f64 = 0.75;

/// Whether vertices may move and the mesh is enough smaller than when they last did.
pub(crate) fn is_due(state: &State) -> bool {
    let n_triangles = state.surface.n_triangles() as f64;
    state.moves.as_ref().is_some_and(|moves| n_triangles <= DUE * moves.n_triangles_last as f64)
}

/// Moves each vertex of `open` that gains by it, as one step of the history, and returns those that
/// moved.
///
/// Vertices of one colour share no triangle: their places are found in parallel, whatever the
/// number of threads.
pub(crate) fn improve(state: &mut State, open: &[u32]) -> Vec<u32> {
    let mut moved = vec![];
    for of_colour in colours(state, open) {
        let find = |&v: &u32| Some((v, place_of(state, v, &mut state.workers.scratch())?));
        let places: Vec<(u32, [f32; 3])> = of_colour.par_iter().filter_map(find).collect();
        for (v, place) in places {
            state.surface.move_vertex(v, place);
            moved.push(v);
        }
    }
    record(state, &moved);
    moved
}

/// Vertices in classes, no two neighbours in one; greedy, in the order given.
fn colours(state: &State, open: &[u32]) -> Vec<Vec<u32>> {
    const NONE: u8 = u8::MAX;
    let surface = &state.surface;
    let mut colour_of = vec![NONE; surface.n_vertices()];
    let mut classes: Vec<Vec<u32>> = vec![];
    for &v in open {
        let mut taken = [false; NONE as usize];
        for &slot in surface.star(v) {
            for neighbour in surface.corners(slot) {
                if let Some(taken) = taken.get_mut(usize::from(colour_of[neighbour as usize])) {
                    *taken = true;
                }
            }
        }
        // A vertex among neighbours of all colours stays where it is.
        let Some(free) = (0..NONE).find(|&colour| !taken[usize::from(colour)]) else { continue };
        colour_of[v as usize] = free;
        let class = usize::from(free);
        if class == classes.len() {
            classes.push(vec![]);
        }
        classes[class].push(v);
    }
    classes
}

/// The best place for `v`, if it may move and gains enough.
fn place_of(state: &State, v: u32, scratch: &mut Scratch) -> Option<[f32; 3]> {
    let State { surface, names, error: GlobalError::Certified(certified), moves: Some(moves), .. } = state
    else {
        return None;
    };
    let Scratch { hole, images, .. } = scratch;
    let can_move = names.is_single(surface, v)
        && hole.gather(surface, v).is_ok()
        && hole.closed
        && certified.images_at(surface, v, images);
    if !can_move {
        return None;
    }
    let start_sq = largest_sq(images, hole.apex);
    let start = surface.positions()[v as usize];
    let (place, largest_sq) = best_place(images, start, moves.bounds, |place| keeps_shape(hole, place))?;
    (largest_sq <= GAIN * GAIN * start_sq).then_some(place)
}

/// Whether the star of `hole` still faces the same way and is well shaped with its vertex at
/// `place`.
fn keeps_shape(hole: &Hole, place: Vector) -> bool {
    let worst = WORST_ASPECT.min(worst_star_aspect(hole));
    (0..hole.slots.len()).all(|i| {
        let [_, a, b] = hole.triangle(i);
        let (old, new) = (hole.normal(i), cross(sub(a, place), sub(b, place)));
        let along = dot(old, new);
        along > 0.0
            && along * along >= TURN_COS_SQ * length_sq(old) * length_sq(new)
            && aspect(&[place, a, b]) >= worst
    })
}

/// Writes the moves down: the stars of the old vertices die, those of the new ones are born.
fn record(state: &mut State, moved: &[u32]) {
    let State { surface, names, moves: Some(moves), recorder, .. } = state else { return };
    moves.n_triangles_last = surface.n_triangles();
    if moved.is_empty() {
        return;
    }
    recorder.step(recorder.error());
    let mut slots: Vec<u32> = moved.iter().flat_map(|&v| surface.star(v)).copied().collect();
    slots.sort_unstable();
    slots.dedup();
    for &slot in &slots {
        recorder.death(slot, names.corners(surface, slot));
    }
    for &v in moved {
        let new = recorder.vertex();
        let old = names.rename(surface, v, new);
        moves.born.push((old, surface.positions()[v as usize]));
    }
    slots.iter().for_each(|&slot| recorder.birth(slot));
}
