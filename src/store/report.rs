//! What writing a file tells.

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct StoreReport {
    /// Levels of the file.
    pub n_levels: u32,
    /// Stored lifetimes; a simplex may have several.
    pub n_lifetimes: u32,
    /// Stored copies of simplices.
    pub n_slots: u32,
    /// Vertices that some level has.
    pub n_vertices: u32,
    /// Simplices of the coarsest level.
    pub n_coarsest: u32,
    /// Error of the coarsest level, in mesh units; infinite if no bound is stated.
    pub max_error: f64,
    /// Length of the file.
    pub file_bytes: u64,
}
