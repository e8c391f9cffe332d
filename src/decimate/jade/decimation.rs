//! The state of a decimation between two removals.

use super::candidate::{Scratch, Situation};
use super::placement::Moves;
use crate::bound::GlobalError;
use crate::history::{History, Recorder};
use crate::mesh::{Seams, Surface};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a decimation works on, and what it has done so far.
pub struct Decimation {
    /// The current mesh; its vertices are points.
    pub surface: Surface,
    /// Its seams, if it has any.
    pub seams: Option<Seams>,
    /// Vertex of the input for each vertex of `surface`.
    pub numbers: Vec<u32>,
    /// Vertex of the history for each vertex of `surface`, where vertices move and there are no seams to tell it. Where they do not move
    /// the history has the numbers of `surface` until it is finished: there, neighbours are near and take less memory.
    pub names: Option<Vec<u32>>,
    /// Its errors.
    pub error: GlobalError,
    /// The history so far.
    pub recorder: Recorder,
    /// Cosine of the feature angle.
    pub cos_feature_angle: f64,
    /// See [`super::JadeOptions::aspect_loss`].
    pub aspect_loss: f64,
    /// See [`super::JadeOptions::c2`].
    pub c2: f64,
    /// Vertices that were born, where they may move.
    pub moves: Option<Moves>,
    /// Buffers of the threads.
    pub workers: Workers,
}

impl Decimation {
    /// What candidates are judged by.
    pub(super) fn situation(&self) -> Situation<'_> {
        Situation {
            surface: &self.surface,
            seams: self.seams.as_ref(),
            names: self.names.as_deref(),
            error: &self.error,
            cos_feature_angle: self.cos_feature_angle,
            aspect_loss: self.aspect_loss,
        }
    }

    /// Closes up the slots once many are empty; cheap enough to call after every round.
    pub(super) fn close_up(&mut self) {
        let Self { surface, seams, error, recorder, .. } = self;
        let Some(slots) = surface.close_up() else { return };
        let renumber_recorder = || {
            recorder.renumber_slots(&slots);
            if let Some(seams) = seams {
                seams.renumber_slots(&slots);
            }
        };
        rayon::join(|| error.renumber_slots(&slots), renumber_recorder);
    }

    /// The history, with what is still alive. Everything else is let go before it is laid out.
    pub fn finish(self) -> Finished {
        let Self { surface, seams, numbers, names, error, recorder, moves, workers, .. } = self;
        drop((error, workers));
        let alive: Vec<(u32, [u32; 3])> = surface
            .iter()
            .map(|(slot, _)| (slot, named_corners(&surface, seams.as_ref(), names.as_deref(), slot)))
            .collect();
        let is_named = seams.is_some() || names.is_some();
        drop((seams, names));
        let positions = surface.into_positions();
        let positions = moves.is_none().then(|| by_number(&numbers, &positions));
        let mut history = recorder.finish(&alive);
        if !is_named {
            history.vertex_death = by_number(&numbers, &history.vertex_death);
            history.simplices.as_flattened_mut().iter_mut().for_each(|v| *v = numbers[*v as usize]);
        }
        Finished { history, moves, positions }
    }
}

/// What a decimation leaves.
pub struct Finished {
    /// Every triangle that ever lived.
    pub history: History,
    /// Vertices that moved.
    pub moves: Option<Moves>,
    /// Positions of the vertices of the input, if none could move.
    pub positions: Option<Vec<[f32; 3]>>,
}

/// Puts what belongs to each vertex where its number says; the numbers are those of the places in another order.
fn by_number<T: Copy + Default>(numbers: &[u32], of_vertices: &[T]) -> Vec<T> {
    let mut arranged = vec![T::default(); of_vertices.len()];
    for (&number, &item) in numbers.iter().zip(of_vertices) {
        arranged[number as usize] = item;
    }
    arranged
}

/// The vertices of the history at the corners of the triangle in `slot`, as they are recorded.
pub(super) fn named_corners(
    surface: &Surface,
    seams: Option<&Seams>,
    names: Option<&[u32]>,
    slot: u32,
) -> [u32; 3] {
    match (seams, names) {
        (Some(seams), _) => seams.corners(slot),
        (None, Some(names)) => surface.corners(slot).map(|v| names[v as usize]),
        (None, None) => surface.corners(slot),
    }
}

/// Buffers for judging, one set per thread of the pool and one for the caller.
#[derive(Default)]
pub struct Workers {
    scratches: Vec<Mutex<Scratch>>,
}

impl Workers {
    /// Buffers for the current rayon pool.
    pub fn new() -> Self {
        Self { scratches: (0..=rayon::current_num_threads()).map(|_| Mutex::default()).collect() }
    }

    /// This thread's buffers. A thread never asks for them twice at once, so it never waits.
    pub(super) fn scratch(&self) -> MutexGuard<'_, Scratch> {
        let last = self.scratches.len() - 1;
        let own = rayon::current_thread_index().unwrap_or(last).min(last);
        self.scratches[own].lock().unwrap_or_else(PoisonError::into_inner)
    }
}
