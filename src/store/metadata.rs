//! What a file says about how it was made.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fmt;

/// Which decimator made a history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Method {
    /// Vertex removal under a bound on the global error.
    Jade,
    /// Edge collapses and vertex splits that change the topology where they must.
    Progressive,
    /// Fusion of tetrahedra.
    Fusion,
    /// A decimator that this version does not know, or none that is named.
    #[default]
    #[serde(other)]
    Other,
}

/// What the errors of a file mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Bound {
    /// A proven bound on the two-sided Hausdorff distance to the input.
    Certified,
    /// A proven bound on the two-sided Hausdorff distance between the boundaries of two volumes.
    Boundary,
    /// The JADE paper's estimate e_g3, the larger of the next two.
    Joint,
    /// The paper's estimate e_g2, from the removed vertices.
    Removed,
    /// The paper's estimate e_g1, accumulated local errors.
    Accumulated,
    /// No meaning is stated, or one that this version does not know.
    #[default]
    #[serde(rename = "none", other)]
    Unstated,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Jade => "jade",
            Self::Progressive => "progressive",
            Self::Fusion => "fusion",
            Self::Other => "other",
        })
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Certified => "certified",
            Self::Boundary => "boundary",
            Self::Joint => "joint",
            Self::Removed => "removed",
            Self::Accumulated => "accumulated",
            Self::Unstated => "none",
        })
    }
}

/// How a file was made.
///
/// A reader gets it from [`Lod::metadata`](crate::Lod::metadata). It is written by a build, which
/// states what it did and nothing else: no writer takes metadata from its caller.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct Metadata {
    /// Program and version that wrote the file.
    pub generator: String,
    /// The decimator.
    pub method: Method,
    /// What the errors mean.
    pub bound: Bound,
    /// Error the build was asked to stop at, in mesh units.
    pub max_error: Option<f64>,
    /// Vertices of the input, before repair.
    pub n_vertices_in: u64,
    /// Simplices of the input, before repair.
    pub n_simplices_in: u64,
    /// All options of the build.
    pub options: Value,
    /// What was repaired before the build.
    pub repairs: Value,
    /// Levels with at least this many simplices carry a certified error, those below it an
    /// estimate. `None` if `bound` holds for all levels.
    pub certified_simplices: Option<u64>,
    /// Changes of topology: how many of each kind, and the first ones with their errors.
    pub topology: Value,
}

impl Metadata {
    /// Metadata that names this version of the engine and nothing else.
    pub(crate) fn new() -> Self {
        Self { generator: concat!("nephrite ", env!("CARGO_PKG_VERSION")).to_owned(), ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_files_are_the_displayed_ones_and_unknown_ones_are_read() {
        for method in [Method::Jade, Method::Progressive, Method::Fusion, Method::Other] {
            let json = serde_json::to_value(method).unwrap();
            assert_eq!(json, method.to_string());
            assert_eq!(serde_json::from_value::<Method>(json).unwrap(), method);
        }
        let bounds = [Bound::Certified, Bound::Boundary, Bound::Joint, Bound::Removed, Bound::Accumulated];
        for bound in bounds.into_iter().chain([Bound::Unstated]) {
            let json = serde_json::to_value(bound).unwrap();
            assert_eq!(json, bound.to_string());
            assert_eq!(serde_json::from_value::<Bound>(json).unwrap(), bound);
        }
        let later = r#"{ "method": "ruby", "bound": "", "colour": "green" }"#;
        let Metadata { method, bound, .. } = serde_json::from_str(later).unwrap();
        assert_eq!((method, bound), (Method::Other, Bound::Unstated));
    }
}
