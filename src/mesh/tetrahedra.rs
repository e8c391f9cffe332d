//! Tetrahedra while they are being fused: flat arrays, with the star of every vertex at hand.
//!
//! A tetrahedron keeps its slot while its corners change, and a slot is never used again. So the
//! star of a vertex stays right without being touched when tetrahedra around it die: the reader of
//! it passes over the dead. A new vertex gets its star at the end of the pool, once.

use crate::flat::{Groups, NO_INDEX};
use crate::geometry::vector::{cross, dot, sub};

/// Corners of the face opposite each corner, counter-clockwise seen from outside a tetrahedron of
/// positive volume.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// First corner of a slot whose tetrahedron is dead.
const DEAD: u32 = NO_INDEX;

/// Tetrahedra in slots over growing vertices.
///
/// Memory: 25 bytes per slot, 28 per vertex, 16 per tetrahedron in the stars.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tetrahedra {
    positions: Vec<[f32; 3]>,
    corners: Vec<[u32; 4]>,
    /// Bit `i`: nothing is on the other side of the face opposite corner `i`.
    boundary: Vec<u8>,
    misfits: Vec<[u32; 3]>,
    stars: Vec<StarRange>,
    pool: Vec<u32>,
    n_alive: usize,
    /// Entries of stars handed out: the work of a test.
    #[cfg(test)]
    n_read: std::sync::Arc<std::sync::atomic::AtomicU64>,
}

#[derive(Clone, Copy, Debug, Default)]
struct StarRange {
    start: u32,
    len: u32,
    /// Dead slots among them.
    n_dead: u32,
}

impl Tetrahedra {
    /// Tetrahedra over vertices at these positions, each in the slot of its index. No two share all
    /// four corners. O(n).
    pub(crate) fn new(positions: Vec<[f32; 3]>, corners: Vec<[u32; 4]>) -> Self {
        let at_corners = (0..).zip(&corners).flat_map(|(slot, t)| t.map(|v| (v, slot)));
        let (starts, pool) = Groups::new(positions.len(), at_corners).into_parts();
        let star = |ends: &[u32]| StarRange { start: ends[0], len: ends[1] - ends[0], n_dead: 0 };
        let stars = starts.windows(2).map(star).collect();
        let Sides { boundary, misfits } = Sides::new(&corners, positions.len());
        let n_alive = corners.len();
        Self {
            positions,
            corners,
            boundary,
            misfits,
            stars,
            pool,
            n_alive,
            #[cfg(test)]
            n_read: Default::default(),
        }
    }

    /// Tetrahedra alive.
    pub(crate) fn n_alive(&self) -> usize {
        self.n_alive
    }

    /// Slots, dead ones included.
    pub(crate) fn n_slots(&self) -> usize {
        self.corners.len()
    }

    /// Vertices, dead ones included.
    pub(crate) fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// Positions of all vertices.
    pub(crate) fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// A vertex's position in `f64`.
    #[inline(always)]
    pub(crate) fn position(&self, v: u32) -> [f64; 3] {
        self.positions[v as usize].map(f64::from)
    }

    /// Corners of the tetrahedron in a slot, if it is alive.
    #[inline(always)]
    pub(crate) fn get(&self, slot: u32) -> Option<[u32; 4]> {
        let corners = self.corners[slot as usize];
        (corners[0] != DEAD).then_some(corners)
    }

