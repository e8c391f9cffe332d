//! The names of decimators, bounds and placements, as they are typed.

use clap::ValueEnum;
use nephrite::{EstimateKind, Placement, ProgressiveBound};

/// The decimators, as they are typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodName {
    /// Vertex removal with retriangulation under a global error bound
    #[default]
    Jade,
    /// Fusion of tetrahedra, for volumes
    Fusion,
    /// Edge collapses and vertex splits, which change the topology if they must: any reduction,
    /// down to no triangle
    Progressive,
}

/// The bounds, as they are typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum BoundName {
    /// Proven: the two-sided Hausdorff distance to the input is at most the error
    #[default]
    Certified,
    /// Estimate of the JADE paper: the larger of the next two
    Joint,
    /// Estimate of the paper from the removed vertices and their nearest triangles
    Removed,
    /// Estimate of the paper: the sum of the errors of all removals at a place
    Accumulated,
}

impl BoundName {
    /// The estimate of JADE that has this name; `None` for a proof.
    pub(crate) fn estimate(self) -> Option<EstimateKind> {
        match self {
            Self::Certified => None,
            Self::Joint => Some(EstimateKind::Joint),
            Self::Removed => Some(EstimateKind::Removed),
            Self::Accumulated => Some(EstimateKind::Accumulated),
        }
    }

    /// The bound of the progressive decimator that has this name, if one has.
    pub(crate) fn of_progressive(self) -> Option<ProgressiveBound> {
        match self {
            Self::Certified => Some(ProgressiveBound::Certified),
            Self::Accumulated => Some(ProgressiveBound::Accumulated),
            Self::Joint | Self::Removed => None,
        }
    }
}

/// The placements, as they are typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlacementName {
    /// Where the input has them
    #[default]
    Original,
    /// Where the error is least: about 11 % fewer triangles for an error, in a file about twice as
    /// long
    Best,
}

impl From<PlacementName> for Placement {
    fn from(name: PlacementName) -> Self {
        match name {
            PlacementName::Original => Self::Original,
            PlacementName::Best => Self::Best,
        }
    }
}
