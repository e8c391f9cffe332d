//! Which triangles replaced which, between two neighbouring levels.

use super::Lod;
use crate::flat::{DisjointSets, Groups, NO_INDEX};
use std::collections::HashMap;

/// The part of the surface that changes between a level and the next one, cut into patches: the
/// smallest sets of leaving and entering triangles that fill the same place.
///
/// A file does not store the removals between two levels, but the triangles tell them. An edge that
/// exists before the change or after it, but not both, is inside a patch and joins the triangles at
/// it. A directed edge that exists before and after is on the border of a patch, and joins the
/// leaving and the entering triangle at it. Surfaces that are not oriented or not manifold give
/// larger patches, never smaller ones.
pub(super) struct Patches {
    /// Leaving triangles, then entering ones.
    pub triangles: Vec<[u32; 3]>,
    pub n_leaving: usize,
    /// Entering triangles of each patch.
    entering: Groups<u32>,
    /// Patch of each triangle.
    patch: Vec<u32>,
}

impl Patches {
    /// Between `level` and the level after it. Cost: linear in the triangles that change.
    pub(super) fn between(lod: &Lod, level: u32) -> Self {
        let delta = lod.delta(level, level + 1);
        let runs_of = |runs: crate::tree::Difference| -> Vec<[u32; 3]> {
            runs.flat_map(|run| lod.indices()[run.index_range(3)].as_chunks().0).copied().collect()
        };
        let mut triangles = runs_of(delta.leaving());
        let n_leaving = triangles.len();
        triangles.extend(runs_of(delta.entering()));
        let roots = join(&triangles, n_leaving);
        Self::gather(triangles, n_leaving, roots)
    }

    /// The entering triangles of the patch that a triangle is in.
    pub(super) fn replacements(&self, triangle: usize) -> &[u32] {
        self.entering.of(self.patch[triangle])
    }

    fn gather(triangles: Vec<[u32; 3]>, n_leaving: usize, mut sets: DisjointSets) -> Self {
        let mut n_patches = 0;
        let mut patch_of_root = vec![NO_INDEX; triangles.len()];
        let mut patch = Vec::with_capacity(triangles.len());
        for triangle in (0..).take(triangles.len()) {
            let entry = &mut patch_of_root[sets.root(triangle) as usize];
            if *entry == NO_INDEX {
                *entry = n_patches;
                n_patches += 1;
            }
            patch.push(*entry);
        }
        let of_entering = patch.iter().copied().zip(0..).skip(n_leaving);
        let entering = Groups::new(n_patches as usize, of_entering);
        Self { triangles, n_leaving, entering, patch }
    }
}

/// Triangles at one directed edge.
#[derive(Clone, Copy, Default)]
struct AtEdge {
    leaving: Option<u32>,
    entering: Option<u32>,
}

/// Joins the triangles of each patch.
fn join(triangles: &[[u32; 3]], n_leaving: usize) -> DisjointSets {
    let mut sets = DisjointSets::new(triangles.len());
    let mut edges: HashMap<[u32; 2], AtEdge> = HashMap::with_capacity(3 * triangles.len());
    for (triangle, &[a, b, c]) in (0..).zip(triangles) {
        for edge in [[a, b], [b, c], [c, a]] {
            let at_edge = edges.entry(edge).or_default();
            let known =
                if (triangle as usize) < n_leaving { &mut at_edge.leaving } else { &mut at_edge.entering };
            match *known {
                // A second triangle at the same directed edge: not an oriented manifold.
                Some(other) => {
                    sets.join(triangle, other);
                }
                None => *known = Some(triangle),
            }
        }
    }
    let none = AtEdge::default();
    for (&[from, to], here) in &edges {
        let there = edges.get(&[to, from]).unwrap_or(&none);
        if let (Some(leaving), Some(entering)) = (here.leaving, here.entering) {
            sets.join(leaving, entering);
        }
        let is_before = here.leaving.is_some() || there.leaving.is_some();
        let is_after = here.entering.is_some() || there.entering.is_some();
        if is_before && is_after {
            continue;
        }
        for (here, there) in [(here.leaving, there.leaving), (here.entering, there.entering)] {
            if let (Some(here), Some(there)) = (here, there) {
                sets.join(here, there);
            }
        }
    }
    sets
}
