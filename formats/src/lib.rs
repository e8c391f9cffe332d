//! Mesh files read and written for nephrite, and the records of its `.neph` file.

pub mod mesh;

pub use mesh::{Attribute, ScalarType, TriangleMesh};
