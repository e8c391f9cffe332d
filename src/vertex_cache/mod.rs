//! Orders of triangles for the vertex cache of a graphics processor, and a measure of an order.
//!
//! A graphics processor transforms a vertex again if it is no longer in a small cache when it is
//! drawn. Triangles at random places miss three times each. On a surface with half as many vertices
//! as triangles, 0.5 misses per triangle would be perfect.

mod fans;
mod misses;

pub(crate) use fans::FanOrder;
pub use misses::{CACHE_LEN, miss_ratio};
