//! One mesh in, every level of detail out, each with an error that is stated.

pub mod generate;
pub mod geometry;
pub mod history;

pub use history::History;
pub use nephrite_formats::{Attribute, ScalarType, TriangleMesh};
