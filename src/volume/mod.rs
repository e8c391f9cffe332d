//! Surfaces from volumes: the boundary, and the section with a plane.

mod boundary;
mod slice;

pub use boundary::boundary;
pub use slice::{Plane, slice};

use crate::geometry::bounds;
use nephrite_formats::TetrahedronMesh;

/// Length of the diagonal of the volume's bounding box, in mesh units.
pub fn bounding_diagonal(volume: &TetrahedronMesh) -> f64 {
    bounds::bounding_diagonal(&volume.positions)
}
