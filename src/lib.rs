//! One mesh in, every level of detail out, each with an error that is stated.

pub mod bound;
mod build;
pub mod decimate;
pub mod generate;
pub mod geometry;
pub mod history;
pub mod measure;
pub mod mesh;
pub mod query;
pub mod reprove;
pub mod store;
pub mod tree;
pub mod vertex_cache;

pub use build::{
    Bound, Build, BuildError, BuildOptions, Method, Observer, Phase, Progress, bounding_diagonal, build,
};
pub use history::History;
pub use nephrite_formats::{Attribute, ScalarType, TriangleMesh};
pub use query::{Cut, Lod};

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
