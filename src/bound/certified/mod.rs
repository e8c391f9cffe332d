//! A proven bound on the two-sided Hausdorff distance between the input and every level.
//!
//! The naive proof cuts each surface into pieces and looks for a near triangle of the other surface
//! for every piece, in both directions, after every removal. Here both directions follow from one
//! continuous map that is carried along and changed only inside the hole of each removal;
//! docs/proof.md gives the argument in full.
//!
//! The map takes the input *onto* the current mesh. A source vertex that is still alive is its own
//! image; any other one belongs to a triangle and its image is the nearest point there. A source
//! edge runs through triangles in turn ([`chains`]), crossing each edge between two of them at the
//! nearest point of that edge. On a source triangle the crossings are joined by chords, the pieces
//! between chords lie in one current triangle each, and the map is affine on them. The distance to
//! a convex set is convex, so no point moves farther than a corner of its piece: the largest
//! displacement over source vertices and crossings bounds the distance from input to mesh, and
//! because the map is onto also from mesh to input.
//!
//! Replacing the star of a vertex moves only what is mapped into the star. Its vertices get new
//! triangles; a source edge enters and leaves the hole over ring edges, which stay, and takes the
//! one path between two triangles that the hole's [`dual_tree`] has.

pub(crate) mod chains;
mod change;
pub(crate) mod contents;
pub(crate) mod dual_tree;
pub(crate) mod images;
mod labels;
mod location;
mod records;
mod removal;
mod route;
pub(crate) mod source;
mod star;
mod transfer;

use super::replacement::Replacement;
use crate::geometry::vector::{length, max, min, widen};
use crate::mesh::{Hole, MAX_VALENCE, Renumbering, Surface, TooMany, check_places};
use chains::Chains;
use change::Assignment;
pub(crate) use change::MapChange;
use contents::Contents;
use source::SourceEdges;
use std::collections::HashMap;
pub(crate) use transfer::Transfer;

/// A displacement is followed up to so many times its limit. The filling was chosen to be within
/// the limit, so that little is learned from going on for long.
pub(crate) const REACH: f64 = 1.3;

/// Most covered vertices that are asked whether a source edge leads from them to the removed one.
const MAX_ASKED_BELOW: usize = 16;

/// No corner, of a vertex that is removed or that is not.
const NOT_ON_RIM: u8 = u8::MAX;
const ALIVE: u8 = u8::MAX - 1;

/// Added to every bound, as a multiple of the extent of mesh and origin. The rounding errors of a
/// displacement, a few dozen operations in `f64` on exact `f32`, are a millionth of it; the rest
/// covers a check of the bound in `f32`, as MeshLab's Metro does in part: it finds up to 4e-7
/// of the diagonal between a mesh and itself.
const SLACK: f64 = 4.0 * f32::EPSILON as f64;

/// The map from the input onto the current mesh.
#[derive(Clone, Debug)]
pub(crate) struct Certified {
    source: SourceEdges,
    chains: Chains,
    contents: Contents,
    /// For a removed vertex of the boundary: the corner of its triangle at which its boundary edge
    /// starts. [`NOT_ON_RIM`] for other removed ones, [`ALIVE`] for those that are not removed.
    rim_corner: Vec<u8>,
    /// Slot of the triangle that each removed vertex of the boundary belongs to.
    rim_slots: HashMap<u32, u32>,
    slack: f64,
}

impl Certified {
    /// The identity on `surface`, which is the input but for `rounding`: how far reading it moved
    /// the worst vertex.
    pub(crate) fn new(surface: &Surface, rounding: f64) -> Self {
        let (n_slots, n_vertices) = (surface.n_slots(), surface.n_vertices());
        let source = SourceEdges::new(n_vertices, surface.iter().map(|(_, corners)| corners));
        let points = surface.positions().iter().map(|&p| widen(p));
        let (low, high) = points.fold(([0.0; 3], [0.0; 3]), |(low, high), p| (min(low, p), max(high, p)));
        // The box about mesh and origin: no less than the diagonal of the mesh, or than any
        // coordinate.
        let extent = length(low) + length(high);
        Self {
            chains: Chains::new(source.n_edges()),
            contents: Contents::new(n_slots),
            rim_corner: vec![ALIVE; n_vertices],
            rim_slots: HashMap::new(),
            source,
            slack: SLACK * extent + rounding,
        }
    }

