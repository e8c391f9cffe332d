//! What a vertex is to the boundary, and which boundary vertices may be fused.
//!
//! Corners stay, and creases shrink along themselves only: the vertices of a fusion that lie on
//! creases must be neighbours along one crease, and the fusion point is one of them. The neighbours
//! along a crease are stored as vertices of the input; the vertices into which they have been
//! merged are looked up when needed.

use super::links::irregular;
use crate::flat::{DisjointSets, NO_INDEX};
use crate::geometry::vector::{Vector, cross, dot, length_sq, sub};
use crate::mesh::Tetrahedra;

/// What a vertex is to the boundary, from free to fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum BoundaryKind {
    /// Not on the boundary.
    Interior,
    /// On the boundary, without a feature edge.
    Smooth,
    /// Between two feature edges that continue each other.
    Crease,
    /// At any other feature edges.
    Corner,
    /// The tetrahedra around it do not fill a ball or half ball. The vertex stays, and is never
    /// part of a fusion that changes the boundary.
    Locked,
}

/// The kinds of all vertices, and the creases.
#[derive(Clone, Debug)]
pub(super) struct Creases {
    kinds: Vec<BoundaryKind>,
    /// Neighbours of each crease vertex along its crease.
    along: Vec<[u32; 2]>,
    /// Vertices that have become one, which is the root.
    merged: DisjointSets,
}

impl Creases {
    /// Classifies the vertices of a mesh. Edges at which the normals of the boundary turn by more
    /// than an angle, given by its cosine, are features. O(n).
    pub(super) fn new(mesh: &Tetrahedra, cos_feature_angle: f64) -> Self {
        let n_vertices = mesh.n_vertices();
        let mut rims: Vec<Vec<[u32; 2]>> = vec![Vec::new(); n_vertices];
        for [a, b, c] in mesh.boundary() {
            for (v, rim) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                rims[v as usize].push(rim);
            }
        }
        let mut creases = Self {
            kinds: vec![BoundaryKind::Interior; n_vertices],
            along: vec![[NO_INDEX; 2]; n_vertices],
            merged: DisjointSets::new(n_vertices),
        };
        for (v, rim) in (0..).zip(&rims).filter(|(_, rim)| !rim.is_empty()) {
            creases.classify(mesh, v, rim, cos_feature_angle);
        }
        for v in irregular(mesh, &rims) {
            creases.kinds[v as usize] = BoundaryKind::Locked;
            creases.along[v as usize] = [NO_INDEX; 2];
        }
        creases
    }

    /// Sets the kind of a boundary vertex with the given edges opposite to it.
    fn classify(&mut self, mesh: &Tetrahedra, v: u32, rim: &[[u32; 2]], cos_feature_angle: f64) {
        let Some(ring) = ring(rim) else {
            self.kinds[v as usize] = BoundaryKind::Locked;
            return;
        };
        let apex = mesh.position(v);
        let side = |w: u32| sub(mesh.position(w), apex);
        let normals: Vec<Vector> =
            (0..ring.len()).map(|i| cross(side(ring[i]), side(ring[(i + 1) % ring.len()]))).collect();
        let is_feature = |i: usize| {
            let (before, after) = (normals[(i + ring.len() - 1) % ring.len()], normals[i]);
            let scale_sq = length_sq(before) * length_sq(after);
            scale_sq > 0.0 && dot(before, after) < cos_feature_angle * scale_sq.sqrt()
        };
        let features: Vec<u32> = (0..ring.len()).filter(|&i| is_feature(i)).map(|i| ring[i]).collect();
        self.kinds[v as usize] = match *features {
            [] => BoundaryKind::Smooth,
            [a, b] if goes_on(side(a), side(b), cos_feature_angle) => {
                self.along[v as usize] = [a, b];
                BoundaryKind::Crease
            }
            _ => BoundaryKind::Corner,
        };
    }

    #[inline(always)]
    pub(super) fn kind(&self, v: u32) -> BoundaryKind {
        self.kinds[v as usize]
    }

    /// Where the fusion point of boundary vertices may be; `None` if they must not be fused.
    pub(super) fn anchor(&mut self, members: &[u32]) -> Option<Anchor> {
        let mut sharp = [NO_INDEX; 4];
        let mut n_sharp = 0;
        let mut corner = None;
        for &v in members {
            match self.kind(v) {
                BoundaryKind::Locked => return None,
                BoundaryKind::Corner if corner.is_some() => return None,
                BoundaryKind::Corner => corner = Some(v),
                BoundaryKind::Interior | BoundaryKind::Smooth => continue,
                BoundaryKind::Crease => {}
            }
            sharp[n_sharp] = v;
            n_sharp += 1;
        }
        let sharp = &sharp[..n_sharp];
        if n_sharp > 1 && !self.is_chain(sharp) {
            return None;
        }
        let mut vertices = [NO_INDEX; 4];
        let source = match corner {
            Some(ref corner) => std::slice::from_ref(corner),
            None if n_sharp > 0 => sharp,
            None => members,
        };
        vertices[..source.len()].copy_from_slice(source);
        Some(Anchor { vertices, n_vertices: source.len(), is_free: n_sharp == 0 })
    }

    /// Whether crease vertices, and perhaps a corner, are connected along a crease that continues
    /// at its other ends.
    fn is_chain(&mut self, sharp: &[u32]) -> bool {
        let mut n_links = 0;
        let mut ends = [NO_INDEX; 8];
        let mut n_ends = 0;
        let mut reached = 1_u32;
        for _ in 0..sharp.len() {
            for (i, &v) in sharp.iter().enumerate() {
                for next in self.crease_neighbours(v) {
                    let next = self.merged_into(next);
                    if let Some(j) = sharp.iter().position(|&w| w == next)
                        && reached & (1 << i | 1 << j) != 0
                    {
                        reached |= 1 << i | 1 << j;
                    }
                }
            }
        }
        for &v in sharp {
            for next in self.crease_neighbours(v) {
                let next = self.merged_into(next);
                if let Some(w) = sharp.iter().find(|&&w| w == next) {
                    // A link between two crease vertices is seen from both of them.
                    n_links += if self.kinds[*w as usize] == BoundaryKind::Crease { 1 } else { 2 };
                } else if ends[..n_ends].contains(&next) {
                    return false;
                } else {
                    ends[n_ends] = next;
                    n_ends += 1;
                }
            }
        }
        reached.count_ones() as usize == sharp.len() && n_links == 2 * (sharp.len() - 1)
    }

    /// Adds a vertex that replaces others.
    pub(super) fn add_vertex(&mut self, replaced: &[u32]) {
        let kind = replaced.iter().map(|&v| self.kind(v)).max().unwrap_or(BoundaryKind::Interior);
        let mut along = [NO_INDEX; 2];
        if kind == BoundaryKind::Crease {
            let mut n_along = 0;
            for &v in replaced {
                for next in self.crease_neighbours(v) {
                    let next = self.merged_into(next);
                    if !replaced.contains(&next) && n_along < 2 {
                        along[n_along] = next;
                        n_along += 1;
                    }
                }
            }
        }
        self.kinds.push(kind);
        self.along.push(along);
        self.merged.push_over(replaced);
    }

    /// Neighbours of a crease vertex along its crease; empty for any other vertex.
    fn crease_neighbours(&self, v: u32) -> impl Iterator<Item = u32> + use<> {
        let is_crease = self.kinds[v as usize] == BoundaryKind::Crease;
        self.along[v as usize].into_iter().filter(move |_| is_crease)
    }

    /// The vertex that `v` has been merged into; `v` itself while it lives.
    fn merged_into(&mut self, v: u32) -> u32 {
        if v == NO_INDEX { v } else { self.merged.root(v) }
    }
}

