//! Vectors and exact distances between points, segments and triangles, in `f64`.

pub(crate) mod barycentric;
pub(crate) mod bounds;
pub(crate) mod distance;
pub(crate) mod height_triangle;
pub(crate) mod morton;
pub(crate) mod prepared;
pub(crate) mod projection;
pub(crate) mod vector;
