//! Goes through a history that ends with nothing, step by step, and checks that each mesh is valid.

#![allow(clippy::cast_possible_truncation, reason = "counts of a build are u32")]

use nephrite::{Build, EventKind, NEVER};
use std::collections::{HashMap, HashSet};

/// Tells `fail` the first thing that is wrong: a coordinate that is not finite, an index out of
/// range, a corner or a triangle twice, a count that rises or falls by more than two, two triangles
/// that disagree about an edge although all of the input agreed and nothing has been attached yet,
/// or triangles that are left at the end. Returns the number of steps.
pub fn check(build: &Build, fail: impl Fn(String)) -> usize {
    let history = build.history();
    if let Err(error) = history.check() {
        fail(error.to_string());
    }
    let n_vertices = build.vertices().positions.len();
    if !build.vertices().positions.as_flattened().iter().all(|x| x.is_finite()) {
        fail("a coordinate is not finite".to_owned());
    }
    if history.simplices.as_flattened().iter().any(|&v| v as usize >= n_vertices) {
        fail("an index is out of range".to_owned());
    }
    let n_steps = history.errors.len();
    let (mut births, mut deaths) = (vec![vec![]; n_steps], vec![vec![]; n_steps]);
    for (simplex, (&birth, &death)) in history.birth.iter().zip(&history.death).enumerate() {
        births[birth as usize].push(simplex);
        if death != NEVER {
            deaths[death as usize].push(simplex);
        }
    }
    let first_attached = first_attachment(build);
    let mut alive = HashSet::new();
    let mut edges = Edges::default();
    let mut is_oriented = true;
    let mut n_before = usize::MAX;
    for step in 0..n_steps {
        for &simplex in &deaths[step] {
            let triangle = history.simplices[simplex];
            if !alive.remove(&key(triangle)) {
                fail(format!("{triangle:?} dies at step {step} and was not there"));
            }
            edges.remove(triangle);
        }
        for &simplex in &births[step] {
            let triangle = history.simplices[simplex];
            let [a, b, c] = triangle;
            if a == b || b == c || c == a {
                fail(format!("{triangle:?} at step {step}"));
            }
            if !alive.insert(key(triangle)) {
                fail(format!("{triangle:?} is there twice at step {step}"));
            }
            edges.add(triangle);
        }
        is_oriented &= step > 0 || edges.n_shared == 0;
        if is_oriented && (step as u32) < first_attached && edges.n_shared > 0 {
            fail(format!("orientation is lost at step {step}"));
        }
        let n = alive.len();
        if n > n_before || (n_before != usize::MAX && n_before - n > 2) {
            fail(format!("{n} triangles after {n_before} at step {step}"));
        }
        n_before = n;
    }
    if !alive.is_empty() {
        fail(format!("{} triangles are left", alive.len()));
    }
    n_steps
}

/// Step of the first event that may bring edges of any orientation together.
fn first_attachment(build: &Build) -> u32 {
    let events = build.progressive().into_iter().flat_map(|report| &report.events.events);
    let kinds = [EventKind::Attached, EventKind::HoleClosed];
    events.filter(|event| kinds.contains(&event.kind)).map(|event| event.step).next().unwrap_or(u32::MAX)
}

/// Edges in the directions in which triangles run along them.
#[derive(Default)]
struct Edges {
    uses: HashMap<[u32; 2], u32>,
    /// Directed edges of several triangles.
    n_shared: usize,
}

impl Edges {
    fn add(&mut self, [a, b, c]: [u32; 3]) {
        for edge in [[a, b], [b, c], [c, a]] {
            let uses = self.uses.entry(edge).or_default();
            *uses += 1;
            self.n_shared += usize::from(*uses == 2);
        }
    }

    fn remove(&mut self, [a, b, c]: [u32; 3]) {
        for edge in [[a, b], [b, c], [c, a]] {
            if let Some(uses) = self.uses.get_mut(&edge) {
                self.n_shared -= usize::from(*uses == 2);
                *uses -= 1;
                if *uses == 0 {
                    self.uses.remove(&edge);
                }
            }
        }
    }
}

/// The triangle from its smallest corner on, in its orientation.
fn key(triangle: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = triangle;
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
