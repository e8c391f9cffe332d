//! Types of elements by their numbers.

use crate::error::{MeshError, Place};
use crate::volume::cells::CellKind;

/// What a number of Gmsh means for a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementType {
    pub kind: CellKind,
    /// Nodes of an element, those on its edges, faces and inside counted.
    pub n_nodes: usize,
}

impl ElementType {
    /// Nodes of the types from 1 on.
    const NODES: [usize; 31] = [
        2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20,
        35, 56,
    ];

    /// The type of a number.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unsupported`] at `place`.
    pub(super) fn new(number: i64, place: Place) -> Result<Self, MeshError> {
        let index = usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
        let n_nodes = index.and_then(|index| Self::NODES.get(index)).copied();
        let unsupported = || MeshError::Unsupported { place, feature: format!("Gmsh element type {number}") };
        let kind = match number {
            4 | 11 | 29 | 30 | 31 => CellKind::Tetrahedron,
            5 | 12 | 17 => CellKind::Hexahedron,
            6 | 13 | 18 => CellKind::Prism,
            7 | 14 | 19 => CellKind::Pyramid,
            _ => CellKind::Flat,
        };
        n_nodes.map(|n_nodes| Self { kind, n_nodes }).ok_or_else(unsupported)
    }
}
