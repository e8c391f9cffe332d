//! Which pieces a vertex is split into (section 4.6), when no valid collapse is left.

use super::classify::{Geometry, VertexClass};
use super::ring::Ring;

/// The triangles at a vertex in pieces that lie one behind the other. Reused from vertex to vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct StarPieces {
    /// Slots of all triangles of the star.
    slots: Vec<u32>,
    /// Where each piece starts; the first at 0.
    starts: Vec<usize>,
}

impl StarPieces {
    /// Cuts the star: a non-manifold vertex into its fans, another one along its feature edges, and
    /// where those do not cut it, in half.
    pub(crate) fn cut(&mut self, ring: &Ring, geometry: &Geometry, class: VertexClass) {
        if !self.cut_at_features(ring, geometry, class) && ring.len() >= 2 {
            self.starts.push(ring.len() / 2);
        }
    }

    /// Cuts the star into fans or along its feature edges; false where it stays in one piece.
    pub(crate) fn cut_at_features(&mut self, ring: &Ring, geometry: &Geometry, class: VertexClass) -> bool {
        self.slots.clear();
        self.starts.clear();
        self.slots.extend_from_slice(&ring.slots);
        match (class, &geometry.features[..]) {
            (VertexClass::NonManifold, _) => {
                self.starts.extend(ring.fan_starts.iter().map(|&start| start as usize));
            }
            (_, &[first, _, ..]) if ring.is_cycle() => {
                self.slots.rotate_left(first);
                self.starts.extend(geometry.features.iter().map(|feature| feature - first));
            }
            (_, features) => {
                self.starts.push(0);
                if !ring.is_cycle() {
                    self.starts.extend_from_slice(features);
                }
            }
        }
        self.starts.len() > 1
    }

    /// Pieces after the first, which keeps the vertex.
    pub(crate) fn n_split_off(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Slots of the `i`-th piece after the first.
    pub(crate) fn split_off(&self, i: usize) -> &[u32] {
        let end = self.starts.get(i + 2).copied().unwrap_or(self.slots.len());
        &self.slots[self.starts[i + 1]..end]
    }
}
