//! Vectors and exact distances between points, segments and triangles, in `f64`.

pub mod distance;
pub mod floor;
pub mod morton;
pub mod prepared;
pub mod projection;
pub mod vector;
