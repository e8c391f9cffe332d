//! Numbers along a curve through space, so that a star and what it stands for lie together in
//! memory.
//!
//! The order of a file says little about what is near what: scanners write stripes, modellers write
//! parts. Every array of the decimation runs parallel to the vertices or to the triangles, so their
//! order decides how often it waits for memory.

use crate::geometry::morton::Grid;
use rayon::prelude::*;

/// Places of the vertices and triangles of a mesh along a Morton curve.
///
/// Memory: 8 bytes per vertex; 16 more while it is made.
#[derive(Clone, Debug)]
pub(crate) struct Numbering {
    /// Vertex at each place.
    vertices: Vec<u32>,
    /// Place of each vertex.
    places: Vec<u32>,
}

impl Numbering {
    /// Numbers vertices by their cells on the curve, ties in the order of the mesh. O(n log n).
    pub(crate) fn along_curve(positions: &[[f32; 3]]) -> Self {
        let grid = Grid::around(positions);
        let mut keys: Vec<(u64, u32)> =
            (0..).zip(positions).map(|(vertex, &position)| (grid.morton(position), vertex)).collect();
        keys.par_sort_unstable();
        let vertices: Vec<u32> = keys.iter().map(|&(_, vertex)| vertex).collect();
        drop(keys);
        let mut places = vec![0; positions.len()];
        for (place, &vertex) in (0..).zip(&vertices) {
            places[vertex as usize] = place;
        }
        Self { vertices, places }
    }

    /// Place of `vertex`.
    pub(crate) fn place(&self, vertex: u32) -> u32 {
        self.places[vertex as usize]
    }

    /// Sorts triangles of vertices by their first corner along the curve. O(n log n).
    pub(crate) fn sort_triangles(&self, triangles: &mut [[u32; 3]]) {
        triangles.par_sort_by_key(|corners| corners.map(|vertex| self.place(vertex)).into_iter().min());
    }

    /// Vertex at each place.
    pub(crate) fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Vertex at each place.
    pub(crate) fn into_vertices(self) -> Vec<u32> {
        self.vertices
    }

    /// What belongs to each vertex, in the order of the places.
    pub(crate) fn arrange<T: Copy>(&self, of_vertices: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&vertex| of_vertices[vertex as usize]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_in_space_get_neighbouring_places() {
        let positions: Vec<[f32; 3]> = [5, 0, 3, 7, 2, 6, 1, 4].map(|x| [x as f32, 0.0, 0.0]).to_vec();
        let numbering = Numbering::along_curve(&positions);
        let arranged: Vec<f32> = numbering.arrange(&positions).iter().map(|p| p[0]).collect();
        assert_eq!(arranged, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let mut triangles = [[0, 3, 5], [2, 1, 6], [4, 7, 2]];
        numbering.sort_triangles(&mut triangles);
        assert_eq!(triangles, [[2, 1, 6], [4, 7, 2], [0, 3, 5]]);
        assert!((0..8).all(|v| numbering.vertices[numbering.place(v) as usize] == v));
    }
}
