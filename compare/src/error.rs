//! What can go wrong in a comparison.

use nephrite::measure::MeasureError;
use nephrite::{BuildError, OpenError, QueryError, WriteError};
use nephrite_formats::MeshError;
use std::io;

/// Why a comparison could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// A mesh could not be read or written.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// It could not be simplified.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Its history could not be stored.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The stored history could not be opened.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// A level could not be extracted.
    #[error(transparent)]
    Query(#[from] QueryError),
    /// Two surfaces could not be compared.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// The system refused.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A pool of threads could not be started.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// Two ways to the same answer gave different ones.
    #[error("{way} gave {found} {what}, expected {expected}")]
    Disagrees {
        /// Which way.
        way: &'static str,
        /// What was counted.
        what: &'static str,
        /// What it gave.
        found: u64,
        /// What the other one gave.
        expected: u64,
    },
    /// meshoptimizer refused a mesh.
    #[error(transparent)]
    Meshoptimizer(#[from] meshopt::Error),
    /// A process that was started for a measurement failed.
    #[error("measuring in a process of its own failed: {what}")]
    Process {
        /// What it said.
        what: String,
    },
}
