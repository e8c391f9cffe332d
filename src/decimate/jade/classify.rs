//! Topological classification of a vertex (JADE, section 3; Schroeder, Zarge and Lorensen,
//! "Decimation of triangle meshes", SIGGRAPH 1992, section 3.1).
//!
//! There a corner is never removed, since nothing else would hold a sharp tip in place. Here every
//! removal is under a bound on the global error, which holds the tip by itself: a corner goes when
//! the bound lets it go, without it no mesh with sharp features would ever reach its coarsest
//! levels. Only corners of seams stay.

use crate::geometry::vector::{dot, length_sq};
use crate::mesh::{Hole, Surface, Wedges};

/// What the star of a vertex looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// Surrounded by triangles, no feature edge: the hole is filled as one polygon.
    Simple,
    /// On the boundary of the surface.
    Boundary,
    /// On a feature line that passes through: the hole is split along the new edge between these
    /// two ring vertices.
    InteriorEdge([usize; 2]),
    /// One, or more than two, feature edges meet here.
    Corner,
    /// A corner of seams, or where a seam meets the boundary: it stays.
    SeamCorner,
}

/// Classifies the vertex of `hole`. `cos_feature_angle` is that of the angle between normals above
/// which an edge is a feature edge; every edge of a seam is one. O(valence).
pub(crate) fn classify(
    hole: &Hole,
    surface: &Surface,
    wedges: Option<&Wedges>,
    cos_feature_angle: f64,
) -> Class {
    let mut features = [0; 2];
    let mut n_features = 0;
    let mut n_seams = 0;
    for i in inner_spokes(hole) {
        let before = if i == 0 { hole.slots.len() - 1 } else { i - 1 };
        let is_seam = wedges.is_some_and(|wedges| is_seam_spoke(hole, surface, wedges, before, i));
        n_seams += usize::from(is_seam);
        if is_seam || is_feature(hole, before, i, cos_feature_angle) {
            features[n_features.min(1)] = i;
            n_features += 1;
        }
    }
    match (hole.closed, n_features, n_seams) {
        (false, _, 0) => Class::Boundary,
        (true, 0, _) => Class::Simple,
        (true, 2, _) => Class::InteriorEdge(features),
        (true, _, 0) => Class::Corner,
        _ => Class::SeamCorner,
    }
}

/// Ring indices of the spokes with a star triangle on either side.
fn inner_spokes(hole: &Hole) -> std::ops::Range<usize> {
    if hole.closed { 0..hole.n_ring() } else { 1..hole.n_ring() - 1 }
}

fn is_feature(hole: &Hole, before: usize, after: usize, cos_feature_angle: f64) -> bool {
    let (a, b) = (hole.normal(before), hole.normal(after));
    dot(a, b) < cos_feature_angle * (length_sq(a) * length_sq(b)).sqrt()
}

fn is_seam_spoke(hole: &Hole, surface: &Surface, wedges: &Wedges, before: usize, after: usize) -> bool {
    let slots = [hole.slots[before], hole.slots[after]];
    wedges.differ(surface, slots, [hole.removed, hole.ring[after]])
}