    /// What the replacement changes in the map, and the bound; or, where that is above `limit`,
    /// some value above the limit and no larger than it, followed up to [`REACH`] times the limit
    /// at most. O(vertices and edges mapped into the star).
    pub(crate) fn change(
        &self,
        replacement: Replacement<'_>,
        limit: f64,
        transfer: &mut Transfer,
    ) -> Result<(f64, MapChange), f64> {
        match transfer.change(self, replacement, limit) {
            Ok((displacement, change)) if displacement + self.slack <= limit => {
                Ok((displacement + self.slack, change))
            }
            Ok((displacement, _)) | Err(displacement) => Err(displacement + self.slack),
        }
    }

    /// Whether the pools have room for these changes of the stars of their holes. O(changes).
    ///
    /// # Errors
    ///
    /// What there would be too many of.
    pub(crate) fn check_room<'a>(
        &self,
        changes: impl Iterator<Item = (&'a Hole, &'a MapChange)>,
    ) -> Result<(), TooMany> {
        let (mut of_chains, mut of_contents) = (0, 0);
        for (hole, change) in changes {
            of_chains += Chains::n_words_of(change.chains.len(), change.portions.len());
            let n_mapped = change.assignments.len() + change.through.len();
            of_contents += Contents::n_words_of(hole.slots.len(), n_mapped);
        }
        check_places("portions of source edges", self.chains.n_words(), of_chains)?;
        check_places("vertices and edges mapped into triangles", self.contents.n_words(), of_contents)
    }

    /// Carries the map over to the filling of each hole, one after another. No two changes have a
    /// star or a source edge in common, and there must be [room](Self::check_room) for them.
    pub(crate) fn apply_all<'a>(
        &mut self,
        changes: impl Iterator<Item = (&'a Hole, &'a MapChange)> + Clone + Send,
    ) {
        let Self { chains, contents, rim_corner, rim_slots, .. } = self;
        let of_chains = changes.clone();
        let set_chains = || of_chains.for_each(|(_, change)| change.set_chains(chains));
        let fill_slots = || {
            for (hole, change) in changes {
                change.fill_slots(hole, contents, |Assignment { vertex, rim_corner: corner, .. }, slot| {
                    rim_corner[vertex as usize] = corner;
                    if corner != NOT_ON_RIM {
                        rim_slots.insert(vertex, slot);
                    }
                });
            }
        };
        rayon::join(set_chains, fill_slots);
    }

    /// Gives back memory that finished removals left behind, of both pools once one of them has
    /// enough of it, since they are closed up side by side. O(words) when it works, O(1) otherwise.
    pub(crate) fn compact(&mut self) {
        let Self { chains, contents, .. } = self;
        if chains.has_gaps() || contents.has_gaps() {
            rayon::join(|| chains.close_up(), || contents.close_up());
        }
    }

    /// Gives every slot its new number. O(words of the proof).
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        let Self { chains, contents, .. } = self;
        rayon::join(|| chains.renumber_slots(slots), || contents.renumber_slots(slots));
        for slot in self.rim_slots.values_mut() {
            *slot = slots.place(*slot);
        }
    }

    /// Makes `covered` the source vertices whose image lies in the star of `hole`: the removed one
    /// first.
    pub(crate) fn gather(&self, hole: &Hole, covered: &mut Vec<u32>) {
        covered.clear();
        covered.push(hole.removed);
        hole.slots.iter().for_each(|&slot| covered.extend_from_slice(self.contents.vertices(slot)));
    }

    /// Shows `take` the other ends of those source edges at the vertex of `hole` that have no
    /// chain, each once: ring vertices, with their places on the ring, or vertices mapped into the
    /// star, which are `covered`. Of many edges, or to many vertices in the star, some are left
    /// out. O(valence), but O(edges) at a hub.
    pub(crate) fn for_each_unchained(
        &self,
        hole: &Hole,
        covered: &[u32],
        mut take: impl FnMut(u32, Option<usize>),
    ) {
        let v = hole.removed;
        let Self { source, chains, .. } = self;
        let unchained_up = source.up(v).filter(|&(edge, _)| !chains.has(edge));
        for (_, high) in unchained_up.take(MAX_VALENCE) {
            take(high, hole.ring.iter().position(|&r| r == high));
        }
        let corners = hole.ring.iter().enumerate().map(|(at, &r)| (r, Some(at)));
        let covered = covered.iter().filter(|&&x| x != v).map(|&x| (x, None));
        for (low, corner) in corners.chain(covered.take(MAX_ASKED_BELOW)).filter(|&(other, _)| other < v) {
            let is_end = source.edge(low, v).is_some_and(|edge| !chains.has(edge));
            if is_end {
                take(low, corner);
            }
        }
    }

    fn is_alive(&self, v: u32) -> bool {
        self.rim_corner[v as usize] == ALIVE
    }
}
