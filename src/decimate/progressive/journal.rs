//! What the decimator did: the history, and the operations that lead from step to step.

use crate::history::Recorder;
use std::ops::Range;

/// One operation on the vertices of the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operation {
    /// `from` goes into `into`: triangles at both are gone, other triangles at `from` have the
    /// corner `into` instead. Of two vertices without common triangles it is a merge.
    Collapse {
        /// The vertex that goes.
        from: u32,
        /// The vertex that stays.
        into: u32,
    },
    /// `copy` takes the place of `from` in some of its triangles.
    Split {
        /// The vertex that stays with the others.
        from: u32,
        /// The new vertex, at the same place.
        copy: u32,
        /// Where in [`Trace::slots`] the triangles are listed, by slot.
        slots: Range<usize>,
    },
}

/// All operations of a decimation in order. Slot `t` holds triangle `t` of the input until it is
/// gone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// The operations.
    pub operations: Vec<Operation>,
    /// Triangles that splits gave to copies.
    pub slots: Vec<u32>,
    /// For each vertex born after those of the input, the vertex that it copies.
    pub copies: Vec<u32>,
}

/// History and trace in the making.
#[derive(Clone, Debug)]
pub(crate) struct Journal {
    /// Lifetimes so far.
    pub recorder: Recorder,
    n_vertices_in: u32,
    /// Operations so far.
    pub trace: Trace,
}

impl Journal {
    /// A journal at step 0, over this many vertices of the input.
    pub(crate) fn new(recorder: Recorder, n_vertices_in: u32) -> Self {
        Self { recorder, n_vertices_in, trace: Trace::default() }
    }

    /// The vertex of the input that a vertex is a copy of, perhaps of copies; itself for one of the
    /// input.
    pub(crate) fn origin(&self, mut vertex: u32) -> u32 {
        // A vertex is copied from an earlier one, so this ends.
        while let Some(copied) = vertex.checked_sub(self.n_vertices_in) {
            vertex = self.trace.copies[copied as usize];
        }
        vertex
    }

    /// Records a collapse or merge.
    pub(crate) fn collapse(&mut self, from: u32, into: u32) {
        self.trace.operations.push(Operation::Collapse { from, into });
    }

    /// Records a split and returns the new vertex.
    pub(crate) fn split(&mut self, from: u32, slots: &[u32]) -> u32 {
        let copy = self.recorder.vertex();
        let start = self.trace.slots.len();
        self.trace.slots.extend_from_slice(slots);
        self.trace.copies.push(from);
        let slots = start..self.trace.slots.len();
        self.trace.operations.push(Operation::Split { from, copy, slots });
        copy
    }

    /// Step of the history.
    pub(crate) fn n_steps(&self) -> u32 {
        self.recorder.n_steps()
    }
}

/// How many collapses and splits there were, by the names of the paper's tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counts {
    /// Edge collapses.
    pub collapses: usize,
    /// Vertex splits.
    pub splits: usize,
    /// Vertex merges.
    pub merges: usize,
}
