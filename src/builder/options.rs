//! What a build is asked for.

use super::BuildError;
use crate::bound::estimate::EstimateKind;
use crate::decimate::fusion::FusionOptions;
use crate::decimate::jade::{JadeBound, JadeOptions, Placement};
use crate::decimate::progressive::{ProgressiveBound, ProgressiveOptions};
use crate::store::{Bound, Method};
use serde_json::{Value, json};

/// Which decimator makes a surface coarser, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decimator {
    /// Vertex removal under a bound on the global error. Keeps the topology.
    Jade(JadeOptions),
    /// Edge collapses and vertex splits that change the topology where they must, down to no
    /// triangle.
    Progressive(ProgressiveOptions),
}

/// How to build from a surface.
///
/// Fields may be added: write `..BuildOptions::default()` behind those you set.
///
/// ```
/// use nephrite::{BuildOptions, Decimator};
/// use nephrite::ProgressiveOptions;
/// let options = BuildOptions { max_error: Some(0.1), ..BuildOptions::with(ProgressiveOptions::default()) };
/// assert!(matches!(options.decimator, Decimator::Progressive(_)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// Largest error of any level, in mesh units; `None` simplifies as far as it goes.
    pub max_error: Option<f64>,
    /// Edges at which the normals turn by more than this, in degrees, are feature edges.
    pub feature_angle_degrees: f64,
    /// Whether the vertices on the boundary stay at every level, where they are, so that meshes
    /// that meet there fit at any levels. No new edge joins two of them.
    pub lock_boundary: bool,
    /// The decimator, and what its errors mean.
    pub decimator: Decimator,
}

/// How to build from a volume.
///
/// Fields may be added: write `..VolumeOptions::default()` behind those you set.
///
/// ```
/// let options = nephrite::VolumeOptions { max_error: Some(0.1), ..Default::default() };
/// assert_eq!(options.feature_angle_degrees, 40.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeOptions {
    /// Largest error of any level, in mesh units; `None` simplifies as far as it goes.
    pub max_error: Option<f64>,
    /// Edges of the boundary at which its normals turn by more than this, in degrees, are feature
    /// edges.
    pub feature_angle_degrees: f64,
    /// Whether the vertices of the boundary stay, each at its place at every level, so that
    /// neighbouring parts of one volume fit at any level of each.
    pub lock_boundary: bool,
    /// Constants of the fusion.
    pub fusion: FusionOptions,
}

impl From<JadeOptions> for Decimator {
    fn from(options: JadeOptions) -> Self {
        Self::Jade(options)
    }
}

impl From<ProgressiveOptions> for Decimator {
    fn from(options: ProgressiveOptions) -> Self {
        Self::Progressive(options)
    }
}

impl Default for Decimator {
    fn default() -> Self {
        Self::Jade(JadeOptions::default())
    }
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self::with(Decimator::default())
    }
}

impl Default for VolumeOptions {
    fn default() -> Self {
        Self {
            max_error: None,
            feature_angle_degrees: 40.0,
            lock_boundary: false,
            fusion: FusionOptions::default(),
        }
    }
}

impl BuildOptions {
    /// A decimator that simplifies as far as it goes.
    pub fn with(decimator: impl Into<Decimator>) -> Self {
        let decimator = decimator.into();
        Self { max_error: None, feature_angle_degrees: 60.0, lock_boundary: false, decimator }
    }

    /// The name of the decimator.
    pub fn method(&self) -> Method {
        match self.decimator {
            Decimator::Jade(_) => Method::Jade,
            Decimator::Progressive(_) => Method::Progressive,
        }
    }

    /// What the errors of the levels will mean.
    pub fn bound(&self) -> Bound {
        match self.decimator {
            Decimator::Jade(JadeOptions { bound: JadeBound::Certified(_), .. })
            | Decimator::Progressive(ProgressiveOptions { bound: ProgressiveBound::Certified, .. }) => {
                Bound::Certified
            }
            Decimator::Jade(JadeOptions { bound: JadeBound::Estimate { kind, .. }, .. }) => match kind {
                EstimateKind::Joint => Bound::Joint,
                EstimateKind::Removed => Bound::Removed,
                EstimateKind::Accumulated => Bound::Accumulated,
            },
            Decimator::Progressive(ProgressiveOptions { bound: ProgressiveBound::Accumulated, .. }) => {
                Bound::Accumulated
            }
        }
    }

