//! Which triangles replaced which, between two neighbouring levels.

use super::Lod;
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
    /// Entering triangles of all patches, patch by patch.
    entering: Vec<u32>,
    /// Patch `p` has `entering[starts[p]..starts[p + 1]]`.
    starts: Vec<u32>,
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
        let patch = self.patch[triangle] as usize;
        &self.entering[self.starts[patch] as usize..self.starts[patch + 1] as usize]
    }

    fn gather(triangles: Vec<[u32; 3]>, n_leaving: usize, mut sets: Sets) -> Self {
        let mut n_patches = 0;
        let mut patch_of_root = vec![u32::MAX; triangles.len()];
        let mut patch = Vec::with_capacity(triangles.len());
        for triangle in 0..triangles.len() {
            let entry = &mut patch_of_root[sets.root(triangle)];
            if *entry == u32::MAX {
                *entry = n_patches;
                n_patches += 1;
            }
            patch.push(*entry);
        }
        let mut starts = vec![0; n_patches as usize + 1];
        for &patch in &patch[n_leaving..] {
            starts[patch as usize + 1] += 1;
        }
        for patch in 0..n_patches as usize {
            starts[patch + 1] += starts[patch];
        }
        let mut next = starts.clone();
        let mut entering = vec![0; triangles.len() - n_leaving];
        // Slots, and so triangles, are counted in 32 bits.
        for (triangle, &patch) in (0u32..).zip(&patch).skip(n_leaving) {
            let place = &mut next[patch as usize];
            entering[*place as usize] = triangle;
            *place += 1;
        }
        Self { triangles, n_leaving, entering, starts, patch }
    }
}

/// Triangles at one directed edge.
#[derive(Clone, Copy, Default)]
struct AtEdge {
    leaving: Option<usize>,
    entering: Option<usize>,
}

/// Joins the triangles of each patch.
fn join(triangles: &[[u32; 3]], n_leaving: usize) -> Sets {
    let mut sets = Sets::new(triangles.len());
    let mut edges: HashMap<[u32; 2], AtEdge> = HashMap::with_capacity(3 * triangles.len());
    for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
        for edge in [[a, b], [b, c], [c, a]] {
            let at_edge = edges.entry(edge).or_default();
            let known = if triangle < n_leaving { &mut at_edge.leaving } else { &mut at_edge.entering };
            match *known {
                // A second triangle at the same directed edge: not an oriented manifold.
                Some(other) => sets.join(triangle, other),
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

/// Disjoint sets of the numbers below a count.
///
/// Reference: R. E. Tarjan: "Efficiency of a good but not linear set union algorithm" (Journal of
/// the ACM 22, 1975), with path halving.
struct Sets {
    parents: Vec<usize>,
}

impl Sets {
    fn new(len: usize) -> Self {
        Self { parents: (0..len).collect() }
    }

    fn root(&mut self, mut member: usize) -> usize {
        while self.parents[member] != member {
            self.parents[member] = self.parents[self.parents[member]];
            member = self.parents[member];
        }
        member
    }

    /// The smaller root stays, so the sets do not depend on the order of joining.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parents[high] = low;
    }
}
