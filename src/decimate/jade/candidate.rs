//! One vertex as a candidate for removal: its hole and the filling.

use super::classify::{Class, classify};
use super::fit::{FitBuffers, Fitting, fit};
use super::flip::flip_edges;
use super::names::Names;
use super::triangulate::{Polygons, triangulate};
use crate::bound::certified::images::Image;
use crate::bound::certified::{Certified, Transfer};
use crate::bound::estimate::Estimate;
use crate::bound::{Errors, GlobalError, Limits};
use crate::mesh::{Filling, Hole, NoHole, Surface};

/// All that a candidate is judged by, and its removal planned from.
#[derive(Clone, Copy)]
pub(crate) struct Situation<'a> {
    /// The current mesh.
    pub surface: &'a Surface,
    /// What its vertices are called in the history.
    pub names: &'a Names,
    /// Its errors so far.
    pub error: &'a GlobalError,
    /// Cosine of the feature angle.
    pub cos_feature_angle: f64,
    /// How much worse than the star's a flipped edge may make the aspect ratio, as a part of it.
    pub aspect_loss: f64,
}

/// Why a candidate stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Refusal {
    /// Not under these limits: its errors are at least these.
    Above(Errors),
    /// Not while its star stays as it is.
    Impossible,
}

/// Buffers for one candidate at a time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    /// The candidate's hole.
    pub hole: Hole,
    /// Its filling.
    pub filling: Filling,
    polygons: Polygons,
    fit: FitBuffers,
    /// Buffers for carrying the certified map along.
    pub transfer: Transfer,
    /// What is mapped onto the star of a vertex that may move.
    pub images: Vec<Image>,
}

/// Puts hole and filling of `v` into `scratch`, or returns why it stays.
pub(super) fn fill(
    situation: Situation<'_>,
    v: u32,
    limits: Limits,
    scratch: &mut Scratch,
) -> Result<(), Refusal> {
    let Situation { surface, names, error, cos_feature_angle, .. } = situation;
    if surface.is_locked(v) {
        return Err(Refusal::Impossible);
    }
    match scratch.hole.gather(surface, v) {
        Ok(()) if scratch.hole.n_ring() >= 3 => {}
        Ok(()) | Err(NoHole::Complex | NoHole::TooLarge) => return Err(Refusal::Impossible),
    }
    let class = classify(&scratch.hole, surface, names.wedges(), cos_feature_angle);
    if class == Class::SeamCorner {
        return Err(Refusal::Impossible);
    }
    match error {
        GlobalError::Estimate(estimate) => fill_as_paper(situation, estimate, class, scratch),
        GlobalError::Certified(certified) => fill_best(situation, certified, class, limits, scratch),
    }
}

/// The paper's way: triangulate, then flip.
fn fill_as_paper(
    situation: Situation<'_>,
    estimate: &Estimate,
    class: Class,
    scratch: &mut Scratch,
) -> Result<(), Refusal> {
    let Scratch { hole, filling, polygons, .. } = scratch;
    if !triangulate(situation.surface, hole, class, polygons, filling) {
        return Err(Refusal::Impossible);
    }
    flip_edges(situation.surface, hole, estimate.sampler(), situation.aspect_loss, filling);
    Ok(())
}

/// The filling that fits the input best, or the paper's where the hole is too large for that.
fn fill_best(
    situation: Situation<'_>,
    certified: &Certified,
    class: Class,
    limits: Limits,
    scratch: &mut Scratch,
) -> Result<(), Refusal> {
    let Scratch { hole, filling, polygons, fit: buffers, .. } = scratch;
    let surface = situation.surface;
    let limit_sq = limits.global * limits.global;
    match fit(Fitting { surface, certified, hole, class, limit_sq }, buffers, filling) {
        Some(fitted_sq) if fitted_sq > limit_sq => {
            Err(Refusal::Above(Errors { local: 0.0, global: fitted_sq.sqrt() }))
        }
        None if !triangulate(surface, hole, class, polygons, filling) => Err(Refusal::Impossible),
        _ => Ok(()),
    }
}
