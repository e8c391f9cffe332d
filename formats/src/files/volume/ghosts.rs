//! Ghost cells of VTK: copies of the cells of other pieces, and cells that are covered or hidden.
//!
//! Reference: Kitware, `vtkDataSetAttributes` (VTK documentation, "Ghost types").

use super::scalars::Numbers;
use crate::{FileReport, Kind};

/// Bits of `vtkGhostType` at cells: a copy of another piece's cell, a cell covered by finer ones, a
/// hidden one.
const LEFT_OUT: i64 = 1 | 8 | 32;

/// The array of ghosts in use today, of bits, and its predecessor, of levels from 0 on.
const TYPE: &str = "vtkGhostType";
const LEVELS: &str = "vtkGhostLevels";

/// Which cells of a file are ghosts.
#[derive(Default)]
pub(super) struct Ghosts {
    /// Empty if the file says nothing.
    is_ghost: Vec<bool>,
}

/// Whether an array of this name tells ghosts from others and is no field.
pub(super) fn tells_ghosts(name: &str) -> bool {
    matches!(name, TYPE | LEVELS)
}

impl Ghosts {
    /// Takes what an array of cells says, which [`tells_ghosts`].
    pub(super) fn read(&mut self, name: &str, numbers: &Numbers) {
        let is_ghost = |value: Option<i64>| {
            value.is_some_and(|value| if name == TYPE { value & LEFT_OUT != 0 } else { value > 0 })
        };
        self.is_ghost = numbers.to_integers().map(is_ghost).collect();
    }

    /// Whether a cell is a ghost, which is counted.
    pub(super) fn leaves_out(&self, cell: usize, report: &mut FileReport) -> bool {
        let is_ghost = self.is_ghost.get(cell).copied().unwrap_or(false);
        report.count(Kind::GhostCell, is_ghost.into());
        is_ghost
    }
}
