//! One mesh in, every level of detail out, each with an error that is stated.
//!
//! [`build()`] makes the levels, [`store`] keeps them, [`Lod`] answers which triangles make the mesh at an error, a budget or a
//! distance. `docs/drawing-a-level.md` in the repository shows how a level goes to a graphics library, from wgpu to WebGL.

pub mod bound;
mod build;
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

pub use build::{
    Bound, Build, BuildError, BuildOptions, Method, Observer, Phase, Progress, VolumeBuild, VolumeOptions,
    bounding_diagonal, build, build_from, build_volume,
};
pub use history::History;
pub use nephrite_formats::{Attribute, ScalarType, TetrahedronMesh, TriangleMesh};
pub use query::{Cut, Lod};

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Compiles what the page on drawing shows.
#[cfg(doctest)]
#[doc = include_str!("../docs/drawing-a-level.md")]
struct DrawingALevel;