/// Where boundary vertices may be fused.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    vertices: [u32; 4],
    n_vertices: usize,
    /// Whether other places are allowed too.
    pub is_free: bool,
}

impl Anchor {
    /// The vertices at whose positions the fusion point may be.
    pub(super) fn vertices(&self) -> &[u32] {
        &self.vertices[..self.n_vertices]
    }
}

/// The vertices around a boundary vertex in order; `None` if they are not one closed ring. O(n log
/// n).
fn ring(rim: &[[u32; 2]]) -> Option<Vec<u32>> {
    let mut edges = rim.to_vec();
    let mut ends: Vec<u32> = rim.iter().map(|edge| edge[1]).collect();
    edges.sort_unstable();
    ends.sort_unstable();
    // Each vertex once as a start and once as an end: then a walk comes back to its start, or not
    // at all.
    if edges.iter().zip(&ends).any(|(edge, &end)| edge[0] != end)
        || ends.windows(2).any(|pair| pair[0] == pair[1])
    {
        return None;
    }
    let start = rim.first()?[0];
    let mut ring = vec![start];
    let mut last = start;
    loop {
        let at = edges.binary_search_by_key(&last, |edge| edge[0]).ok()?;
        last = edges[at][1];
        if last == start {
            break;
        }
        ring.push(last);
    }
    // Several rings would leave some out.
    (ring.len() == rim.len()).then_some(ring)
}

/// Whether two edges at a vertex form one line that turns by less than the angle.
fn goes_on(a: Vector, b: Vector, cos_angle: f64) -> bool {
    -dot(a, b) > cos_angle * (length_sq(a) * length_sq(b)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_is_all_edges_once_around() {
        assert_eq!(ring(&[[3, 1], [7, 3], [1, 7]]), Some(vec![3, 1, 7]));
        let broken: [&[[u32; 2]]; 6] = [
            &[],
            // Open, two rings, two ways on from 1, two ways into 1, one edge twice.
            &[[3, 1], [1, 7]],
            &[[3, 1], [1, 3], [5, 6], [6, 5]],
            &[[3, 1], [1, 7], [1, 3], [7, 3]],
            &[[3, 1], [7, 1], [1, 7]],
            &[[3, 1], [3, 1], [1, 3]],
        ];
        for rim in broken {
            assert_eq!(ring(rim), None, "{rim:?}");
        }
    }
}
