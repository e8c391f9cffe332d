//! Whether the operations of a file build its level 0 up.

use super::{Opened, VerifyError};
use crate::flat::canonical;
use crate::progressive_mesh::ProgressiveMesh;
use rayon::prelude::*;

/// Corners of a triangle by the bits of their positions, the least first.
type CornerBits = [[u32; 3]; 3];

impl Opened {
    /// Reads the whole stream and plays it to its end: then it has the triangles of level 0, by the
    /// positions of their corners and their orientation. O(n log n) in the triangles of level 0.
    pub(super) fn check_operations(&self) -> Result<(), VerifyError> {
        if self.operations().is_empty() {
            return Ok(());
        }
        let mut mesh = ProgressiveMesh::from_bytes(self.operations())?;
        if !mesh.is_whole() {
            let (found, expected) = (mesh.n_operations() as u64, mesh.n_announced());
            return Err(VerifyError::OperationCount { found, expected });
        }
        mesh.refine(usize::MAX);
        let built = shapes(mesh.positions(), mesh.triangles().iter().copied());
        let n_corners = self.header().n_corners as usize;
        let slots = self.tree().stab(0).flat_map(|run| run.start..run.start.saturating_add(run.len));
        let level = slots.filter_map(|slot| {
            let start = slot as usize * n_corners;
            let corners = self.simplices().get(start..start + n_corners)?;
            corners.first_chunk().filter(|_| n_corners == 3).copied()
        });
        let stored = shapes(self.positions(), level);
        if built == stored {
            return Ok(());
        }
        let expected = built.len().max(stored.len()) as u64;
        Err(VerifyError::OperationsMesh { found: n_common(&built, &stored), expected })
    }
}

/// The triangles in an order of their own. Zeros have no sign: repair makes one point of both.
fn shapes(positions: &[[f32; 3]], triangles: impl Iterator<Item = [u32; 3]>) -> Vec<CornerBits> {
    let corner =
        |v: u32| positions.get(v as usize).map_or([u32::MAX; 3], |at| at.map(|x| (x + 0.0).to_bits()));
    let mut shapes: Vec<CornerBits> = triangles.map(|triangle| canonical(triangle.map(corner))).collect();
    shapes.par_sort_unstable();
    shapes
}

/// How many entries two sorted lists have in common.
fn n_common(a: &[CornerBits], b: &[CornerBits]) -> u64 {
    let (mut i, mut j, mut n) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => (i, j, n) = (i + 1, j + 1, n + 1),
        }
    }
    n
}
