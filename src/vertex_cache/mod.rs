//! Orders of triangles that suit the vertex cache of a graphics processor, and what an order is worth.
//!
//! A graphics processor transforms a vertex again whenever it is drawn and no longer in a small cache. Triangles at random
//! places miss it three times each; around a surface with half as many vertices as triangles, 0.5 would be perfect.

mod fans;
mod misses;

pub use fans::FanOrder;
pub use misses::{CACHE_LEN, miss_ratio};
