//! PLOT3D: curvilinear grids of one or more blocks, and solutions on them in files of their own.
//!
//! The hexahedra of a grid of one block become five tetrahedra each, in two patterns that
//! alternate, so that those of neighbours fit. Blocks meet anywhere on their sides, where patterns
//! may not alternate; hexahedra of several blocks become six tetrahedra each, cut by the places of
//! their corners.
//!
//! Reference: P. Walatka, P. Buning, L. Pierce, P. Elson: "PLOT3D user's manual" (NASA TM 101067,
//! 1990), chapter 8.

mod binary;
mod text;

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::scalars::Numbers;
use crate::files::error::{MeshError, Place};
use crate::{FileReport, Kind, TetrahedronMesh, VolumeFormat};

/// Five tetrahedra of a hexahedron with VTK's order of vertices, for cells whose indices have an
/// even sum and an odd one.
const PATTERNS: [[[usize; 4]; 5]; 2] = [
    [[0, 1, 2, 5], [3, 0, 2, 7], [4, 0, 7, 5], [6, 2, 5, 7], [0, 2, 7, 5]],
    [[0, 1, 3, 4], [1, 2, 3, 6], [5, 1, 4, 6], [7, 3, 6, 4], [1, 3, 4, 6]],
];

/// What a file of this format holds for every point.
#[derive(Clone, Copy)]
struct Contents {
    /// Ways to write a point: how many numbers, and whether a mark tells that it is blanked.
    of_point: &'static [(usize, bool)],
    /// Numbers before those of a block's points.
    n_conditions: usize,
}

const GRID: Contents = Contents { of_point: &[(3, false), (3, true)], n_conditions: 0 };
const SOLUTION: Contents = Contents { of_point: &[(5, false)], n_conditions: 4 };

/// A block of a file.
struct Block {
    dimensions: [usize; 3],
    /// All first numbers of the points, then all second ones, and so on.
    numbers: Numbers,
    /// Whether each point is blanked.
    blanks: Option<Vec<bool>>,
}

impl Block {
    fn n_points(&self) -> usize {
        self.dimensions.iter().product()
    }

    /// Numbers `first` to `first + n` of each point.
    fn columns(&self, first: usize, n: usize) -> Vec<u8> {
        let (size, n_points) = (self.numbers.number.size_bytes(), self.n_points());
        let at = |point: usize, column: usize| {
            let start = (column * n_points + point) * size;
            self.numbers.bytes[start..start + size].iter().copied()
        };
        (0..n_points).flat_map(|p| (first..first + n).flat_map(move |column| at(p, column))).collect()
    }
}

/// The blocks of a file, text or binary.
fn blocks(bytes: &[u8], contents: Contents) -> Result<Vec<Block>, MeshError> {
    if text::is_text(bytes) { text::read(bytes, contents) } else { binary::read(bytes, contents) }
}

/// Reads a grid and any number of solutions on it: `density`, `momentum` and `energy`, of later
/// solutions under names with a number. Cells at blanked points are left out and counted.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(grid: &[u8], solutions: &[&[u8]]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut report = FileReport::new(VolumeFormat::Plot3d);
    let is_text = text::is_text(grid);
    let grid = blocks(grid, GRID)?;
    let points = Points::new(&joined(&grid, 0, 3)?, is_text);
    let n_points = points.len();
    let mut cells = Cells::default();
    let cut = if grid.len() == 1 { Cut::ByPatterns } else { Cut::ByPlaces };
    let mut first = 0;
    for block in &grid {
        add_cells(block, first, cut, &mut cells, &mut report)?;
        first += block.n_points();
    }
    let mut fields = Fields::default();
    for solution in solutions {
        let solution = blocks(solution, SOLUTION)?;
        let dimensions = |blocks: &[Block]| blocks.iter().map(|block| block.dimensions).collect::<Vec<_>>();
        if dimensions(&solution) != dimensions(&grid) {
            return Err(MeshError::Unexpected {
                place: Place::Part("solution"),
                expected: "the dimensions of the grid",
                found: crate::files::error::shortened(&format!("{:?}", dimensions(&solution))),
            });
        }
        for (name, first, n) in [("density", 0, 1), ("momentum", 1, 3), ("energy", 4, 1)] {
            let n_components = u32::try_from(n).unwrap_or(1);
            fields.push(name, n_components, joined(&solution, first, n)?, n_points, &mut report);
        }
    }
    finish(points, cells, fields, report)
}

/// Numbers `first` to `first + n` of the points of all blocks.
fn joined(blocks: &[Block], first: usize, n: usize) -> Result<Numbers, MeshError> {
    let number = blocks.first().map(|block| block.numbers.number);
    let number = number.ok_or(MeshError::Missing { place: Place::File, what: "block" })?;
    let bytes = blocks.iter().flat_map(|block| block.columns(first, n)).collect();
    Ok(Numbers { number, bytes })
}

/// How hexahedra become tetrahedra.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cut {
    /// In five, by the patterns that alternate.
    ByPatterns,
    /// In six, by the places of their corners.
    ByPlaces,
}

