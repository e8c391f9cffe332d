//! The answer to a query.
//!
//! This file and `lod` name each other: a cut refers to the [`Lod`] that it is a level of, and a
//! `Lod` makes cuts.

use super::lod::from_file;
use super::used::UsedVertices;
use super::{Lod, QueryError};
use crate::tree::Runs;
use nephrite_formats::TriangleMesh;

/// The mesh at one level: a few runs of the index buffer and a prefix of the vertex buffer. It is
/// two words long and freely copied.
///
/// ```no_run
/// # let lod = nephrite::Lod::open("bunny.neph")?;
/// let cut = lod.at_count(10_000);
/// let mut indices = vec![0; cut.n_indices()];
/// cut.extract_into(&mut indices)?;
/// let positions = cut.vertices();
/// assert!(indices.iter().all(|&index| (index as usize) < positions.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Cut<'a> {
    lod: &'a Lod,
    level: u32,
}

impl<'a> Cut<'a> {
    /// `level` is below the number of levels.
    pub(super) fn new(lod: &'a Lod, level: u32) -> Self {
        Self { lod, level }
    }

    /// The file this is a cut of.
    pub fn lod(&self) -> &'a Lod {
        self.lod
    }

    /// Its level.
    pub fn level(&self) -> u32 {
        self.level
    }

    /// Error of the level, in mesh units. Infinite if no bound is stated, as for a level without
    /// triangles.
    pub fn error(&self) -> f64 {
        from_file(self.lod.errors()[self.level as usize])
    }

    /// The simplices of the level as contiguous ranges of slots, ascending and without overlap.
    /// There is at most one per height of the interval tree: `bit length of (n_levels - 1) + 1`.
    /// Cost: about three cache lines.
    pub fn runs(&self) -> Runs<'a> {
        self.lod.file().tree().stab(self.level)
    }

    /// Number of runs.
    pub fn n_runs(&self) -> usize {
        self.runs().count()
    }

    /// Simplices in all runs: triangles of a surface, tetrahedra of a volume.
    pub fn n_simplices(&self) -> usize {
        self.runs().map(|run| run.len as usize).sum()
    }

    /// Vertex indices in all runs: the number that [`extract_into`](Self::extract_into) writes.
    pub fn n_indices(&self) -> usize {
        self.n_simplices() * self.lod.n_corners() as usize
    }

    /// Length of the prefix of [`Lod::vertices`] that holds the vertices of the level. Every index
    /// of the level is below it. In a file with [births](Lod::vertex_births) the prefix also holds
    /// vertices that only coarser levels use.
    pub fn prefix_len(&self) -> usize {
        let stated = self.lod.file().vertex_counts()[self.level as usize] as usize;
        stated.min(self.lod.vertices().len())
    }

    /// Vertices of the level: those of the prefix that are born. Cost: O(1) in a file without
    /// births, otherwise one pass over the prefix.
    pub fn n_vertices(&self) -> usize {
        let births = self.lod.vertex_births();
        let prefix = births.get(..self.prefix_len()).unwrap_or(&[]);
        self.prefix_len() - prefix.iter().filter(|&&birth| birth > self.level).count()
    }

    /// Positions of the prefix that holds the level's vertices.
    pub fn vertices(&self) -> &'a [[f32; 3]] {
        &self.lod.vertices()[..self.prefix_len()]
    }

    /// The level as a mesh of its own, with attributes and without vertices that no triangle uses.
    /// Every index and every position is checked.
    ///
    /// # Errors
    ///
    /// [`QueryError::NotTriangles`] for a file of other simplices; [`QueryError::VertexIndex`] and
    /// [`QueryError::Position`] for a damaged file.
    pub fn to_mesh(&self) -> Result<TriangleMesh, QueryError> {
        if self.lod.n_corners() != 3 {
            return Err(QueryError::NotTriangles { found: self.lod.n_corners() });
        }
        let positions = self.vertices();
        if let Some(vertex) = positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
            return Err(QueryError::Position { vertex });
        }
        let mut triangles = vec![[0; 3]; self.n_simplices()];
        self.extract_into(triangles.as_flattened_mut())?;
        self.check_indices(triangles.as_flattened())?;
        let used = UsedVertices::compact(triangles.as_flattened_mut(), positions.len());
        Ok(TriangleMesh {
            origin: self.lod.origin(),
            positions: used.positions(positions),
            triangles,
            attributes: self.lod.attributes().map(|view| used.attribute(&view)).collect(),
            rounding: self.lod.rounding(),
        })
    }

    pub(super) fn check_indices(&self, indices: &[u32]) -> Result<(), QueryError> {
        let prefix_len = self.prefix_len();
        match indices.iter().find(|&&index| index as usize >= prefix_len) {
            Some(&found) => Err(QueryError::VertexIndex { found, vertex_count: prefix_len }),
            None => Ok(()),
        }
    }
}
