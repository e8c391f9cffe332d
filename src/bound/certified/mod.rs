//! A proven bound on the two-sided Hausdorff distance between the input and every level.
//!
//! The naive proof cuts each surface into pieces and looks for a near triangle of the other surface for every piece, in
//! both directions, after every removal. Here both directions follow from one continuous map that is carried along and
//! changed only inside the hole of each removal; ARCHITECTURE.md gives the argument in full.
//!
//! The map takes the input *onto* the current mesh. A source vertex that is still alive is its own image; any other
//! one belongs to a triangle and its image is the nearest point there. A source edge runs through triangles in turn
//! ([`chains`]), crossing each edge between two of them at the nearest point of that edge. On a source triangle the
//! crossings are joined by chords, the pieces between chords lie in one current triangle each, and the map is affine on
//! them. The distance to a convex set is convex, so no point moves farther than a corner of its piece: the largest
//! displacement over source vertices and crossings bounds the distance from input to mesh, and because the map is onto
//! also from mesh to input.
//!
//! Replacing the star of a vertex moves only what is mapped into the star. Its vertices get new triangles; a source
//! edge enters and leaves the hole over ring edges, which stay, and takes the one path between two triangles that the
//! hole's [`dual_tree`] has.

pub mod chains;
pub mod dual_tree;
pub mod images;
mod labels;
mod removal;
pub mod source;
mod transfer;

use super::Replacement;
use super::covered::Covered;
use super::removed::RemovedVertices;
use crate::geometry::vector::{length, max, min, widen};
use crate::mesh::{Hole, Surface};
use chains::Chains;
use removal::Removal;
use source::SourceEdges;
use transfer::Assignment;
pub use transfer::{Change, Transfer};

/// No slot, or no corner.
const NONE: u32 = u32::MAX;
const NOT_ON_RIM: u8 = u8::MAX;

/// Added to every bound, as a multiple of the extent of mesh and origin. The rounding errors of a
/// displacement, a few dozen operations in `f64` on exact `f32`, are a millionth of it; the rest covers whoever checks the
/// bound in `f32`, as MeshLab's Metro does in part: it finds up to 4e-7 of the diagonal between a mesh and itself.
const SLACK: f64 = 4.0 * f32::EPSILON as f64;

/// The map from the input onto the current mesh.
#[derive(Clone, Debug)]
pub struct Certified {
    source: SourceEdges,
    chains: Chains,
    removed: RemovedVertices,
    /// Slot of the triangle that each removed vertex belongs to.
    slot_of: Vec<u32>,
    /// For a removed vertex of the boundary: the corner of its triangle at which its boundary edge starts.
    rim_corner: Vec<u8>,
    /// Last batch in which the chain of each source edge was set.
    set_in_batch: Vec<u32>,
    batch: u32,
    slack: f64,
}

impl Certified {
    /// The identity on `surface`, which is the input but for `rounding`: how far reading it moved the worst vertex.
    pub fn new(surface: &Surface, rounding: f64) -> Self {
        let (n_slots, n_vertices) = (surface.n_slots(), surface.n_vertices());
        let source = SourceEdges::new(n_vertices, surface.iter().map(|(_, corners)| corners));
        let points = surface.positions().iter().map(|&p| widen(p));
        let (low, high) = points.fold(([0.0; 3], [0.0; 3]), |(low, high), p| (min(low, p), max(high, p)));
        // The box about mesh and origin: no less than the diagonal of the mesh, or than any coordinate.
        let extent = length(low) + length(high);
        Self {
            chains: Chains::new(source.n_edges(), n_slots),
            removed: RemovedVertices::new(n_slots, n_vertices),
            slot_of: vec![NONE; n_vertices],
            rim_corner: vec![NOT_ON_RIM; n_vertices],
            set_in_batch: vec![0; source.n_edges()],
            batch: 0,
            source,
            slack: SLACK * extent + rounding,
        }
    }

    /// A bound on the displacement inside the hole once it is closed, or some value above `limit` if the bound is above
    /// that. `covered` holds [`Self::vertices_in`] the hole. O(vertices and edges mapped into the star).
    pub fn bound(
        &self,
        replacement: Replacement<'_>,
        covered: &Covered,
        limit: f64,
        transfer: &mut Transfer,
    ) -> f64 {
        transfer.displacement(Removal { certified: self, replacement, covered }, limit) + self.slack
    }

    /// What the replacement changes in the map. After [`Self::bound`] of the same replacement, with the same `transfer`.
    pub fn change(&self, replacement: Replacement<'_>, covered: &Covered, transfer: &mut Transfer) -> Change {
        transfer.change(Removal { certified: self, replacement, covered })
    }

    /// Starts a batch of changes that are found first and applied afterwards.
    pub fn start_batch(&mut self) {
        self.batch += 1;
    }

    /// Whether no chain that `change` sets was set since the batch started. All else that a change depends on belongs to
    /// its own star.
    pub fn is_current(&self, change: &Change) -> bool {
        change.chains.iter().all(|&(edge, _)| self.set_in_batch[edge as usize] != self.batch)
    }

    /// Carries the map over to the filling.
    pub fn apply(&mut self, hole: &Hole, change: &Change) {
        let mut start = 0;
        for &(edge, end) in &change.chains {
            self.chains.set(edge, &change.portions[start..end]);
            self.set_in_batch[edge as usize] = self.batch;
            start = end;
        }
        self.removed.clear(hole);
        for &Assignment { vertex, label, rim_corner } in &change.assignments {
            let slot = hole.slots[usize::from(label)];
            self.removed.add(vertex, slot);
            self.slot_of[vertex as usize] = slot;
            self.rim_corner[vertex as usize] = rim_corner;
        }
    }

    /// Source vertices whose image lies in the star of `hole`, the removed one first.
    pub fn vertices_in<'a>(&'a self, hole: &'a Hole) -> impl Iterator<Item = u32> + 'a {
        self.removed.of_hole(hole)
    }

    fn is_alive(&self, v: u32) -> bool {
        self.slot_of[v as usize] == NONE
    }
}
