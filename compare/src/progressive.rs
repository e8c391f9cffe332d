//! Progressive decimation as in its paper.

use crate::CompareError;
use nephrite::{Build, BuildOptions, ProgressiveBound, ProgressiveOptions, TriangleMesh, build};

/// Removes this part of the triangles, all of them for 1, under the paper's accumulated error.
///
/// # Errors
///
/// [`CompareError`] if the engine refuses the mesh.
pub fn decimate_progressively(
    mesh: &TriangleMesh,
    reduction: f64,
    pre_split: bool,
) -> Result<Build, CompareError> {
    let (bound, reduction) = (ProgressiveBound::Accumulated, Some(reduction));
    Ok(build(mesh, &BuildOptions::with(ProgressiveOptions { bound, reduction, pre_split }))?)
}
