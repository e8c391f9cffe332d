//! What the engine has names for, as it is typed on the command line.

use clap::ValueEnum;
use nephrite::decimate::jade::Placement;
use nephrite::{Bound, Method};

/// The decimators, as they are typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodName {
    /// Vertex removal with retriangulation under a global error bound
    Jade,
    /// Fusion of tetrahedra, for volumes
    Fusion,
    /// Edge collapses and vertex splits that change the topology where they must: any reduction, down to no triangle
    Progressive,
}

impl From<MethodName> for Method {
    fn from(name: MethodName) -> Self {
        match name {
            MethodName::Jade => Self::Jade,
            MethodName::Fusion => Self::Fusion,
            MethodName::Progressive => Self::Progressive,
        }
    }
}

/// The bounds, as they are typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BoundName {
    /// A proof: the two-sided Hausdorff distance to the input is at most the error
    Certified,
    /// The JADE paper's estimate: the larger of the two below
    Joint,
    /// The paper's estimate from the removed vertices and their nearest triangles
    Removed,
    /// The paper's estimate from the errors of all removals at a place, added up
    Accumulated,
}

impl From<BoundName> for Bound {
    fn from(name: BoundName) -> Self {
        match name {
            BoundName::Certified => Self::Certified,
            BoundName::Joint => Self::Joint,
            BoundName::Removed => Self::Removed,
            BoundName::Accumulated => Self::Accumulated,
        }
    }
}

/// The placements, as they are typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlacementName {
    /// Where the input has them
    Original,
    /// Where the error is least: about a ninth fewer triangles for an error, in a file about twice as long
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
