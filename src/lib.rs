//! One mesh in, every level of detail out, each with an error that is stated.
//!
//! [`build()`] makes the levels, [`store`] keeps them, [`Lod`] answers which triangles make the mesh at an error, a budget or a
//! distance. `docs/drawing-a-level.md` in the repository shows how a level goes to a graphics library, from wgpu to WebGL.

pub mod bound;
mod builder;
pub mod decimate;
mod flat;
pub mod generate;
pub mod geometry;
pub mod history;
pub mod measure;
pub mod mesh;
pub mod progressive_mesh;
pub mod query;
pub mod reprove;
pub mod store;
pub mod tree;
pub mod vertex_cache;
pub mod volume;

pub use bound::estimate::EstimateKind;
pub use builder::{
    Build, BuildError, BuildOptions, Decimator, Observer, Phase, Progress, VolumeBuild, VolumeOptions,
    bounding_diagonal, build, build_volume, build_volume_with, build_with, repair_volume,
};
pub use decimate::fusion::{FusionOptions, FusionReport};
pub use decimate::jade::{JadeBound, JadeOptions, MAX_K, MIN_C1, Placement};
pub use decimate::progressive::events::{Event, EventKind, EventLog, Tally};
pub use decimate::progressive::journal::Counts;
pub use decimate::progressive::{ProgressiveBound, ProgressiveOptions, ProgressiveReport};
pub use history::{Deviation, History, HistoryError, Levels, NEVER};
pub use mesh::{RepairReport, TetrahedronRepairReport};
pub use nephrite_formats::{Attribute, MeshFault, ScalarType, TetrahedronMesh, TriangleMesh};
pub use progressive_mesh::{Encoded, ProgressiveMesh, STREAM_HEADER_BYTES, StreamError};
pub use query::{
    CurvePoint, Cut, Delta, INFLECTION_RATIO, Landing, Lod, Picker, Projection, QueryError, View,
};
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
