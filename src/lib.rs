//! One mesh in, every level of detail out, each with an error that is stated.
//!
//! [`build()`] makes the levels, [`Build::write`] keeps them in one file, and [`Lod`] answers which
//! triangles make the mesh at an error, a budget or a distance. `docs/drawing-a-level.md` in the
//! repository shows how a level goes to a graphics library, from wgpu to WebGL.
//!
//! * Build: [`build()`] and [`build_with`] from a [`TriangleMesh`] under [`BuildOptions`],
//!   [`build_volume`] from a [`TetrahedronMesh`] under [`VolumeOptions`]. A [`History`] that
//!   something else has made is written by [`History::write`].
//! * Ask: [`Lod::at_error`] and its like give a [`Cut`], whose [`Run`]s are drawn or copied as they
//!   are. A [`Picker`] chooses a level for a [`View`], [`Lod::delta`] and [`Lod::geomorph`] lead
//!   from one level to another.
//! * Trust: [`Lod::verify`] checks every rule of the format, [`ErrorTable`] proves the errors of a
//!   file anew, and [`measure`] compares any two surfaces.
//! * Stream: a [`ProgressiveMesh`] is built up by the operations of a progressive build, one by one
//!   as they arrive.
//!
//! Two features are on by default. Without `build` there are no decimators: the crate opens,
//! verifies and queries files and writes histories. Without `measure` there is no distance between
//! meshes either.
#![cfg_attr(
    not(feature = "build"),
    allow(
        dead_code,
        unreachable_pub,
        unused_imports,
        reason = "parts of shared modules that only builds use"
    )
)]

#[cfg(feature = "build")]
mod bound;
#[cfg(feature = "build")]
mod builder;
#[cfg(feature = "build")]
mod decimate;
mod flat;
#[cfg(feature = "build")]
pub mod generate;
mod geometry;
mod history;
#[cfg(feature = "measure")]
pub mod measure;
mod mesh;
mod progressive_mesh;
mod query;
#[cfg(feature = "build")]
mod reprove;
mod store;
#[cfg_attr(not(feature = "internals"), allow(unreachable_pub, reason = "public with that feature"))]
mod tree;
mod vertex_cache;
mod volume;

/// Parts of the engine for programs that compare it with others. Nothing here is stable.
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod internals {
    pub use crate::tree::{Layout, Lifetime, Tree};
}

#[cfg(feature = "build")]
pub use bound::estimate::EstimateKind;
#[cfg(feature = "build")]
pub use builder::{
    Build, BuildError, BuildOptions, Decimator, Observer, Phase, Progress, VolumeBuild, VolumeOptions,
    bounding_diagonal, build, build_volume, build_volume_with, build_with, repair_volume,
};
#[cfg(feature = "build")]
pub use decimate::fusion::{FusionOptions, FusionReport};
#[cfg(feature = "build")]
pub use decimate::jade::{JadeBound, JadeOptions, Placement};
#[cfg(feature = "build")]
pub use decimate::progressive::events::{Event, EventKind, EventLog, Tally};
#[cfg(feature = "build")]
pub use decimate::progressive::journal::Counts;
#[cfg(feature = "build")]
pub use decimate::progressive::{ProgressiveBound, ProgressiveOptions, ProgressiveReport};
pub use history::{Deviation, History, HistoryError, Levels, NEVER};
#[cfg(feature = "build")]
pub use mesh::{RepairReport, TetrahedronRepairReport};
pub use nephrite_formats::{Attribute, MeshFault, ScalarType, TetrahedronMesh, TriangleMesh};
#[cfg(feature = "build")]
pub use progressive_mesh::Encoded;
pub use progressive_mesh::{ProgressiveMesh, STREAM_HEADER_BYTES, StreamError};
pub use query::{
    CurvePoint, Cut, Delta, INFLECTION_RATIO, Landing, Lod, Picker, Projection, QueryError, Replayed,
    Simplex, View,
};
#[cfg(feature = "build")]
pub use reprove::{ErrorTable, ReproveError};
pub use store::{
    AttributeView, Bound, CompactFault, Metadata, Method, OpenError, StoreOptions, StoreReport, VerifyError,
    Vertices, WriteError, check_attributes,
};
pub use tree::{Difference, Run, Runs, TreeError, TreeFault};
pub use vertex_cache::{CACHE_LEN, miss_ratio};
pub use volume::{Plane, boundary};

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Compiles what the page on drawing shows.
#[cfg(doctest)]
#[doc = include_str!("../docs/drawing-a-level.md")]
struct DrawingALevel;
