//! What a file says about how it was made.

use serde::{Deserialize, Serialize};

/// Where a history comes from, in the words of whoever built it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Provenance {
    /// Decimator, such as `jade`.
    pub method: String,
    /// What the errors mean, such as `certified`.
    pub bound: String,
    /// Error the build was asked to stop at, in mesh units.
    pub max_error: Option<f64>,
    /// Vertices of the input, before repair.
    pub n_vertices_in: u64,
    /// Simplices of the input, before repair.
    pub n_simplices_in: u64,
    /// All options of the build.
    pub options: serde_json::Value,
    /// What was repaired before the build.
    pub repairs: serde_json::Value,
    /// Levels with at least this many simplices carry a certified error, those below an estimate; nothing where `bound` holds for
    /// all of them.
    pub certified_simplices: Option<u64>,
    /// Changes of topology on the way: how many of each kind, and the first ones with their errors.
    pub topology: serde_json::Value,
}

/// The metadata section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metadata {
    /// Program and version that wrote the file.
    #[serde(default)]
    pub generator: String,
    /// Where the history comes from.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl Metadata {
    /// Metadata that names this version of the engine.
    pub fn new(provenance: Provenance) -> Self {
        Self { generator: concat!("nephrite ", env!("CARGO_PKG_VERSION")).to_owned(), provenance }
    }
}
