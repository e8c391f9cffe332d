//! How a build tells how far it has come.

use std::ops::ControlFlow;

/// How far a build has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub phase: Phase,
    /// Triangles alive now.
    pub n_triangles: usize,
    /// Triangles of the input.
    pub n_triangles_in: usize,
    /// Error of the current mesh, in mesh units.
    pub error: f64,
    /// Error at which the build ends, if one was asked for.
    pub max_error: Option<f64>,
}

/// Parts of a build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Welding vertices, and dropping triangles that are not part of a surface.
    Repair,
    /// Removing vertices.
    Decimate,
}

/// Told of progress now and then, from the building thread; may stop the build.
pub type Observer<'a> = &'a (dyn Fn(&Progress) -> ControlFlow<()> + Sync);
