//! The decimator as one function.

use super::complex::Complex;
use super::wedges::Wedges;
use super::{Decimation, ProgressiveBound, ProgressiveOptions, ProgressiveReport, Settings};
use crate::decimate::{Decimated, Input, Stopped, Watch, add_copies};
use crate::mesh::{Repaired, along_a_curve};
use nephrite_formats::TriangleMesh;

/// Decimates a mesh until the reduction asked for is reached or the error would be too large. The
/// bound is proven for as long as it can be if it is to be [certified](ProgressiveBound::Certified).
///
/// # Errors
///
/// [`Stopped`] when `watch` breaks.
pub(crate) fn run(
    input: Input<Repaired>,
    options: &ProgressiveOptions,
    watch: Watch<'_>,
) -> Result<Decimated<TriangleMesh, 3, ProgressiveReport>, Stopped> {
    let may_change = input.may_change();
    let Input { mesh, max_error, cos_feature_angle, lock_boundary } = input;
    let Repaired { mut mesh, points, looks, .. } = along_a_curve(mesh);
    let settings = Settings {
        cos_feature_angle,
        max_error: max_error.unwrap_or(f64::INFINITY),
        rounding: mesh.rounding,
        proves: options.bound == ProgressiveBound::Certified,
        options: *options,
    };
    let (triangles, wedges) = part_wedges(mesh.triangles.clone(), points, looks);
    let mut complex = Complex::new(mesh.positions.clone(), triangles);
    if lock_boundary {
        complex.lock_boundary();
    }
    let n_vertices = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
    let mut decimation = Decimation::new(complex, wedges, n_vertices, settings);
    let go_on = |decimation: &Decimation| {
        watch(decimation.complex.n_triangles(), decimation.journal.recorder.error()).is_continue()
    };
    // Inside the pool from the start: to enter it for each of the many short parallel parts would
    // cost more than they do.
    if may_change && !rayon::scope(|_| decimation.run(&go_on)) {
        return Err(Stopped::Interrupted);
    }
    let (history, report) = decimation.finish();
    add_copies(&mut mesh, report.trace.copies.iter().map(|&copied| (copied, None)));
    Ok(Decimated { mesh, history, report })
}

/// The points at the corners of `triangles`, and the wedges there if several share a point.
fn part_wedges(
    triangles: Vec<[u32; 3]>,
    points: Option<Vec<u32>>,
    looks: Option<Vec<u32>>,
) -> (Vec<[u32; 3]>, Option<Wedges>) {
    let Some((points, looks)) = points.zip(looks) else { return (triangles, None) };
    let over_points = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
    (over_points, Some(Wedges::new(triangles, looks)))
}
