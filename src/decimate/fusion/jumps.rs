//! Jumps: points at which a field has several values, one for each side of a fault or an interface.
//!
//! Points decide what may be fused. Each corner of a tetrahedron refers besides to a vertex, which
//! is a point with one value of each field. A *jump face* lies between two tetrahedra that do not
//! have the same vertices there; its points are *at the jump*.
//!
//! Values never cross a jump: of the fused points one at most is at a jump, and the fusion point is
//! at its place. So the jump faces stay where they are. The tetrahedra on the side of the fusion
//! get the new vertex; those on other sides keep theirs, whose place and values are as before. Two
//! points at a jump are not fused.

use crate::mesh::{Tetrahedra, jump_faces};

/// The vertices of all corners, and the points at jumps.
#[derive(Clone, Debug, Default)]
pub(super) struct Jumps {
    /// The vertices at the corners of every slot; none if each point has one vertex, of the same
    /// number.
    vertices: Vec<[u32; 4]>,
    /// Whether each point is at a jump.
    is_at_jump: Vec<bool>,
}

impl Jumps {
    /// The jumps of a mesh; `vertices` has the vertices at the corners of each tetrahedron if any
    /// point has several. O(n).
    pub(super) fn new(corners: &[[u32; 4]], vertices: Option<Vec<[u32; 4]>>, n_points: usize) -> Self {
        let Some(vertices) = vertices else { return Self::default() };
        let mut is_at_jump = vec![false; n_points];
        let faces = jump_faces(corners, &vertices, n_points);
        faces.as_flattened().iter().for_each(|&point| is_at_jump[point as usize] = true);
        // Tetrahedra may also meet in a point or an edge alone.
        for (&point, &vertex) in corners.as_flattened().iter().zip(vertices.as_flattened()) {
            is_at_jump[point as usize] |= point != vertex;
        }
        Self { vertices, is_at_jump }
    }

    /// Whether each point has one vertex, of the same number.
    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Whether a point is on a jump face, or has several vertices.
    #[inline(always)]
    pub(super) fn is_at(&self, point: u32) -> bool {
        self.is_at_jump.get(point as usize).is_some_and(|&is_at_jump| is_at_jump)
    }

    /// The vertices of the tetrahedron in `slot`, whose points are `corners`.
    #[inline(always)]
    pub(super) fn vertices(&self, slot: u32, corners: [u32; 4]) -> [u32; 4] {
        self.vertices.get(slot as usize).copied().unwrap_or(corners)
    }

    /// The vertices at the ends of an edge: those of the first tetrahedron there. O(star) at a
    /// jump.
    pub(super) fn at_edge(&self, mesh: &Tetrahedra, [a, b]: [u32; 2]) -> [u32; 2] {
        if !self.is_at(a) && !self.is_at(b) {
            return [a, b];
        }
        for &slot in mesh.slots_at(a) {
            let Some(corners) = mesh.get(slot) else { continue };
            let at = |point: u32| corners.iter().position(|&corner| corner == point);
            if let (Some(at_a), Some(at_b)) = (at(a), at(b)) {
                let vertices = self.vertices(slot, corners);
                return [vertices[at_a], vertices[at_b]];
            }
        }
        [a, b]
    }

    /// The tetrahedron in `slot` gets a new vertex at a corner.
    pub(super) fn set(&mut self, slot: u32, corner: usize, vertex: u32) {
        if let Some(vertices) = self.vertices.get_mut(slot as usize) {
            vertices[corner] = vertex;
        }
    }

    /// A new point takes the place of others.
    pub(super) fn add_point(&mut self, replaced: &[u32]) {
        if !self.vertices.is_empty() {
            self.is_at_jump.push(replaced.iter().any(|&point| self.is_at(point)));
        }
    }
}
