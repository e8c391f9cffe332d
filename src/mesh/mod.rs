//! Vertices and triangles in flat arrays: what a decimator works on.
//!
//! [`repair`] turns whatever a file held into triangles that a decimator can trust; [`Surface`] is the mesh while it
//! is being simplified, with the star of every vertex at hand.

mod repair;
mod seams;
mod stars;
mod surface;

pub use repair::{RepairReport, Repaired, repair};
pub use seams::Seams;
pub use stars::Stars;
pub use surface::Surface;
