//! Surfaces from volumes: the boundary, and the section with a plane.

mod boundary;
mod slice;

pub use boundary::boundary;
pub use slice::{Plane, slice};
