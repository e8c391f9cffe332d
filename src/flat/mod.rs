//! Flat arrays addressed by indices of 32 bits: what meshes, decimators, trees and queries share.

mod canonical;
mod disjoint_sets;
mod groups;

pub(crate) use canonical::canonical;
pub(crate) use disjoint_sets::DisjointSets;
pub(crate) use groups::Groups;

/// The index that stands for no vertex, slot or place.
pub(crate) const NO_INDEX: u32 = u32::MAX;

/// An index or a count of a mesh, whose simplices and vertices leave room below [`NO_INDEX`], see
/// `MAX_SIMPLICES`.
#[expect(clippy::cast_possible_truncation, reason = "checked before a mesh is taken")]
#[inline(always)]
pub(crate) fn to_index(at: usize) -> u32 {
    debug_assert!(at < NO_INDEX as usize, "indices are below the one that stands for none");
    at as u32
}
