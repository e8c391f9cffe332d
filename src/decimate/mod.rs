//! Decimators: each turns a mesh into the history of its simplification.
//!
//! A decimator is one function, `run(input, &options, watch)`. Its folder has the files `options`
//! (what it is asked for), `state` (the mesh in the middle of its decimation, with all that is kept
//! beside it) and `run` (the driver); the others are named for what is done to the state.

pub(crate) mod fusion;
pub(crate) mod jade;
pub(crate) mod progressive;

use crate::history::History;
use crate::mesh::TooMany;
use nephrite_formats::TriangleMesh;
use std::ops::ControlFlow;

/// What a decimator starts from.
#[derive(Clone, Debug)]
pub(crate) struct Input<Mesh> {
    /// The mesh, repaired.
    pub mesh: Mesh,
    /// Largest error of any step, in mesh units; `None` decimates as far as it goes.
    pub max_error: Option<f64>,
    /// Cosine of the angle between normals from which an edge is a feature edge.
    pub cos_feature_angle: f64,
    /// Whether the vertices on the boundary stay where they are.
    pub lock_boundary: bool,
}

impl<Mesh> Input<Mesh> {
    /// Whether a step may have any error at all: false if the repair has used up the largest one.
    fn may_change(&self) -> bool {
        self.max_error.is_none_or(|error| error > 0.0)
    }
}

/// Told the number of simplices and the error of the current mesh now and then; breaks to stop.
pub(crate) type Watch<'a> = &'a (dyn Fn(usize, f64) -> ControlFlow<()> + Sync);

/// What a decimator leaves.
#[derive(Clone, Debug)]
pub(crate) struct Decimated<Mesh, const CORNERS: usize, Report> {
    /// The input and, behind its vertices, those born later: what the history refers to.
    pub mesh: Mesh,
    /// Every simplex that ever lived.
    pub history: History<CORNERS>,
    /// What the decimator tells beside the history.
    pub report: Report,
}

/// Why a decimator ended before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stopped {
    /// The watch broke.
    Interrupted,
    /// What the decimator has to remember has outgrown ids of 32 bits.
    TooLarge(TooMany),
}

impl From<TooMany> for Stopped {
    fn from(too_many: TooMany) -> Self {
        Self::TooLarge(too_many)
    }
}

/// Adds one vertex for each of `copies`: the attributes of the vertex named, at the place given or
/// its own.
fn add_copies(mesh: &mut TriangleMesh, copies: impl IntoIterator<Item = (u32, Option<[f32; 3]>)>) {
    for (copied, place) in copies {
        let copied = copied as usize;
        mesh.positions.push(place.unwrap_or(mesh.positions[copied]));
        for attribute in &mut mesh.attributes {
            let stride = attribute.stride_bytes();
            attribute.bytes.extend_from_within(copied * stride..(copied + 1) * stride);
        }
    }
}
