//! Numbers of VTK's cell types.

use crate::error::{MeshError, Place};
use crate::volume::cells::CellKind;

/// Number of a tetrahedron.
pub(in crate::volume) const TETRAHEDRON: u8 = 10;

/// What a cell type means for a volume.
///
/// # Errors
///
/// [`MeshError::Unsupported`] for solids whose faces no number tells: polyhedra and cells of any order.
pub(in crate::volume) fn kind_of(cell_type: i64, place: Place) -> Result<CellKind, MeshError> {
    Ok(match cell_type {
        10 | 24 => CellKind::Tetrahedron,
        11 => CellKind::Voxel,
        12 | 25 | 29 | 33 => CellKind::Hexahedron,
        13 | 26 | 31 | 32 => CellKind::Prism,
        14 | 27 | 37 => CellKind::Pyramid,
        // Points, lines, triangles, quadrilaterals and polygons of the first and second order.
        0..=9 | 21..=23 | 28 | 30 | 34..=36 => CellKind::Flat,
        _ => {
            return Err(MeshError::Unsupported { place, feature: format!("VTK cell type {cell_type}") });
        }
    })
}
