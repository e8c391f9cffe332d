//! What the progressive decimator is asked for.

/// What the errors of a progressive build mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProgressiveBound {
    /// A proven bound on the two-sided Hausdorff distance to the input until the topology changes
    /// for the first time, and the accumulated estimate from there on.
    #[default]
    Certified,
    /// The paper's estimate, accumulated local errors.
    Accumulated,
}

/// How far the decimator goes, and how it splits.
///
/// Fields may be added: write `..ProgressiveOptions::default()` behind those you set.
///
/// ```
/// use nephrite::ProgressiveOptions;
/// let half = ProgressiveOptions { reduction: Some(0.5), ..ProgressiveOptions::default() };
/// assert!(!half.pre_split);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProgressiveOptions {
    /// What the errors mean.
    pub bound: ProgressiveBound,
    /// Part of the triangles to remove, from 0 to 1; `None` for all of them.
    pub reduction: Option<f64>,
    /// Split along feature edges, at corners and at non-manifold vertices before anything else
    /// (section 4.9): better for large flat faces with thin sides between them.
    pub pre_split: bool,
}

/// What the decimation is to do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// Cosine of the feature angle.
    pub cos_feature_angle: f64,
    /// Nothing is done that would make the error larger than this.
    pub max_error: f64,
    /// How far the worst vertex was moved when the mesh was read: part of every error.
    pub rounding: f64,
    /// Whether to prove the error while that can be done.
    pub proves: bool,
    /// Reduction and splits.
    pub options: ProgressiveOptions,
}
