//! JADE: simplification by vertex removal under a bound on the global error.
//!
//! A. Ciampalini, P. Cignoni, C. Montani and R. Scopigno, "Multiresolution decimation based on
//! global error", *The Visual Computer* 13, 1997. The paper goes through the vertices one by one,
//! under limits that rise from iteration to iteration, and removes whatever is below them. Here an
//! iteration works in rounds over an independent set, cheapest first: its candidates are judged in
//! parallel, a batch at a time, and those within the limits removed. No heap is needed, and the
//! result does not depend on the number of threads.
//!
//! `run` is the decimator. Its verbs, in the order of the data: [`worklists`] says who is
//! tried next, [`batch`] plans and carries out, [`candidate`] fills the hole of one vertex
//! ([`classify`], then [`fit`] or [`triangulate`], then [`validity`]), [`removal`] is one plan, and
//! [`placement`] moves vertices that stay.

pub mod batch;
pub mod best_place;
pub mod candidate;
pub mod classify;
pub mod crossings;
pub mod ears;
pub mod fit;
pub mod flip;
mod names;
pub mod optimal;
mod options;
pub mod placement;
pub mod removal;
mod run;
pub mod sampled_vertices;
mod state;
pub mod thresholds;
pub mod triangulate;
pub mod validity;
pub mod worklists;

pub use options::{JadeBound, JadeOptions, Placement};
pub(crate) use run::run;
