//! Questions to a file: which simplices make the mesh at this error, at this budget, at this level?
//!
//! The naive way keeps one mesh per level. Here every level is a few ranges of one index buffer over a prefix of one vertex
//! buffer: both are uploaded once, and an answer is drawn or copied as it is. Finding it is a binary search over the
//! error or count table and one look into the interval tree.

mod cut;
mod error;
mod extract;
mod lod;

pub use cut::Cut;
pub use error::QueryError;
pub use lod::{CurvePoint, Lod};