/// Adds the cells of a block whose points are numbered from `first` on.
fn add_cells(
    block: &Block,
    first: usize,
    cut: Cut,
    cells: &mut Cells,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let ([ni, nj, nk], n_points) = (block.dimensions, first + block.n_points());
    let at = |i: usize, j: usize, k: usize| (k * nj + j) * ni + i;
    for k in 1..nk {
        for j in 1..nj {
            for i in 1..ni {
                let corners = [
                    at(i - 1, j - 1, k - 1),
                    at(i, j - 1, k - 1),
                    at(i, j, k - 1),
                    at(i - 1, j, k - 1),
                    at(i - 1, j - 1, k),
                    at(i, j - 1, k),
                    at(i, j, k),
                    at(i - 1, j, k),
                ];
                if block.blanks.as_ref().is_some_and(|blanks| corners.iter().any(|&c| blanks[c])) {
                    report.count(Kind::BlankedCell, 1);
                    continue;
                }
                // A number beyond 32 bits is out of range of the points.
                let nodes = corners.map(|corner| u32::try_from(first + corner).unwrap_or(u32::MAX));
                if cut == Cut::ByPlaces {
                    cells.push(CellKind::Hexahedron, &nodes, n_points, Place::File, report)?;
                    continue;
                }
                report.n_solids_cut += 1;
                for tetrahedron in PATTERNS[(i + j + k + 1) % 2] {
                    let nodes = tetrahedron.map(|corner| nodes[corner]);
                    cells.push(CellKind::Tetrahedron, &nodes, n_points, Place::File, report)?;
                }
            }
        }
    }
    Ok(())
}

/// Dimensions of blocks that each have a cell, with no more points in all than `limit`.
fn are_blocks(dimensions: &[[usize; 3]], limit: usize) -> bool {
    let n_points = |block: &[usize; 3]| block.iter().fold(1_usize, |product, &n| product.saturating_mul(n));
    let total = dimensions.iter().map(n_points).fold(0_usize, usize::saturating_add);
    !dimensions.is_empty() && dimensions.iter().flatten().all(|&n| n >= 2) && total <= limit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::volume::cells::tests::n_outer_faces;

    /// Two blocks of unit cubes, of so many points along x, that share a side.
    fn two_blocks(first: usize, second: usize) -> String {
        let coordinates = |range: std::ops::Range<usize>, axis: usize| -> String {
            let mut text = String::new();
            for k in 0..3 {
                for j in 0..4 {
                    for i in range.clone() {
                        text.push_str(&format!("{}.0 ", [i, j, k][axis]));
                    }
                }
            }
            text + "\n"
        };
        let block = |range: std::ops::Range<usize>| {
            (0..3).map(|axis| coordinates(range.clone(), axis)).collect::<String>()
        };
        let blocks = [block(0..first), block(first - 1..first - 1 + second)];
        format!("2\n{first} 4 3\n{second} 4 3\n{}", blocks.concat())
    }

    #[test]
    fn blocks_fit_where_they_meet() {
        for first in [3, 4] {
            let (mesh, report) = read(two_blocks(first, 3).as_bytes(), &[]).unwrap();
            let n_cells = (first + 1) * 6;
            assert_eq!((mesh.tetrahedra.len(), report.n_solids_cut), (6 * n_cells, n_cells));
            assert!((mesh.volume() - (first as f64 + 1.0) * 6.0).abs() < 1e-9);
            let n_outer = 4 * 6 + 4 * (first + 1) * (3 + 2);
            assert_eq!(n_outer_faces(&mesh.positions, &mesh.tetrahedra), n_outer);
        }
    }

    #[test]
    fn solutions_of_several_blocks_are_read_in_text() {
        let grid = two_blocks(3, 2);
        let n_points = [3 * 12, 2 * 12];
        let mut solution = "2 3 4 3 2 4 3\n".to_owned();
        for (block, n) in n_points.into_iter().enumerate() {
            solution.push_str("0.5 0.0 1e3 2.0\n");
            // Fortran writes equal numbers as one.
            let columns = (0..5).map(|column| format!("{n}*{}.0 ", 10 * block + column));
            solution.push_str(&columns.collect::<String>());
        }
        let (mesh, _) = read(grid.as_bytes(), &[solution.as_bytes()]).unwrap();
        let density: Vec<f64> = mesh.attribute("density").unwrap().values().collect();
        assert_eq!(density, [vec![0.0; 36], vec![10.0; 24]].concat());
        let momentum: Vec<f64> = mesh.attribute("momentum").unwrap().values().collect();
        assert_eq!(
            (momentum.len(), &momentum[..3], &momentum[177..]),
            (180, &[1.0, 2.0, 3.0][..], &[11.0, 12.0, 13.0][..])
        );
        let other = solution.replacen("2 3 4 3", "2 4 3 3", 1);
        assert!(matches!(read(grid.as_bytes(), &[other.as_bytes()]), Err(MeshError::Unexpected { .. })));
    }

    #[test]
    fn blanked_points_take_their_cells_along() {
        let grid = "2 2 3\n0 1 0 1 0 1 0 1 0 1 0 1\n0 0 1 1 0 0 1 1 0 0 1 1\n0 0 0 0 1 1 1 1 2 2 2 2\n1 1 1 1 1 1 1 1 1 1 1 0\n";
        let (mesh, report) = read(grid.as_bytes(), &[]).unwrap();
        assert_eq!(
            (mesh.tetrahedra.len(), report.notes()),
            (5, vec!["1 blanked cell is left out".to_owned()])
        );
    }
}
