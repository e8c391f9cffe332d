//! A vertex with its surroundings.

use super::classify::{Geometry, VertexClass, classify};
use super::error::local_error;
use super::ring::Ring;
use crate::mesh::{Surface, Wedges};

/// What lies around a vertex. Reused from vertex to vertex.
#[derive(Clone, Debug, Default)]
pub(super) struct Surroundings {
    pub(super) ring: Ring,
    pub(super) geometry: Geometry,
    pub(super) class: VertexClass,
}

/// Which queue a vertex belongs to, and its error there without what has accumulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum QueuePlace {
    /// Nowhere: it is in no triangle, or locked.
    Nowhere,
    /// Among those that may be collapsed.
    Queued(f64),
    /// Among those that have to be split.
    Stuck(f64),
}

impl Surroundings {
    /// Looks at `v`. O(valence log valence).
    pub(super) fn gather(
        &mut self,
        surface: &Surface,
        wedges: Option<&Wedges>,
        v: u32,
        cos_feature_angle: f64,
    ) {
        self.ring.gather(surface, v);
        self.geometry.gather(surface, wedges, &self.ring, cos_feature_angle);
        self.class = classify(surface, &self.ring, &self.geometry);
    }

    /// Local error of the vertex.
    pub(super) fn error(&self) -> f64 {
        local_error(self.class, &self.ring, &self.geometry)
    }

    /// Effective edge length of the star (equation 4): what is lost at most when pieces of it
    /// vanish.
    pub(super) fn size(&self) -> f64 {
        self.geometry.area.sqrt()
    }

    /// Which queue the vertex belongs to.
    pub(super) fn place(&self) -> QueuePlace {
        match self.class {
            VertexClass::Empty | VertexClass::Locked => QueuePlace::Nowhere,
            class if class.may_collapse() => QueuePlace::Queued(self.error()),
            _ => QueuePlace::Stuck(self.error() + self.size()),
        }
    }
}
