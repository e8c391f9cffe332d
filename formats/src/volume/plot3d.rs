//! PLOT3D: curvilinear grids, and solutions on them in files of their own.
//!
//! Nothing in such a file says in which byte order, precision and framing it is written; its length decides, which differs for every
//! combination that its first numbers allow. Hexahedra become five tetrahedra each, in two patterns that alternate, so that
//! those of neighbours fit.
//!
//! Reference: P. Walatka, P. Buning, L. Pierce, P. Elson: "PLOT3D user's manual" (NASA TM 101067, 1990), chapter 8.

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::scalars::{NumberType, Numbers};
use crate::error::{MeshError, Place};
use crate::{FileReport, TetrahedronMesh, VolumeFormat};

/// Five tetrahedra of a hexahedron with VTK's order of vertices, for cells whose indices have an even sum and an odd one.
const PATTERNS: [[[usize; 4]; 5]; 2] = [
    [[0, 1, 2, 5], [3, 0, 2, 7], [4, 0, 7, 5], [6, 2, 5, 7], [0, 2, 7, 5]],
    [[0, 1, 3, 4], [1, 2, 3, 6], [5, 1, 4, 6], [7, 3, 6, 4], [1, 3, 4, 6]],
];

/// Reads a grid of one block and any number of solutions on it: `density`, `momentum` and `energy`, of later solutions under
/// names with a number. Cells at blanked points are left out and counted.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(grid: &[u8], solutions: &[&[u8]]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut report = FileReport::new(VolumeFormat::Plot3d);
    let layout = Layout::find(grid, &[(3, false), (3, true)], 0)?;
    let n_points = layout.n_points();
    let coordinates = layout.numbers(grid, 0, 3 * n_points);
    let columns: Vec<f64> = coordinates.to_f64().collect();
    let point = |i: usize| [columns[i], columns[n_points + i], columns[2 * n_points + i]];
    let points = match layout.number {
        #[expect(clippy::cast_possible_truncation, reason = "they were f32")]
        NumberType::F32 => Points::F32((0..n_points).map(|i| point(i).map(|x| x as f32)).collect()),
        _ => Points::F64((0..n_points).map(point).collect()),
    };
    let blanks = layout.has_blanks.then(|| layout.blanks(grid, 3 * n_points));
    let cells = cells(layout.dimensions, blanks.as_deref(), &mut report)?;
    let mut fields = Fields::default();
    for solution in solutions {
        let layout_q = Layout::find(solution, &[(5, false)], 4)?;
        if layout_q.dimensions != layout.dimensions {
            return Err(MeshError::Unexpected {
                place: Place::Part("solution"),
                expected: "the dimensions of the grid",
                found: format!("{:?}", layout_q.dimensions),
            });
        }
        let column = |first: usize, n: usize| {
            let numbers = layout_q.numbers(solution, first * n_points, n * n_points);
            let size = numbers.number.size_bytes();
            let at = |point: usize, component: usize| {
                let start = (component * n_points + point) * size;
                numbers.bytes[start..start + size].iter().copied()
            };
            let bytes = (0..n_points).flat_map(|p| (0..n).flat_map(move |c| at(p, c))).collect();
            Numbers { number: numbers.number, bytes }
        };
        for (name, first, n) in [("density", 0, 1), ("momentum", 1, 3), ("energy", 4, 1)] {
            fields.push(name, u32::try_from(n).unwrap_or(1), column(first, n), n_points, &mut report);
        }
    }
    finish(points, cells, fields, report)
}

fn cells(
    [ni, nj, nk]: [usize; 3],
    blanks: Option<&[bool]>,
    report: &mut FileReport,
) -> Result<Cells, MeshError> {
    let mut cells = Cells::default();
    let n_points = ni * nj * nk;
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
                if blanks.is_some_and(|blanks| corners.iter().any(|&corner| blanks[corner])) {
                    report.n_cells_ignored += 1;
                    continue;
                }
                report.n_solids_cut += 1;
                for tetrahedron in PATTERNS[(i + j + k + 1) % 2] {
                    // The layout was refused if the points exceeded 32 bits.
                    let nodes = tetrahedron.map(|corner| u32::try_from(corners[corner]).unwrap_or(u32::MAX));
                    cells.push(CellKind::Tetrahedron, &nodes, n_points, Place::File, report)?;
                }
            }
        }
    }
    Ok(cells)
}

/// How a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    dimensions: [usize; 3],
    is_big_endian: bool,
    number: NumberType,
    /// Lengths of four bytes before and after each record, as Fortran writes them.
    has_records: bool,
    /// A number of blocks before the dimensions.
    has_count: bool,
    has_blanks: bool,
    /// Numbers before the values: those of a solution's conditions.
    n_conditions: usize,
}

impl Layout {
    /// The layout whose length is the file's, among all with so many values per point, with or without blanks.
    fn find(bytes: &[u8], values: &[(usize, bool)], n_conditions: usize) -> Result<Self, MeshError> {
        for is_big_endian in [true, false] {
            for (has_records, has_count) in [(false, false), (false, true), (true, false), (true, true)] {
                for number in [NumberType::F32, NumberType::Kept(crate::ScalarType::F64)] {
                    for &(n_values, has_blanks) in values {
                        let dimensions = [0; 3];
                        let mut layout = Self {
                            dimensions,
                            is_big_endian,
                            number,
                            has_records,
                            has_count,
                            has_blanks,
                            n_conditions,
                        };
                        if layout.read_dimensions(bytes) && layout.file_bytes(n_values) == bytes.len() as u64
                        {
                            return Ok(layout);
                        }
                    }
                }
            }
        }
        Err(MeshError::Unexpected {
            place: Place::File,
            expected: "a PLOT3D file of one block, whose length its dimensions give",
            found: format!("{} bytes", bytes.len()),
        })
    }

