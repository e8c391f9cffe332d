//! How tetrahedra are fused.

use serde::{Deserialize, Serialize};

/// Constants of the fusion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FusionOptions {
    /// How much fields count beside the shape: the range of a field is worth this many bounding box diagonals. 0 leaves them out of
    /// the cost.
    pub field_weight: f64,
    /// Largest change of the volume, as a part of it.
    pub volume_loss: f64,
}

impl Default for FusionOptions {
    fn default() -> Self {
        Self { field_weight: 4.0, volume_loss: 0.001 }
    }
}