    /// What a file says of them: the decimator's own options under its name, as they were in
    /// effect.
    pub(super) fn to_json(self) -> Value {
        let mut options = json!({
            "method": self.method(),
            "bound": self.bound(),
            "max_error": self.max_error,
            "feature_angle_degrees": self.feature_angle_degrees,
            "lock_boundary": self.lock_boundary,
        });
        options[self.method().to_string()] = match self.decimator {
            Decimator::Jade(jade) => jade_json(&jade),
            Decimator::Progressive(ProgressiveOptions { reduction, pre_split, .. }) => {
                json!({ "reduction": reduction, "pre_split": pre_split })
            }
        };
        options
    }

    /// Whether every option has a meaning.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        check_common(self.max_error, self.feature_angle_degrees)?;
        match self.decimator {
            Decimator::Jade(jade) => {
                let (k, c1, c2) = (jade.k_value(), jade.c1_value(), jade.c2);
                check("k", "from 1 to 1e12", k, (1.0..=JadeOptions::MAX_K).contains(&k))?;
                check("c1", "from 1.001 to 16", c1, (JadeOptions::MIN_C1..=16.0).contains(&c1))?;
                check("c2", "from 1 to 16", c2, (1.0..=16.0).contains(&c2))?;
                check_part("aspect loss", jade.aspect_loss())
            }
            Decimator::Progressive(progressive) => {
                check_part("reduction", progressive.reduction.unwrap_or(1.0))
            }
        }
    }
}

/// Constants of JADE by their names in the paper.
fn jade_json(jade: &JadeOptions) -> Value {
    let mut constants = json!({ "k": jade.k_value(), "c1": jade.c1_value(), "c2": jade.c2 });
    match jade.bound {
        JadeBound::Certified(Placement::Original) => constants["placement"] = json!("original"),
        JadeBound::Certified(Placement::Best) => constants["placement"] = json!("best"),
        JadeBound::Estimate { aspect_loss, .. } => constants["aspect_loss"] = json!(aspect_loss),
    }
    constants
}

impl VolumeOptions {
    /// What a file says of them.
    pub(super) fn to_json(self) -> Value {
        let FusionOptions { field_weight, tetrahedron_share, volume_loss } = self.fusion;
        json!({
            "max_error": self.max_error,
            "feature_angle_degrees": self.feature_angle_degrees,
            "lock_boundary": self.lock_boundary,
            "fusion": {
                "field_weight": field_weight,
                "tetrahedron_share": tetrahedron_share,
                "volume_loss": volume_loss,
            },
        })
    }

    /// Whether every option has a meaning.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        check_common(self.max_error, self.feature_angle_degrees)?;
        let FusionOptions { field_weight: weight, tetrahedron_share, volume_loss } = self.fusion;
        check("field weight", "finite and not negative", weight, weight.is_finite() && weight >= 0.0)?;
        check_part("tetrahedron share", tetrahedron_share)?;
        check_part("volume loss", volume_loss)
    }
}

fn check_common(max_error: Option<f64>, angle: f64) -> Result<(), BuildError> {
    if let Some(error) = max_error {
        check("max error", "finite and above zero", error, error.is_finite() && error > 0.0)?;
    }
    check("feature angle", "from 0 to 180 degrees", angle, (0.0..=180.0).contains(&angle))
}

fn check_part(option: &'static str, found: f64) -> Result<(), BuildError> {
    check(option, "from 0 to 1", found, (0.0..=1.0).contains(&found))
}

fn check(option: &'static str, expected: &'static str, found: f64, is_good: bool) -> Result<(), BuildError> {
    if is_good { Ok(()) } else { Err(BuildError::Option { option, expected, found }) }
}
