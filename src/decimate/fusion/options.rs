//! Options of the fusion.

use serde::{Deserialize, Serialize};

/// Constants of the fusion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FusionOptions {
    /// Weight of fields relative to the shape: the range of a field counts as this many bounding
    /// box diagonals. With 0, fields do not count in the cost.
    pub field_weight: f64,
    /// The cheapest part of the tetrahedra, from 0 to 1, that are fused whole before edges are.
    /// With 1 all tetrahedra that can be are fused whole, as in the paper. Fusing a tetrahedron
    /// removes three vertices from one place at once; where fields matter, edges keep them better
    /// at the same count.
    pub tetrahedron_share: f64,
    /// Largest change of the volume, as a part of the volume.
    pub volume_loss: f64,
}

impl Default for FusionOptions {
    fn default() -> Self {
        Self { field_weight: 4.0, tetrahedron_share: 0.1, volume_loss: 0.001 }
    }
}