    /// Tetrahedra alive, with their slots.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, [u32; 4])> + '_ {
        (0..)
            .zip(&self.corners)
            .filter(|(_, corners)| corners[0] != DEAD)
            .map(|(slot, &corners)| (slot, corners))
    }

    /// Slots that hold or held a tetrahedron at `v`: all of its star, and dead ones.
    #[inline]
    pub(crate) fn slots_at(&self, v: u32) -> &[u32] {
        let StarRange { start, len, .. } = self.stars[v as usize];
        #[cfg(test)]
        self.n_read.fetch_add(len.into(), std::sync::atomic::Ordering::Relaxed);
        &self.pool[start as usize..][..len as usize]
    }

    /// Tetrahedra in the star of `v`, which is alive. O(1).
    #[inline(always)]
    pub(crate) fn n_at(&self, v: u32) -> u32 {
        let StarRange { len, n_dead, .. } = self.stars[v as usize];
        len - n_dead
    }

    /// Entries of stars handed out so far.
    #[cfg(test)]
    pub(crate) fn n_read(&self) -> u64 {
        self.n_read.load(std::sync::atomic::Ordering::Relaxed)
    }

    /// Faces of a tetrahedron on the boundary: bit `i` for the one opposite corner `i`.
    #[inline(always)]
    pub(crate) fn boundary_bits(&self, slot: u32) -> u8 {
        self.boundary[slot as usize]
    }

    /// The faces of the boundary, seen counter-clockwise from outside.
    pub(crate) fn boundary(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.iter().flat_map(|(slot, corners)| {
            let bits = self.boundary[slot as usize];
            (0..4).filter(move |i| bits >> i & 1 == 1).map(move |i| FACES[i].map(|j| corners[j]))
        })
    }

    /// Faces that did not part two tetrahedra at the start: of three or more, or of two on the same
    /// side.
    pub(crate) fn misfits(&self) -> &[[u32; 3]] {
        &self.misfits
    }

    /// Adds a vertex without a star.
    pub(crate) fn add_vertex(&mut self, position: [f32; 3]) {
        self.positions.push(position);
        #[expect(clippy::cast_possible_truncation, reason = "a star's entries are counted in u32")]
        self.stars.push(StarRange { start: self.pool.len() as u32, ..StarRange::default() });
    }

    /// The tetrahedron in `slot` dies.
    pub(crate) fn remove(&mut self, slot: u32) {
        for v in self.corners[slot as usize] {
            self.stars[v as usize].n_dead += 1;
        }
        self.corners[slot as usize][0] = DEAD;
        self.n_alive -= 1;
    }

    /// Takes the dead out of a star where they are many. O(its slots).
    pub(crate) fn purge(&mut self, v: u32) {
        let star = &mut self.stars[v as usize];
        if 4 * star.n_dead <= star.len {
            return;
        }
        let slots = &mut self.pool[star.start as usize..][..star.len as usize];
        let mut n_alive = 0;
        for i in 0..slots.len() {
            if self.corners[slots[i] as usize][0] != DEAD {
                slots[n_alive] = slots[i];
                n_alive += 1;
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "no more than before")]
        let len = n_alive as u32;
        (star.len, star.n_dead) = (len, 0);
    }

    /// Six times the volume of the tetrahedron in a slot; zero where it is dead.
    pub(crate) fn six_volumes(&self, slot: u32) -> f64 {
        self.get(slot).map_or(0.0, |corners| {
            let [a, b, c, d] = corners.map(|v| self.position(v));
            dot(cross(sub(b, a), sub(c, a)), sub(d, a))
        })
    }

    /// Puts the newest vertex in the place of a corner, with new boundary bits.
    pub(crate) fn move_corner(&mut self, slot: u32, corner: usize, boundary_bits: u8) {
        #[expect(clippy::cast_possible_truncation, reason = "vertices are counted in u32")]
        let newest = (self.positions.len() - 1) as u32;
        self.corners[slot as usize][corner] = newest;
        self.boundary[slot as usize] = boundary_bits;
        self.pool.push(slot);
        if let Some(star) = self.stars.last_mut() {
            star.len += 1;
        }
    }
}

/// How tetrahedra meet in their faces.
pub(super) struct Sides {
    /// Per tetrahedron, bit `i`: the face opposite corner `i` belongs to it alone.
    pub boundary: Vec<u8>,
    /// Faces that do not part two tetrahedra: of three or more, or of two on the same side.
    pub misfits: Vec<[u32; 3]>,
}

