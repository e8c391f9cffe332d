//! What a build is asked for.

use super::BuildError;
use crate::bound::Bound;
use crate::decimate::jade::{JadeOptions, MAX_K, MIN_C1, Placement};
use crate::decimate::progressive::ProgressiveOptions;
use serde::{Deserialize, Serialize};

/// Which decimator runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Vertex removal under a bound on the global error.
    #[default]
    Jade,
    /// Fusion of tetrahedra; of volumes only, see [`build_volume`](crate::build_volume()).
    Fusion,
    /// Edge collapses and vertex splits that change the topology where they must, down to no triangle.
    Progressive,
}

/// How to build.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BuildOptions {
    /// The decimator.
    pub method: Method,
    /// What its errors mean.
    pub bound: Bound,
    /// Largest error of any level, in mesh units; `None` simplifies as far as it goes.
    pub max_error: Option<f64>,
    /// Edges at which the normals turn by more than this, in degrees, are feature edges.
    pub feature_angle_degrees: f64,
    /// Constants of JADE.
    pub jade: JadeOptions,
    /// How far the progressive decimator goes.
    pub progressive: ProgressiveOptions,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            method: Method::default(),
            bound: Bound::default(),
            max_error: None,
            feature_angle_degrees: 60.0,
            jade: JadeOptions::default(),
            progressive: ProgressiveOptions::default(),
        }
    }
}

/// Whether every option has a meaning.
pub(super) fn check_options(options: &BuildOptions) -> Result<(), BuildError> {
    let check = |option, expected, found: f64, is_good: bool| {
        if is_good { Ok(()) } else { Err(BuildError::Option { option, expected, found }) }
    };
    let BuildOptions {
        max_error,
        feature_angle_degrees: angle,
        jade: JadeOptions { k, c1, c2, aspect_loss, placement },
        progressive: ProgressiveOptions { reduction, .. },
        ..
    } = *options;
    if let (Method::Progressive, Bound::Joint | Bound::Removed) = (options.method, options.bound) {
        let found = if options.bound == Bound::Joint { "joint" } else { "removed" };
        let expected = "a certified or an accumulated error";
        return Err(BuildError::BoundOfMethod { method: "progressive", expected, found });
    }
    if placement == Placement::Best && (options.method, options.bound) != (Method::Jade, Bound::Certified) {
        return Err(BuildError::PlacementOfBound);
    }
    let reduction = reduction.unwrap_or(1.0);
    check("reduction", "from 0 to 1", reduction, (0.0..=1.0).contains(&reduction))?;
    if let Some(error) = max_error {
        check("max error", "finite and above zero", error, error.is_finite() && error > 0.0)?;
    }
    check("feature angle", "from 0 to 180 degrees", angle, (0.0..=180.0).contains(&angle))?;
    check("k", "from 1 to 1e12", k, (1.0..=MAX_K).contains(&k))?;
    check("c1", "from 1.001 to 16", c1, (MIN_C1..=16.0).contains(&c1))?;
    check("c2", "from 1 to 16", c2, (1.0..=16.0).contains(&c2))?;
    check("aspect loss", "from 0 to 1", aspect_loss, (0.0..=1.0).contains(&aspect_loss))
}
