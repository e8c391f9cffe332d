//! The order of vertices, and the order of simplices on the surface.

use super::Vertices;
use crate::History;
use crate::geometry::morton::Grid;
use crate::history::Levels;
use rayon::prelude::*;

/// Vertices by the level at which they die, latest first, neighbours on the surface together. Those
/// that no level sees are left out.
///
/// Memory: 8 bytes per vertex, 24 more while it is made; 4 more where vertices are born.
pub(super) struct VertexOrder {
    /// Vertex of the history at each place in the file.
    pub order: Vec<u32>,
    /// Place in the file of each vertex of the history; without a meaning for those left out.
    pub rank: Vec<u32>,
    /// Vertices that die after each level, a prefix of `order` that holds every vertex of the
    /// level.
    pub counts: Vec<u32>,
    /// Level at which the vertex at each place is born; empty where all are born at level 0.
    pub births: Vec<u32>,
}

impl VertexOrder {
    /// `history` passes its check and has the vertices of `mesh`.
    pub(super) fn new<const CORNERS: usize>(
        mesh: Vertices<'_>,
        history: &History<CORNERS>,
        levels: &Levels,
    ) -> Self {
        let grid = Grid::around(mesh.positions);
        let mut keys: Vec<(u32, u64, u32)> = (0u32..)
            .zip(mesh.positions)
            .zip(&history.vertex_death)
            .filter_map(|((vertex, &position), &death)| {
                let lifetime = levels.lifetime(history.vertex_birth(vertex), death)?;
                Some((u32::MAX - lifetime.death(), grid.morton(position), vertex))
            })
            .collect();
        keys.par_sort_unstable();
        let order: Vec<u32> = keys.iter().map(|&(_, _, vertex)| vertex).collect();
        let n_levels = levels.n_levels();
        let mut counts = Vec::with_capacity(n_levels as usize);
        for level in 0..n_levels {
            let n_alive = keys.partition_point(|&(key, _, _)| u32::MAX - key > level);
            counts.push(u32::try_from(n_alive).unwrap_or(u32::MAX));
        }
        drop(keys);
        let mut rank = vec![0; mesh.positions.len()];
        for (place, &vertex) in (0..).zip(&order) {
            rank[vertex as usize] = place;
        }
        let mut births: Vec<u32> = match history.vertex_birth.is_empty() {
            true => Vec::new(),
            false => order.iter().map(|&v| levels.at_or_after(history.vertex_birth(v))).collect(),
        };
        if births.iter().all(|&birth| birth == 0) {
            births.clear();
        }
        Self { order, rank, counts, births }
    }
}
