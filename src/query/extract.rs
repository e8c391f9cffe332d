//! Copying a cut out at the speed of memory.

use super::{Cut, QueryError};
use crate::vertex_cache::{self, FanOrder};
use rayon::prelude::*;

/// Indices that one task copies: large against the cost of a task, small against a cache.
const TASK_LEN: usize = 1 << 16;

impl Cut<'_> {
    /// Copies the vertex indices of all simplices to the front of `indices` and returns their
    /// number, [`n_indices`](Self::n_indices). Cost: one `memcpy` per run.
    ///
    /// Indices are copied as the file has them. In a file that [`Lod::verify`](super::Lod::verify)
    /// accepts, each is below [`prefix_len`](Self::prefix_len); [`to_mesh`](Self::to_mesh)
    /// checks them.
    ///
    /// # Errors
    ///
    /// [`QueryError::BufferTooSmall`]; nothing is written then.
    pub fn extract_into(&self, indices: &mut [u32]) -> Result<usize, QueryError> {
        self.copy_runs(indices, |target, source| target.copy_from_slice(source))
    }

    /// [`extract_into`](Self::extract_into) on all threads of the current rayon pool. It pays above
    /// some 100,000 triangles.
    ///
    /// # Errors
    ///
    /// [`QueryError::BufferTooSmall`]; nothing is written then.
    pub fn par_extract_into(&self, indices: &mut [u32]) -> Result<usize, QueryError> {
        self.copy_runs(indices, |target, source| {
            let tasks = target.par_chunks_mut(TASK_LEN).zip(source.par_chunks(TASK_LEN));
            tasks.for_each(|(target, source)| target.copy_from_slice(source));
        })
    }

    /// [`extract_into`](Self::extract_into) in an order for the vertex cache of a graphics
    /// processor: some 0.7 misses per triangle, where a cut drawn as runs has 1.1 to 2. It is for
    /// callers who draw the copy often.
    ///
    /// It is slower than a plain copy by orders of magnitude, and allocates about 60 bytes per
    /// triangle while it runs.
    ///
    /// # Errors
    ///
    /// [`QueryError::BufferTooSmall`], [`QueryError::NotTriangles`], and for a damaged file
    /// [`QueryError::VertexIndex`].
    pub fn extract_ordered_into(&self, indices: &mut [u32]) -> Result<usize, QueryError> {
        if self.lod().n_corners() != 3 {
            return Err(QueryError::NotTriangles { found: self.lod().n_corners() });
        }
        let n_indices = self.extract_into(indices)?;
        let (triangles, _) = indices[..n_indices].as_chunks_mut::<3>();
        self.check_indices(triangles.as_flattened())?;
        // Valid indices have no order only if they exceed 2^32 corners; then any order will do.
        if let Some(order) = FanOrder::new(self.prefix_len()).order(triangles) {
            let in_runs = triangles.to_vec();
            for (triangle, place) in triangles.iter_mut().zip(order) {
                *triangle = in_runs[place as usize];
            }
        }
        Ok(n_indices)
    }

    /// Average cache miss ratio of the cut drawn as runs, with a first-in, first-out cache of
    /// `cache_len` vertices. 0 for simplices other than triangles. Cost: one pass over the
    /// triangles.
    pub fn miss_ratio(&self, cache_len: u32) -> f64 {
        if self.lod().n_corners() != 3 {
            return 0.0;
        }
        let prefix_len = self.prefix_len();
        let triangles = self.runs().flat_map(|run| self.lod().indices()[run.index_range(3)].as_chunks().0);
        let valid = triangles.filter(|triangle| triangle.iter().all(|&v| (v as usize) < prefix_len));
        vertex_cache::miss_ratio(valid.copied(), cache_len)
    }

    fn copy_runs(&self, indices: &mut [u32], copy: impl Fn(&mut [u32], &[u32])) -> Result<usize, QueryError> {
        let n_indices = self.n_indices();
        let found = indices.len();
        let too_small = QueryError::BufferTooSmall { found, expected: n_indices };
        let mut rest = indices.get_mut(..n_indices).ok_or(too_small)?;
        let n_corners = self.lod().n_corners() as usize;
        let buffer = self.lod().indices();
        for run in self.runs() {
            // Runs are clamped to the slots, and the buffer has `n_corners` indices per slot.
            let source = &buffer[run.index_range(n_corners)];
            let (target, behind) = rest.split_at_mut(source.len());
            copy(target, source);
            rest = behind;
        }
        Ok(n_indices)
    }
}
