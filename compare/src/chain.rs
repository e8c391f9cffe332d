//! The chain of halvings with which an engine makes its levels of detail.

use crate::CompareError;
use meshopt::{SimplifyOptions, VertexDataAdapter, simplify, typed_to_bytes};
use nephrite::TriangleMesh;

/// Triangles at which the chain ends.
pub const CHAIN_END: usize = 64;

/// Triangles of each level when meshoptimizer halves a mesh, then the result, down to [`CHAIN_END`]
/// or until it gets no further; the input first.
///
/// # Errors
///
/// [`CompareError::Meshoptimizer`].
pub fn chain_of_halvings(mesh: &TriangleMesh) -> Result<Vec<usize>, CompareError> {
    let vertices = VertexDataAdapter::new(typed_to_bytes(&mesh.positions), size_of::<[f32; 3]>(), 0)?;
    let mut indices = mesh.triangles.as_flattened().to_vec();
    let mut counts = vec![mesh.triangles.len()];
    while indices.len() / 3 > CHAIN_END {
        let target = (indices.len() / 6).max(CHAIN_END) * 3;
        let halved = simplify(&indices, &vertices, target, f32::MAX, SimplifyOptions::None, None);
        if halved.len() == indices.len() {
            break;
        }
        indices = halved;
        counts.push(indices.len() / 3);
    }
    Ok(counts)
}
