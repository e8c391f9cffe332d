//! Types of elements by their numbers.
//!
//! Reference: Gmsh reference manual, "MSH file format", and the list of types in its source.

use crate::files::error::{MeshError, Place};
use crate::files::volume::cells::CellKind;

/// What a number of Gmsh means for a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementType {
    pub kind: CellKind,
    /// Dimensions of the element: 0 for points, 3 for solids.
    pub n_dimensions: u8,
    /// Nodes of an element, those on its edges, faces and inside counted.
    pub n_nodes: usize,
}

/// The number of a type, and the number of nodes of its elements.
type Nodes = (i64, usize);

const POINTS: &[Nodes] = &[(15, 1)];
const LINES: &[Nodes] =
    &[(1, 2), (8, 3), (26, 4), (27, 5), (28, 6), (62, 7), (63, 8), (64, 9), (65, 10), (66, 11), (84, 1)];
const TRIANGLES: &[Nodes] = &[
    (2, 3),
    (9, 6),
    (20, 9),
    (21, 10),
    (22, 12),
    (23, 15),
    (24, 15),
    (25, 21),
    (42, 28),
    (43, 36),
    (44, 45),
    (45, 55),
    (46, 66),
    (52, 18),
    (53, 21),
    (54, 24),
    (55, 27),
    (56, 30),
    (85, 1),
];
const QUADRILATERALS: &[Nodes] = &[
    (3, 4),
    (10, 9),
    (16, 8),
    (36, 16),
    (37, 25),
    (38, 36),
    (39, 12),
    (40, 16),
    (41, 20),
    (47, 49),
    (48, 64),
    (49, 81),
    (50, 100),
    (51, 121),
    (57, 24),
    (58, 28),
    (59, 32),
    (60, 36),
    (61, 40),
    (86, 1),
];
const TETRAHEDRA: &[Nodes] = &[
    (4, 4),
    (11, 10),
    (29, 20),
    (30, 35),
    (31, 56),
    (32, 22),
    (33, 28),
    (71, 84),
    (72, 120),
    (73, 165),
    (74, 220),
    (75, 286),
    (79, 34),
    (80, 40),
    (81, 46),
    (82, 52),
    (83, 58),
    (137, 16),
];
const HEXAHEDRA: &[Nodes] = &[
    (5, 8),
    (12, 27),
    (17, 20),
    (92, 64),
    (93, 125),
    (94, 216),
    (95, 343),
    (96, 512),
    (97, 729),
    (98, 1000),
    (99, 32),
    (100, 44),
    (101, 56),
    (102, 68),
    (103, 80),
    (104, 92),
    (105, 104),
];
const PRISMS: &[Nodes] = &[
    (6, 6),
    (13, 18),
    (18, 15),
    (90, 40),
    (91, 75),
    (106, 126),
    (107, 196),
    (108, 288),
    (109, 405),
    (110, 550),
    (111, 24),
    (112, 33),
    (113, 42),
    (114, 51),
    (115, 60),
    (116, 69),
    (117, 78),
];
const PYRAMIDS: &[Nodes] = &[
    (7, 5),
    (14, 14),
    (19, 13),
    (118, 30),
    (119, 55),
    (120, 91),
    (121, 140),
    (122, 204),
    (123, 285),
    (124, 385),
    (125, 21),
    (126, 29),
    (127, 37),
    (128, 45),
    (129, 53),
    (130, 61),
    (131, 69),
];

/// All types with nodes of a fixed number, by dimension and kind.
const ALL: [(u8, CellKind, &[Nodes]); 8] = [
    (3, CellKind::Tetrahedron, TETRAHEDRA),
    (3, CellKind::Hexahedron, HEXAHEDRA),
    (3, CellKind::Prism, PRISMS),
    (3, CellKind::Pyramid, PYRAMIDS),
    (2, CellKind::Flat, TRIANGLES),
    (2, CellKind::Flat, QUADRILATERALS),
    (1, CellKind::Flat, LINES),
    (0, CellKind::Flat, POINTS),
];

impl ElementType {
    /// The type of a number.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unsupported`] at `place`, also for polygons and polyhedra.
    pub(super) fn new(number: i64, place: Place) -> Result<Self, MeshError> {
        let found = ALL.iter().find_map(|&(n_dimensions, kind, types)| {
            let &(_, n_nodes) = types.iter().find(|&&(known, _)| known == number)?;
            Some(Self { kind, n_dimensions, n_nodes })
        });
        found.ok_or_else(|| MeshError::Unsupported { place, feature: format!("Gmsh element type {number}") })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complete_elements_have_as_many_nodes_as_their_order_gives() {
        let n_nodes = |number| ElementType::new(number, Place::File).unwrap().n_nodes;
        // Types of the orders 1 to 9.
        let [tetrahedra, hexahedra, prisms, pyramids] = [
            [4, 11, 29, 30, 31, 71, 72, 73, 74],
            [5, 12, 92, 93, 94, 95, 96, 97, 98],
            [6, 13, 90, 91, 106, 107, 108, 109, 110],
            [7, 14, 118, 119, 120, 121, 122, 123, 124],
        ];
        for (order, place) in (1..=9).zip(0..) {
            let n = order + 1;
            assert_eq!(n_nodes(tetrahedra[place]), n * (n + 1) * (n + 2) / 6, "{order}");
            assert_eq!(n_nodes(hexahedra[place]), n * n * n, "{order}");
            assert_eq!(n_nodes(prisms[place]), n * n * (n + 1) / 2, "{order}");
            assert_eq!(n_nodes(pyramids[place]), n * (n + 1) * (2 * n + 1) / 6, "{order}");
        }
        let squares = [3, 10, 36, 37, 38, 47, 48, 49, 50, 51];
        let triangles = [2, 9, 21, 23, 25, 42, 43, 44, 45, 46];
        for (order, place) in (1..=10).zip(0..) {
            assert_eq!(n_nodes(squares[place]), (order + 1) * (order + 1), "{order}");
            assert_eq!(n_nodes(triangles[place]), (order + 1) * (order + 2) / 2, "{order}");
        }
    }

    #[test]
    fn no_number_has_two_types() {
        let mut numbers: Vec<i64> =
            ALL.iter().flat_map(|(.., types)| types.iter().map(|&(n, _)| n)).collect();
        let n = numbers.len();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!(numbers.len(), n);
        for polygon_or_unknown in [0, -4, 34, 35, 133, 141, 999] {
            assert!(ElementType::new(polygon_or_unknown, Place::File).is_err());
        }
    }
}
