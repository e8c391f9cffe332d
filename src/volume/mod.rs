//! Surfaces out of volumes: the boundary, and the section with a plane.

mod boundary;
mod slice;

pub use boundary::boundary;
pub use slice::{Plane, slice};

use crate::geometry::vector::{Vector, length, max, min, sub};
use nephrite_formats::TetrahedronMesh;

/// Length of the diagonal of the volume's bounding box, in mesh units.
pub fn bounding_diagonal(volume: &TetrahedronMesh) -> f64 {
    let mut points = volume.positions.iter().map(|p| p.map(f64::from));
    let Some(first) = points.next() else { return 0.0 };
    let (low, high): (Vector, Vector) = points.fold((first, first), |(l, h), p| (min(l, p), max(h, p)));
    length(sub(high, low))
}
