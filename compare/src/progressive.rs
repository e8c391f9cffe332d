//! Progressive decimation as in its paper.

use crate::CompareError;
use nephrite::{Bound, Build, BuildOptions, Method, TriangleMesh, build};
use std::ops::ControlFlow;

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
    let mut options =
        BuildOptions { method: Method::Progressive, bound: Bound::Accumulated, ..BuildOptions::default() };
    options.progressive.reduction = Some(reduction);
    options.progressive.pre_split = pre_split;
    Ok(build(mesh, &options, &|_| ControlFlow::Continue(()))?)
}
