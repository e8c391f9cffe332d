//! A built-in surface, for use without a file.

use crate::RenderError;
use glam::Vec3;
use nephrite::{BuildOptions, Lod, StoreOptions, StoreReport, TriangleMesh, WriteError, generate};
use std::io::Cursor;

/// Builds all levels of a mesh in memory.
///
/// # Errors
///
/// [`RenderError::Build`], [`RenderError::Store`], [`RenderError::Open`].
pub fn lod_of(mesh: &TriangleMesh) -> Result<Lod, RenderError> {
    let build = nephrite::build(mesh, &BuildOptions::default())?;
    stored(|file, options| build.write_to(file, options))
}

/// The levels in a file that is written to memory.
pub(crate) fn stored(
    write: impl FnOnce(&mut Cursor<Vec<u8>>, &StoreOptions) -> Result<StoreReport, WriteError>,
) -> Result<Lod, RenderError> {
    let mut file = Cursor::new(Vec::new());
    write(&mut file, &StoreOptions::default())?;
    Lod::from_owner(file.into_inner())
        .map_err(|source| RenderError::Open { path: "built-in surface".into(), source })
}

/// A rope of four strands tied into a trefoil knot, of about `n_triangles`.
pub fn knot(n_triangles: u32) -> TriangleMesh {
    // The rope is some twelve times as long as it is thick around.
    let sides = (n_triangles / 24).isqrt().clamp(3, 1000);
    let mut mesh = generate::torus(12 * sides, sides);
    for position in &mut mesh.positions {
        *position = tied(*position);
    }
    mesh
}

/// Maps a point of the generated torus, whose tube is around the unit circle, to the knot.
///
/// The knot lies on a torus of radii 2 and 1, and the normal of that torus is at right angles to
/// it. Together with the tangent, it spans a frame that closes after one turn.
fn tied([x, y, z]: [f32; 3]) -> [f32; 3] {
    let around = y.atan2(x);
    let (tube_x, tube_y) = (x.hypot(y) - 1.0, z);
    let strand = 1.0 + 0.14 * (4.0 * tube_y.atan2(tube_x) + 25.0 * around).cos();
    let ((sin_2, cos_2), (sin_3, cos_3)) = ((2.0 * around).sin_cos(), (3.0 * around).sin_cos());
    let ring = 2.0 + cos_3;
    let on_knot = Vec3::new(ring * cos_2, ring * sin_2, sin_3);
    let normal = Vec3::new(cos_3 * cos_2, cos_3 * sin_2, sin_3);
    let along_ring = 2.0 * ring * Vec3::new(-sin_2, cos_2, 0.0);
    let along_tube = 3.0 * Vec3::new(-sin_3 * cos_2, -sin_3 * sin_2, cos_3);
    let tangent = (along_ring + along_tube).normalize();
    // In this order the outside stays outside.
    (on_knot + 1.5 * strand * (tube_x * normal + tube_y * normal.cross(tangent))).to_array()
}
