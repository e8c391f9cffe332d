//! Surfaces from volumes: the boundary, and the section with a plane.

mod boundary;
mod slice;

pub use boundary::boundary;
pub(crate) use boundary::boundary_of_checked;
pub use slice::Plane;
pub(crate) use slice::slice;
