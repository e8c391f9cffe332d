//! What can go wrong in a comparison.

use nephrite::BuildError;
use nephrite::measure::MeasureError;
use nephrite::query::QueryError;
use nephrite::store::{OpenError, WriteError};
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
}