    fn mark(&self) -> usize {
        4 * usize::from(self.has_records)
    }

    /// Where the dimensions begin.
    fn dimensions_at(&self) -> usize {
        self.mark() + if self.has_count { 4 + 2 * self.mark() } else { 0 }
    }

    fn integer(&self, bytes: &[u8], at: usize) -> Option<u32> {
        let word = *bytes.get(at..)?.first_chunk::<4>()?;
        Some(if self.is_big_endian { u32::from_be_bytes(word) } else { u32::from_le_bytes(word) })
    }

    fn read_dimensions(&mut self, bytes: &[u8]) -> bool {
        let at = self.dimensions_at();
        if self.has_count && self.integer(bytes, self.mark()) != Some(1) {
            return false;
        }
        if self.has_records && self.integer(bytes, at - 4) != Some(12) {
            return false;
        }
        let mut n_points = 1_u64;
        for (axis, dimension) in self.dimensions.iter_mut().enumerate() {
            let word =
                *bytes.get(at + 4 * axis..).and_then(|rest| rest.first_chunk::<4>()).unwrap_or(&[0; 4]);
            let n = if self.is_big_endian { u32::from_be_bytes(word) } else { u32::from_le_bytes(word) };
            n_points = n_points.saturating_mul(n.into());
            *dimension = n as usize;
        }
        self.dimensions.iter().all(|&n| n >= 2) && n_points <= bytes.len() as u64
    }

    fn n_points(&self) -> usize {
        self.dimensions.iter().product()
    }

    /// First byte of the values.
    fn values_at(&self) -> usize {
        let conditions = self.n_conditions * self.number.size_bytes();
        let end_of_conditions = if self.n_conditions > 0 { conditions + 2 * self.mark() } else { 0 };
        self.dimensions_at() + 12 + self.mark() + end_of_conditions + self.mark()
    }

    fn file_bytes(&self, n_values: usize) -> u64 {
        let blanks = if self.has_blanks { 4 } else { 0 };
        let per_point = (n_values * self.number.size_bytes() + blanks) as u64;
        self.values_at() as u64 + per_point * self.n_points() as u64 + self.mark() as u64
    }

    /// Numbers `first` to `first + n` of the values; the length of the file was found to hold them.
    fn numbers(&self, bytes: &[u8], first: usize, n: usize) -> Numbers {
        let size = self.number.size_bytes();
        let start = self.values_at() + first * size;
        let bytes = bytes.get(start..start + n * size).unwrap_or(&[]);
        Numbers::from_bytes(self.number, bytes, self.is_big_endian)
    }

    /// Whether each point is blanked; the marks stand behind `n_values` numbers.
    fn blanks(&self, bytes: &[u8], n_values: usize) -> Vec<bool> {
        let start = self.values_at() + n_values * self.number.size_bytes();
        (0..self.n_points()).map(|i| self.integer(bytes, start + 4 * i) == Some(0)).collect()
    }
}

#[cfg(test)]
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small grids")]
mod tests {
    use super::*;

    /// A grid of unit cells, written in one of the ways there are.
    fn grid(dimensions: [u32; 3], is_big_endian: bool, has_records: bool, is_double: bool) -> Vec<u8> {
        let word = |value: u32| if is_big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
        let number = |value: f32| match (is_double, is_big_endian) {
            (false, true) => value.to_be_bytes().to_vec(),
            (false, false) => value.to_le_bytes().to_vec(),
            (true, true) => f64::from(value).to_be_bytes().to_vec(),
            (true, false) => f64::from(value).to_le_bytes().to_vec(),
        };
        let record = |contents: Vec<u8>| {
            let mark = word(contents.len() as u32).to_vec();
            if has_records { [mark.clone(), contents, mark].concat() } else { contents }
        };
        let [ni, nj, nk] = dimensions;
        let mut values = Vec::new();
        for axis in 0..3 {
            for k in 0..nk {
                for j in 0..nj {
                    for i in 0..ni {
                        values.extend(number([i, j, k][axis] as f32));
                    }
                }
            }
        }
        [record(dimensions.map(word).concat()), record(values)].concat()
    }

    #[test]
    fn every_way_of_writing_is_told_by_its_length() {
        for (is_big_endian, has_records, is_double) in
            (0..8).map(|bits| (bits & 1 == 1, bits & 2 == 2, bits & 4 == 4))
        {
            let (mesh, report) = read(&grid([4, 3, 5], is_big_endian, has_records, is_double), &[]).unwrap();
            assert_eq!((mesh.positions.len(), mesh.tetrahedra.len(), report.n_solids_cut), (60, 120, 24));
            assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0));
            assert!((mesh.volume() - 24.0).abs() < 1e-9);
        }
        let mut cut = grid([4, 3, 5], true, false, false);
        cut.pop();
        assert!(matches!(read(&cut, &[]), Err(MeshError::Unexpected { .. })));
    }
}
