//! The average plane of a star.

use crate::geometry::vector::{Vector, cross, dot, length, length_sq, sub};

/// The average plane of a star (W. J. Schroeder, J. A. Zarge and W. E. Lorensen, "Decimation of
/// triangle meshes", SIGGRAPH 1992, section 3.2): normals and centres weighted with the areas.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AveragePlane {
    /// Sum of the normals, each as long as twice its triangle's area.
    pub normal: Vector,
    /// Sum of the corners beside the vertex, relative to it, weighted with twice the areas.
    pub weighted: Vector,
    /// Twice the sum of the areas.
    pub weight: f64,
}

impl AveragePlane {
    /// Adds the triangle between two spokes that start at the vertex; gives its normal, twice its
    /// area long, and that length.
    #[inline]
    pub(crate) fn add(&mut self, first: Vector, second: Vector) -> (Vector, f64) {
        let normal = cross(first, second);
        let size = length(normal);
        for axis in 0..3 {
            self.normal[axis] += normal[axis];
            self.weighted[axis] += size * (first[axis] + second[axis]);
        }
        self.weight += size;
        (normal, size)
    }

    /// Distance between the vertex and the plane; zero for a star without area.
    #[inline]
    pub(crate) fn distance(&self) -> f64 {
        let size_sq = length_sq(self.normal);
        if size_sq > 0.0 && self.weight > 0.0 {
            // The centre of a triangle is a third of its spokes away from the vertex.
            (dot(self.weighted, self.normal) / (3.0 * self.weight)).abs() / size_sq.sqrt()
        } else {
            0.0
        }
    }
}

/// A vector from the vertex to a point.
#[inline]
pub(super) fn spoke(apex: Vector, point: Vector) -> Vector {
    sub(point, apex)
}
