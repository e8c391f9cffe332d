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

pub(crate) mod batch;
pub(crate) mod best_place;
pub(crate) mod candidate;
pub(crate) mod classify;
pub(crate) mod crossings;
pub(crate) mod ears;
pub(crate) mod fit;
pub(crate) mod flip;
mod names;
pub(crate) mod optimal;
mod options;
pub(crate) mod placement;
pub(crate) mod removal;
mod run;
pub(crate) mod sampled_vertices;
mod state;
pub(crate) mod thresholds;
pub(crate) mod triangulate;
pub(crate) mod validity;
pub(crate) mod worklists;

pub use options::{JadeBound, JadeOptions, Placement};
pub(crate) use run::run;
