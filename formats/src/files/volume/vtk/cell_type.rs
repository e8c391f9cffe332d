//! Numbers of VTK's cell types.

use crate::files::error::{MeshError, Place};
use crate::files::volume::cells::CellKind;

/// Number of a tetrahedron.
pub(in crate::files::volume) const TETRAHEDRON: u8 = 10;

/// What a cell type means for a volume. Of Lagrange cells (68 to 74) and Bézier cells (75 to 81)
/// the corners stand before all other nodes, as in the cells of the second order.
///
/// # Errors
///
/// [`MeshError::Unsupported`] for solids whose faces no number tells, such as polyhedra.
pub(in crate::files::volume) fn kind_of(cell_type: i64, place: Place) -> Result<CellKind, MeshError> {
    Ok(match cell_type {
        10 | 24 | 71 | 78 => CellKind::Tetrahedron,
        11 => CellKind::Voxel,
        12 | 25 | 29 | 33 | 72 | 79 => CellKind::Hexahedron,
        13 | 26 | 31 | 32 | 73 | 80 => CellKind::Prism,
        14 | 27 | 37 | 74 | 81 => CellKind::Pyramid,
        // Points, lines, triangles, quadrilaterals and polygons of any order.
        0..=9 | 21..=23 | 28 | 30 | 34..=36 | 68..=70 | 75..=77 => CellKind::Flat,
        _ => {
            return Err(MeshError::Unsupported { place, feature: format!("VTK cell type {cell_type}") });
        }
    })
}
