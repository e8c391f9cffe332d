//! What a decimator produces: every triangle that ever lived, with the steps of its birth and
//! death.
//!
//! A *step* is one time stamp of a decimator, such as the removal of one vertex. Step 0 is the
//! input. A simplex is alive at step `s` if `birth <= s < death`. The simplices with `death == s`
//! are exactly those that the simplices with `birth == s` replaced. Nothing here depends on the
//! decimator.

mod check;
mod deaths;
mod levels;
mod recorder;

pub use check::HistoryError;
pub use levels::Levels;
pub(crate) use recorder::Recorder;

/// Death of a simplex that is still alive when the decimator ends.
pub const NEVER: u32 = u32::MAX;

/// Lifetimes of all simplices and vertices of one decimation, in steps.
///
/// Shapes: `simplices`, `birth` and `death` run in parallel, in order of death. `vertex_death[v]`
/// belongs to vertex `v`; vertices of the input come first. `vertex_birth` is as long as
/// `vertex_death`, or empty if every vertex is one of the input. `errors.len() == n_steps + 1`, and
/// `deviations[i].values.len() == errors.len()`.
///
/// Invariants: `birth < death` for simplices and vertices. A simplex uses only vertices that are
/// born no later and die no earlier than it does. `errors` never falls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History<const CORNERS: usize = 3> {
    /// Vertex indices of every simplex that ever lived.
    pub simplices: Vec<[u32; CORNERS]>,
    /// Step at which each simplex appears.
    pub birth: Vec<u32>,
    /// Step at which each simplex is gone, or [`NEVER`].
    pub death: Vec<u32>,
    /// Step at which each vertex appears; empty if all appear at step 0.
    pub vertex_birth: Vec<u32>,
    /// Step at which each vertex is gone, or [`NEVER`].
    pub vertex_death: Vec<u32>,
    /// Error of the mesh at each step, in mesh units; `errors[0]` is that of the input itself.
    /// Infinite from the step on that leaves nothing whose distance could be measured.
    pub errors: Vec<f64>,
    /// Other numbers that the decimator states for each step.
    pub deviations: Vec<Deviation>,
}

impl<const CORNERS: usize> History<CORNERS> {
    /// Simplices alive at a step, by a scan of all that ever lived.
    pub fn alive(&self, step: u32) -> impl Iterator<Item = [u32; CORNERS]> + '_ {
        let lifetimes = self.birth.iter().zip(&self.death).zip(&self.simplices);
        let alive = lifetimes.filter(move |&((&birth, &death), _)| birth <= step && step < death);
        alive.map(|(_, &simplex)| simplex)
    }

    /// Number of simplices alive at a step. O(n).
    pub fn n_alive(&self, step: u32) -> usize {
        self.alive(step).count()
    }
}

/// An estimate that a decimator states for each step beside the error, such as how far a field has
/// come from that of the input.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviation {
    /// What deviates, usually the name of a field.
    pub name: String,
    /// One value per step, as many as errors; finite, not negative, never falling.
    pub values: Vec<f64>,
}
