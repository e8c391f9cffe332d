//! Cells of any kind on their way to tetrahedra.

use super::coning::{HEXAHEDRON, PRISM, PYRAMID, VOXEL, cone};
use crate::FileReport;
use crate::error::{MeshError, Place};

/// What a cell is, whatever the format calls it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CellKind {
    /// Without a volume.
    Flat,
    Tetrahedron,
    Hexahedron,
    Voxel,
    Prism,
    Pyramid,
}

impl CellKind {
    /// Corners, which stand before all other nodes of a cell.
    pub(super) fn n_corners(self) -> usize {
        match self {
            Self::Flat => 0,
            Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Prism => 6,
            Self::Hexahedron | Self::Voxel => 8,
        }
    }
}

/// Tetrahedra gathered from cells.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    tetrahedra: Vec<[u32; 4]>,
}

impl Cells {
    /// Adds a cell by its nodes, corners first. Solids are cut, nodes behind the corners left out, flat cells counted.
    ///
    /// # Errors
    ///
    /// [`MeshError::IndexOutOfRange`] or [`MeshError::Missing`] at `place`.
    pub(super) fn push(
        &mut self,
        kind: CellKind,
        nodes: &[u32],
        n_points: usize,
        place: Place,
        report: &mut FileReport,
    ) -> Result<(), MeshError> {
        if kind == CellKind::Flat {
            report.n_cells_ignored += 1;
            return Ok(());
        }
        let corners = nodes.get(..kind.n_corners()).ok_or(MeshError::Missing { place, what: "corner" })?;
        if let Some(&index) = corners.iter().find(|&&index| index as usize >= n_points) {
            let (index, count) = (i64::from(index), n_points as u64);
            return Err(MeshError::IndexOutOfRange { place, what: "vertex", index, count });
        }
        report.n_cells_straightened += usize::from(nodes.len() > corners.len());
        report.n_solids_cut += usize::from(kind != CellKind::Tetrahedron);
        let tetrahedra = &mut self.tetrahedra;
        match kind {
            CellKind::Hexahedron => cone(&HEXAHEDRON, corners, |t| tetrahedra.push(t)),
            CellKind::Voxel => cone(&VOXEL, corners, |t| tetrahedra.push(t)),
            CellKind::Prism => cone(&PRISM, corners, |t| tetrahedra.push(t)),
            CellKind::Pyramid => cone(&PYRAMID, corners, |t| tetrahedra.push(t)),
            CellKind::Tetrahedron | CellKind::Flat => {
                tetrahedra.extend(corners.first_chunk::<4>());
            }
        }
        Ok(())
    }

    /// Adds the tetrahedra of later cells.
    pub(super) fn append(&mut self, mut later: Self) {
        self.tetrahedra.append(&mut later.tetrahedra);
    }

    /// The tetrahedra, in the order of their cells.
    pub(super) fn into_tetrahedra(self) -> Vec<[u32; 4]> {
        self.tetrahedra
    }
}
