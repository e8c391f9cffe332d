//! A vertex with its surroundings.

use super::classify::{Class, Geometry, classify};
use super::complex::Complex;
use super::error::local_error;
use super::ring::Ring;
use super::wedges::Wedges;

/// What lies around a vertex. Reused from vertex to vertex.
#[derive(Clone, Debug, Default)]
pub(super) struct View {
    pub(super) ring: Ring,
    pub(super) geometry: Geometry,
    pub(super) class: Class,
}

/// Where a vertex is to wait, and the error that decides when its turn comes. Accumulated errors are to be added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// Nowhere: it is in no triangle, or locked.
    Nowhere,
    /// Among those that may be collapsed.
    Queued(f64),
    /// Among those that have to be split.
    Stuck(f64),
}

impl View {
    /// Looks at `v`. O(valence log valence).
    pub(super) fn gather(
        &mut self,
        complex: &Complex,
        wedges: Option<&Wedges>,
        v: u32,
        cos_feature_angle: f64,
    ) {
        self.ring.gather(complex, v);
        self.geometry.gather(complex, wedges, &self.ring, cos_feature_angle);
        self.class = classify(complex, &self.ring, &self.geometry);
    }

    /// Local error of the vertex.
    pub(super) fn error(&self) -> f64 {
        local_error(self.class, &self.ring, &self.geometry)
    }

    /// Effective edge length of the star (equation 4): what is lost at most when pieces of it vanish.
    pub(super) fn size(&self) -> f64 {
        self.geometry.area.sqrt()
    }

    /// Where the vertex is to wait.
    pub(super) fn place(&self) -> Place {
        match self.class {
            Class::Empty | Class::Locked => Place::Nowhere,
            class if class.may_collapse() => Place::Queued(self.error()),
            _ => Place::Stuck(self.error() + self.size()),
        }
    }
}
