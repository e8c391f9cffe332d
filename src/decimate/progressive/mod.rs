//! Progressive decimation: edge collapses while any is valid, then vertex splits, down to no
//! triangle.
//!
//! W. J. Schroeder, "A topology modifying progressive decimation algorithm", *IEEE Visualization*
//! 1997. Vertices leave in the order of their error, each along its shortest valid edge. When no
//!       vertex has a valid edge left, one is split: along its feature edges, into manifold pieces,
//!       or in half. Pieces can always be collapsed, so every triangle count is reached.
//!
//! The driver is [`run`](run()); its parts bear the names of the paper's sections: [`classify`]
//! (4.2), [`error`] (4.3), [`queue`] (4.4), [`collapse`] (4.5), [`split`] (4.6). A [`proof`] of the
//! error is carried along for as long as nothing but collapses that keep the topology happened;
//! [`events`] are the moments at which it changed.

pub(crate) mod accumulated;
mod average_plane;
pub(crate) mod choices;
pub(crate) mod classify;
pub(crate) mod collapse;
pub(crate) mod deviations;
pub(crate) mod error;
pub(crate) mod events;
pub(crate) mod journal;
mod options;
pub(crate) mod proof;
pub(crate) mod queue;
pub(crate) mod ring;
mod run;
mod schedule;
pub(crate) mod shadow;
pub(crate) mod split;
mod state;
mod steps;
mod turns;
pub(crate) mod vanished;
mod view;
mod wedge_targets;

use events::EventLog;
use journal::{Counts, Trace};
pub use options::{ProgressiveBound, ProgressiveOptions};
pub(crate) use run::run;

/// What this decimator leaves beside the history.
///
/// ```
/// use nephrite::{BuildOptions, Event, EventKind, ProgressiveOptions, ProgressiveReport, Tally, build, generate};
/// let build = build(generate::torus(16, 8), &BuildOptions::with(ProgressiveOptions::default()))?;
/// let report: &ProgressiveReport = build.progressive().ok_or("another decimator")?;
/// assert!(report.counts.collapses > 0);
/// let vanished = |tally: &&Tally| tally.kind == EventKind::ComponentVanished;
/// let Event { triangles, .. } = report.events.tallies().find(vanished).ok_or("no event")?.last;
/// assert_eq!(triangles, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgressiveReport {
    /// All operations.
    pub trace: Trace,
    /// All changes of topology.
    pub events: EventLog,
    /// How many operations there were.
    pub counts: Counts,
    /// Steps whose error is certified, from step 0 on. Those behind carry the accumulated estimate.
    pub n_certified_steps: u32,
}
