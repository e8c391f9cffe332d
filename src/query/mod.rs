//! Queries: which simplices make the mesh at this error, within this budget, or at this level?
//!
//! The naive way keeps one mesh per level. Here every level is a few ranges of one index buffer
//! over a prefix of one vertex buffer: both are uploaded once, and an answer is drawn or copied as
//! it is. To find it takes a binary search over the error or count table and one access to the
//! interval tree.

mod cut;
mod delta;
mod error;
mod extract;
mod geomorph;
mod inflection;
mod lod;
mod patches;
mod picker;
mod proven;
mod replay;
mod simplex;
mod used;
mod view;
mod volume;

pub use cut::Cut;
pub use delta::Delta;
pub use error::QueryError;
pub use geomorph::Landing;
pub use inflection::INFLECTION_RATIO;
pub use lod::{CurvePoint, Lod};
pub use picker::Picker;
pub use replay::Replayed;
pub use simplex::Simplex;
pub use view::{Projection, View};
