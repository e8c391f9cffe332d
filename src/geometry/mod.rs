//! Vectors and exact distances between points, segments and triangles, in `f64`.

pub mod barycentric;
pub mod bounds;
pub mod distance;
pub mod height_triangle;
pub mod morton;
pub mod prepared;
pub mod projection;
pub mod vector;
