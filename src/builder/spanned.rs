//! What a bounding box is taken of.

use crate::geometry::bounds::Bounds;
use crate::geometry::vector::widen;
use crate::store::Vertices;
use nephrite_formats::{TetrahedronMesh, TriangleMesh};

/// Positions, and the simplices that use them.
#[derive(Clone, Copy, Debug)]
pub struct Spanned<'a> {
    positions: &'a [[f32; 3]],
    /// Corners of all simplices, and how many each has; `None` if all positions count.
    corners: Option<(&'a [u32], usize)>,
}

impl<'a> From<&'a TriangleMesh> for Spanned<'a> {
    fn from(mesh: &'a TriangleMesh) -> Self {
        Self { positions: &mesh.positions, corners: Some((mesh.triangles.as_flattened(), 3)) }
    }
}

impl<'a> From<&'a TetrahedronMesh> for Spanned<'a> {
    fn from(mesh: &'a TetrahedronMesh) -> Self {
        Self { positions: &mesh.positions, corners: Some((mesh.tetrahedra.as_flattened(), 4)) }
    }
}

impl<'a> From<Vertices<'a>> for Spanned<'a> {
    fn from(vertices: Vertices<'a>) -> Self {
        Self { positions: vertices.positions, corners: None }
    }
}

/// Length of the diagonal of the bounding box of a mesh, in mesh units: what percentages of error
/// refer to.
///
/// The box holds the simplices whose corners are all in different places. They have the vertices
/// that a file has, so that [`Lod::bounding_diagonal`](crate::Lod::bounding_diagonal) of a file
/// built from a surface is the same length. 0 without such simplices.
///
/// ```
/// let mesh = nephrite::generate::box_volume([2; 3]);
/// assert_eq!(nephrite::bounding_diagonal(&mesh), 3_f64.sqrt());
/// ```
pub fn bounding_diagonal<'a>(mesh: impl Into<Spanned<'a>>) -> f64 {
    let Spanned { positions, corners } = mesh.into();
    let Some((corners, n_corners)) = corners else {
        return Bounds::around_positions(positions).diagonal();
    };
    let places = |simplex: &[u32]| -> Option<Vec<[f32; 3]>> {
        let places: Vec<[f32; 3]> =
            simplex.iter().map(|&v| positions.get(v as usize).copied()).collect::<Option<_>>()?;
        let is_twice = (1..places.len()).any(|i| places[..i].contains(&places[i]));
        (!is_twice).then_some(places)
    };
    let used = corners.chunks_exact(n_corners).filter_map(places).flatten();
    Bounds::around(used.map(widen)).diagonal()
}
