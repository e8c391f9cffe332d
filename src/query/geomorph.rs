//! Geomorphs: where vertices that leave move to, so that a level turns smoothly into a coarser one.

use super::patches::Patches;
use super::{Lod, QueryError};
use crate::geometry::distance::{Triangle, closest_weights, point_triangle_distance_sq};
use crate::geometry::vector::widen;
use std::collections::HashMap;
use std::ops::Range;

/// Where a vertex that a coarser level no longer has comes to lie on that level.
///
/// When all such vertices have moved from their positions to their landings, the finer level has
/// the shape of the coarser one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// A triangle of the coarser level.
    pub triangle: [u32; 3],
    /// Barycentric coordinates on it: none negative, with sum 1.
    pub weights: [f32; 3],
}

impl Lod {
    /// Where each vertex that level `fine` has and level `coarse` does not comes to lie on level
    /// `coarse`. The vertices are those from `at_level(coarse).prefix_len()` up to
    /// `at_level(fine).prefix_len()`, in their order. `None` for vertices that are born between
    /// the two levels, and if triangles vanished without replacement. The list is empty if `coarse`
    /// is not coarser than `fine`; a level that does not exist is the coarsest one.
    ///
    /// The nearest triangle of the coarser level may be on another sheet of the surface. A vertex
    /// therefore lands on the nearest of the triangles that replaced those around it, as the
    /// lifetimes tell. When that triangle is replaced in turn, the vertex lands on the nearest of
    /// its replacements, level by level.
    ///
    /// Cost: linear in the triangles that change between the levels, times their number in a patch,
    /// usually a few dozen. Memory: for the vertices, and for the largest change between
    /// neighbouring levels.
    ///
    /// # Errors
    ///
    /// [`QueryError::NotTriangles`], and for a damaged file [`QueryError::VertexIndex`].
    pub fn geomorph(&self, fine: u32, coarse: u32) -> Result<Vec<Option<Landing>>, QueryError> {
        if self.n_corners() != 3 {
            return Err(QueryError::NotTriangles { found: self.n_corners() });
        }
        let (fine, coarse) = (self.at_level(fine), self.at_level(coarse));
        let mut flights = Flights {
            lod: self,
            first_vertex: coarse.prefix_len(),
            landings: vec![None; fine.prefix_len().saturating_sub(coarse.prefix_len())],
            landed_on: HashMap::new(),
        };
        for level in fine.level()..coarse.level() {
            flights.pass(level)?;
        }
        let Flights { first_vertex, mut landings, .. } = flights;
        let births = self.vertex_births().get(first_vertex..).unwrap_or(&[]);
        for (landing, _) in landings.iter_mut().zip(births).filter(|(_, birth)| **birth > fine.level()) {
            *landing = None;
        }
        Ok(landings)
    }
}

/// Vertices on their way from level to level.
struct Flights<'a> {
    lod: &'a Lod,
    /// The vertex of the first landing.
    first_vertex: usize,
    landings: Vec<Option<Landing>>,
    /// Vertices that have landed on a triangle of the level reached so far.
    landed_on: HashMap<[u32; 3], Vec<usize>>,
}

impl Flights<'_> {
    /// Moves the vertices on to the level after `level`.
    fn pass(&mut self, level: u32) -> Result<(), QueryError> {
        let [before, after] = [level, level + 1].map(|level| self.lod.at_level(level).prefix_len());
        let patches = Patches::between(self.lod, level);
        let (leaving, entering) = patches.triangles.split_at(patches.n_leaving);
        check_indices(leaving, before)?;
        check_indices(entering, after)?;

        // Counts fall from level to level unless the file is damaged.
        let end = before.min(self.first_vertex + self.landings.len());
        let taking_off = self.taking_off(leaving, after.max(self.first_vertex)..end);
        for (vertex, triangle) in taking_off {
            let position = widen(self.lod.vertices()[vertex]);
            let corners =
                |&id: &u32| patches.triangles[id as usize].map(|v| widen(self.lod.vertices()[v as usize]));
            let distance_sq = |id: &&u32| point_triangle_distance_sq(position, &corners(id));
            let nearest = patches
                .replacements(triangle)
                .iter()
                .min_by(|a, b| distance_sq(a).total_cmp(&distance_sq(b)));
            self.landings[vertex - self.first_vertex] = nearest.map(|id| {
                let triangle = patches.triangles[*id as usize];
                self.landed_on.entry(triangle).or_default().push(vertex);
                Landing { triangle, weights: weights(position, &corners(id)) }
            });
        }
        Ok(())
    }

    /// Vertices that need a new triangle, each with a leaving triangle at its place: vertices that
    /// had landed on a leaving triangle, and vertices that leave now.
    fn taking_off(&mut self, leaving: &[[u32; 3]], vanishing: Range<usize>) -> Vec<(usize, usize)> {
        let mut taking_off = Vec::new();
        let mut is_known = vec![false; vanishing.len()];
        for (id, triangle) in leaving.iter().enumerate() {
            let landed = self.landed_on.remove(triangle).unwrap_or_default();
            taking_off.extend(landed.into_iter().map(|vertex| (vertex, id)));
            for vertex in triangle.map(|vertex| vertex as usize) {
                if vanishing.contains(&vertex)
                    && !std::mem::replace(&mut is_known[vertex - vanishing.start], true)
                {
                    taking_off.push((vertex, id));
                }
            }
        }
        taking_off
    }
}

#[expect(clippy::cast_possible_truncation, reason = "coordinates between 0 and 1, rounded")]
fn weights(position: [f64; 3], corners: &Triangle) -> [f32; 3] {
    closest_weights(position, corners).map(|weight| weight as f32)
}

fn check_indices(triangles: &[[u32; 3]], vertex_count: usize) -> Result<(), QueryError> {
    match triangles.as_flattened().iter().find(|&&vertex| vertex as usize >= vertex_count) {
        Some(&found) => Err(QueryError::VertexIndex { found, vertex_count }),
        None => Ok(()),
    }
}