impl Sides {
    /// Faces meet in the list of their least vertex, so that nothing is hashed and no list is
    /// longer than a star. O(n).
    pub(super) fn new(tetrahedra: &[[u32; 4]], n_vertices: usize) -> Self {
        let mut sides = Self { boundary: vec![0; tetrahedra.len()], misfits: vec![] };
        for (v, list) in (0..).zip(faces_by_least_vertex(tetrahedra, n_vertices).iter_mut()) {
            list.sort_unstable();
            for same in list.chunk_by(|a, b| a.others == b.others) {
                match same {
                    [face] => sides.boundary[face.slot as usize] |= 1 << face.corner,
                    [a, b] if a.is_even(tetrahedra) != b.is_even(tetrahedra) => {}
                    _ => sides.misfits.push([v, same[0].others[0], same[0].others[1]]),
                }
            }
        }
        sides
    }
}

/// The faces that belong to one tetrahedron only, seen counter-clockwise from outside. O(n).
pub(super) fn boundary_triangles(tetrahedra: &[[u32; 4]], n_vertices: usize) -> Vec<[u32; 3]> {
    let faces = boundary_faces(tetrahedra, n_vertices);
    faces.map(|(tetrahedron, face)| face.map(|i| tetrahedra[tetrahedron][i])).collect()
}

/// As [`boundary_triangles`], each as its tetrahedron and the corners there. O(n).
pub(crate) fn boundary_faces(
    tetrahedra: &[[u32; 4]],
    n_vertices: usize,
) -> impl Iterator<Item = (usize, [usize; 3])> {
    let bits = Sides::new(tetrahedra, n_vertices).boundary;
    bits.into_iter().enumerate().flat_map(|(tetrahedron, bits)| {
        (0..4).filter(move |i| bits >> i & 1 == 1).map(move |i| (tetrahedron, FACES[i]))
    })
}

/// The faces between tetrahedra that do not have the same vertices there. `corners` has the points
/// of each tetrahedron, `vertices` the vertices at them. O(n).
pub(crate) fn jump_faces(corners: &[[u32; 4]], vertices: &[[u32; 4]], n_points: usize) -> Vec<[u32; 3]> {
    let vertex = |slot: u32, point: u32| {
        let at = corners[slot as usize].iter().position(|&corner| corner == point);
        at.map(|at| vertices[slot as usize][at])
    };
    let mut found = vec![];
    for (v, list) in (0..).zip(faces_by_least_vertex(corners, n_points).iter_mut()) {
        list.sort_unstable();
        for same in list.chunk_by(|a, b| a.others == b.others) {
            let face = [v, same[0].others[0], same[0].others[1]];
            let differs =
                |other: &Face| face.iter().any(|&p| vertex(other.slot, p) != vertex(same[0].slot, p));
            if same[1..].iter().any(differs) {
                found.push(face);
            }
        }
    }
    found
}

/// A face in the list of its least vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Face {
    /// Its other vertices, ascending.
    pub others: [u32; 2],
    pub slot: u32,
    /// The corner of the slot that it is opposite to.
    pub corner: u32,
}

impl Face {
    /// Whether its corners are in ascending order, or an even number of swaps away from it, seen
    /// from outside its tetrahedron. Of two neighbours, one sees the face between them so.
    pub(super) fn is_even(&self, tetrahedra: &[[u32; 4]]) -> bool {
        let [a, b, c] = FACES[self.corner as usize].map(|i| tetrahedra[self.slot as usize][i]);
        (u8::from(a > b) + u8::from(b > c) + u8::from(a > c)) & 1 == 0
    }
}

/// The faces of all tetrahedra by their least vertex. O(n).
pub(super) fn faces_by_least_vertex(tetrahedra: &[[u32; 4]], n_vertices: usize) -> Groups<Face> {
    let face = |slot: u32, tetrahedron: &[u32; 4], corner: u32| {
        let mut vertices = FACES[corner as usize].map(|i| tetrahedron[i]);
        vertices.sort_unstable();
        let [least, a, b] = vertices;
        (least, Face { others: [a, b], slot, corner })
    };
    let faces = (0..).zip(tetrahedra).flat_map(|(slot, t)| [0, 1, 2, 3].map(|corner| face(slot, t, corner)));
    Groups::new(n_vertices, faces)
}
