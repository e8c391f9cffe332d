//! Distances between surfaces: known answers, brute force, bad input, and the same numbers on any
//! number of threads.

#![allow(missing_docs, clippy::unwrap_used, reason = "tests")]

mod bad_input;
mod brute_force;
mod known_answers;
mod meshes;
#[path = "../support/space.rs"]
mod space;
mod threads;
