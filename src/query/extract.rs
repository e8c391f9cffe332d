//! Copying a cut out at the speed of memory.

use super::{Cut, QueryError};
use rayon::prelude::*;

/// Indices that one task copies: large against the cost of a task, small against a cache.
const TASK_LEN: usize = 1 << 16;

impl Cut<'_> {
    /// Copies the vertex indices of all triangles to the front of `indices` and gives their number,
    /// [`n_indices`](Self::n_indices). One `memcpy` per run, nothing per triangle.
    ///
    /// Indices are handed on as the file has them: each is below [`vertex_count`](Self::vertex_count) in a file that
    /// [`Lod::verify`](super::Lod::verify) accepts. [`to_mesh`](Self::to_mesh) checks them.
    ///
    /// # Errors
    ///
    /// [`QueryError::BufferTooSmall`]; nothing is written then.
    pub fn extract_into(&self, indices: &mut [u32]) -> Result<usize, QueryError> {
        self.copy_runs(indices, |target, source| target.copy_from_slice(source))
    }

    /// [`extract_into`](Self::extract_into) on all threads of the current rayon pool; worth it beyond some 100,000 triangles.
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
