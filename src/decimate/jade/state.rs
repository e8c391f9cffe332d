//! The mesh in the middle of its decimation, with all that is kept beside it.

use super::candidate::{Scratch, Situation};
use super::names::Names;
use super::options::{JadeOptions, Placement};
use crate::bound::GlobalError;
use crate::decimate::{Decimated, Input, add_copies};
use crate::geometry::bounds::Bounds;
use crate::history::Recorder;
use crate::mesh::{Numbering, Repaired, Surface, Wedges};
use nephrite_formats::TriangleMesh;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a decimation works on, and what it has done so far.
pub(crate) struct State {
    /// The current mesh.
    pub surface: Surface,
    /// What its vertices are called in input and history.
    pub names: Names,
    /// Its errors.
    pub error: GlobalError,
    /// The history so far.
    pub recorder: Recorder,
    /// Cosine of the feature angle.
    pub cos_feature_angle: f64,
    /// Constants of the algorithm.
    pub options: JadeOptions,
    /// Vertices that were born, if vertices may move.
    pub moves: Option<Moves>,
    /// Buffers of the threads.
    pub workers: Workers,
    /// The input without its triangles, and without its positions if no vertex may move.
    rest: TriangleMesh,
}

impl State {
    /// The state at step 0. O(n log n).
    pub(super) fn new(input: Input<Repaired>, options: &JadeOptions) -> Self {
        let Input { mesh, cos_feature_angle, lock_boundary, .. } = input;
        let Repaired { mesh: mut rest, points, looks, .. } = mesh;
        let numbering = Numbering::along_curve(&rest.positions);
        let mut triangles = std::mem::take(&mut rest.triangles);
        numbering.sort_triangles(&mut triangles);
        let moves = match options.placement() {
            Placement::Original => None,
            Placement::Best => Some(Moves::new(&rest.positions, triangles.len())),
        };
        let (mut triangles, wedges) = Wedges::part(triangles, points, looks);
        triangles.as_flattened_mut().iter_mut().for_each(|v| *v = numbering.place(*v));
        let positions = numbering.arrange(&rest.positions);
        if moves.is_none() {
            rest.positions = vec![];
        }
        let mut surface = Surface::new(positions, triangles);
        if lock_boundary {
            surface.lock_boundary();
        }
        Self {
            error: GlobalError::new(options.estimate_kind(), &surface, rest.rounding),
            recorder: Recorder::new(surface.n_slots(), surface.n_vertices(), rest.rounding),
            surface,
            names: Names::new(numbering, wedges, options.placement()),
            cos_feature_angle,
            options: *options,
            moves,
            workers: Workers::new(),
            rest,
        }
    }

    /// What candidates are judged by.
    pub(super) fn situation(&self) -> Situation<'_> {
        Situation {
            surface: &self.surface,
            names: &self.names,
            error: &self.error,
            cos_feature_angle: self.cos_feature_angle,
            aspect_loss: self.options.aspect_loss(),
        }
    }

    /// Closes up the slots once many are empty; cheap enough to call after every round.
    pub(super) fn close_up(&mut self) {
        let Self { surface, names, error, recorder, .. } = self;
        let Some(slots) = surface.close_up() else { return };
        let renumber_recorder = || {
            recorder.renumber_slots(&slots);
            names.renumber_slots(&slots);
        };
        rayon::join(|| error.renumber_slots(&slots), renumber_recorder);
    }

    /// The history, with what is still alive; the mesh has no triangles. Everything else is dropped
    /// before the history is laid out.
    pub(super) fn finish(self) -> Decimated<TriangleMesh, 3, ()> {
        let Self { surface, names, error, recorder, moves, workers, rest: mut mesh, .. } = self;
        drop((error, workers));
        let alive: Vec<(u32, [u32; 3])> =
            surface.iter().map(|(slot, _)| (slot, names.corners(&surface, slot))).collect();
        let order = names.finish();
        let positions = surface.into_positions();
        match moves {
            None => mesh.positions = order.arrange(&positions),
            Some(moves) => {
                add_copies(&mut mesh, moves.born.into_iter().map(|(old, place)| (old, Some(place))));
            }
        }
        drop(positions);
        let mut history = recorder.finish(&alive);
        order.apply(&mut history);
        Decimated { mesh, history, report: () }
    }
}

/// Vertices that were born when others moved.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    /// For each, the vertex of the history that it was before, and its place.
    pub born: Vec<(u32, [f32; 3])>,
    /// Triangles when vertices last moved.
    pub n_triangles_last: usize,
    /// Where vertices may be.
    pub bounds: Bounds,
}

impl Moves {
    /// None yet, of the vertices at `positions` in a mesh of `n_triangles`.
    fn new(positions: &[[f32; 3]], n_triangles: usize) -> Self {
        let bounds = Bounds::around_positions(positions);
        Self { born: vec![], n_triangles_last: n_triangles, bounds }
    }
}

/// Buffers for judging, one set per thread of the pool and one for the caller.
#[derive(Default)]
pub(crate) struct Workers {
    scratches: Vec<Mutex<Scratch>>,
}

impl Workers {
    /// Buffers for the current rayon pool.
    pub(crate) fn new() -> Self {
        Self { scratches: (0..=rayon::current_num_threads()).map(|_| Mutex::default()).collect() }
    }

    /// This thread's buffers. A thread never asks for them twice at once, so it never waits.
    pub(super) fn scratch(&self) -> MutexGuard<'_, Scratch> {
        let last = self.scratches.len() - 1;
        let own = rayon::current_thread_index().unwrap_or(last).min(last);
        self.scratches[own].lock().unwrap_or_else(PoisonError::into_inner)
    }
}
