//! PLOT3D in binary. Nothing in such a file says in which byte order, precision and framing it is
//! written; its length decides, which differs for every combination that its first numbers allow.

use super::{Block, Contents, are_blocks};
use crate::ScalarType;
use crate::files::error::{MeshError, Place};
use crate::files::volume::scalars::{NumberType, Numbers};

/// Reads the blocks.
///
/// # Errors
///
/// [`MeshError::Unexpected`] if no way of writing explains the length of the file.
pub(super) fn read(bytes: &[u8], contents: Contents) -> Result<Vec<Block>, MeshError> {
    for frame in Frame::all() {
        let Some((dimensions, start)) = frame.dimensions(bytes) else { continue };
        for &(n_values, has_blanks) in contents.of_point {
            for number in [NumberType::F32, NumberType::Kept(ScalarType::F64)] {
                let n_conditions = contents.n_conditions;
                let layout = Layout { frame, number, n_values, has_blanks, n_conditions };
                if layout.file_bytes(&dimensions, start) == bytes.len() as u64 {
                    return Ok(layout.blocks(bytes, dimensions, start));
                }
            }
        }
    }
    Err(MeshError::Unexpected {
        place: Place::File,
        expected: "a PLOT3D file, whose length its dimensions give",
        found: format!("{} bytes", bytes.len()),
    })
}

/// How a file begins.
#[derive(Clone, Copy)]
struct Frame {
    is_big_endian: bool,
    /// Whether each list stands between two marks with its length, as Fortran writes it.
    has_records: bool,
    /// Whether the file begins with the number of its blocks.
    has_count: bool,
}

impl Frame {
    fn all() -> impl Iterator<Item = Self> {
        (0..8).map(|bits| Self {
            is_big_endian: bits & 4 == 0,
            has_records: bits & 2 != 0,
            has_count: bits & 1 != 0,
        })
    }

    /// Bytes of a mark.
    fn mark(self) -> usize {
        4 * usize::from(self.has_records)
    }

    fn integer(self, bytes: &[u8], at: usize) -> Option<u32> {
        let word = *bytes.get(at..)?.first_chunk::<4>()?;
        Some(if self.is_big_endian { u32::from_be_bytes(word) } else { u32::from_le_bytes(word) })
    }

    /// Dimensions of all blocks, and where the list behind them begins.
    fn dimensions(self, bytes: &[u8]) -> Option<(Vec<[usize; 3]>, usize)> {
        let mark = self.mark();
        let (n_blocks, at) =
            if self.has_count { (self.integer(bytes, mark)? as usize, 4 + 3 * mark) } else { (1, mark) };
        let n_bytes = n_blocks.checked_mul(12).filter(|&n_bytes| n_bytes <= bytes.len())?;
        if self.has_records && self.integer(bytes, at - 4)? as usize != n_bytes {
            return None;
        }
        let words: Option<Vec<usize>> =
            (0..3 * n_blocks).map(|i| Some(self.integer(bytes, at + 4 * i)? as usize)).collect();
        let dimensions = words?.as_chunks::<3>().0.to_vec();
        are_blocks(&dimensions, bytes.len()).then_some((dimensions, at + n_bytes + mark))
    }
}

/// How a file is written.
#[derive(Clone, Copy)]
struct Layout {
    frame: Frame,
    number: NumberType,
    n_values: usize,
    has_blanks: bool,
    n_conditions: usize,
}

impl Layout {
    /// Bytes before the values of a block.
    fn head_bytes(self) -> usize {
        let mark = self.frame.mark();
        let conditions = self.n_conditions * self.number.size_bytes();
        mark + if self.n_conditions > 0 { conditions + 2 * mark } else { 0 }
    }

    fn file_bytes(self, dimensions: &[[usize; 3]], start: usize) -> u64 {
        let per_point = self.n_values * self.number.size_bytes() + if self.has_blanks { 4 } else { 0 };
        let around = (self.head_bytes() + self.frame.mark()) as u64;
        let block = |block: &[usize; 3]| around + per_point as u64 * block.iter().product::<usize>() as u64;
        start as u64 + dimensions.iter().map(block).sum::<u64>()
    }

    /// Takes the blocks of a file of the right length apart.
    fn blocks(self, bytes: &[u8], dimensions: Vec<[usize; 3]>, start: usize) -> Vec<Block> {
        let mut at = start;
        let block = |dimensions: [usize; 3]| {
            let n_points: usize = dimensions.iter().product();
            at += self.head_bytes();
            let n_bytes = self.n_values * n_points * self.number.size_bytes();
            let values = bytes.get(at..at + n_bytes).unwrap_or_default();
            let numbers = Numbers::from_bytes(self.number, values, self.frame.is_big_endian);
            at += n_bytes;
            let is_blank = |i: usize| self.frame.integer(bytes, at + 4 * i) == Some(0);
            let blanks = self.has_blanks.then(|| (0..n_points).map(is_blank).collect::<Vec<bool>>());
            at += blanks.as_ref().map_or(0, |_| 4 * n_points) + self.frame.mark();
            Block { dimensions, numbers, blanks }
        };
        dimensions.into_iter().map(block).collect()
    }
}

#[cfg(test)]
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small grids")]
mod tests {
    use super::super::read;
    use crate::MeshError;

    /// Blocks of unit cells, written in one of the ways there are; with their number in front of
    /// several.
    fn grid(blocks: &[[u32; 3]], is_big_endian: bool, has_records: bool, is_double: bool) -> Vec<u8> {
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
        let mut file = Vec::new();
        if blocks.len() > 1 {
            file.extend(record(word(blocks.len() as u32).to_vec()));
        }
        file.extend(record(blocks.iter().flatten().flat_map(|&n| word(n)).collect()));
        let mut start = 0;
        for &[ni, nj, nk] in blocks {
            let mut values = Vec::new();
            for axis in 0..3 {
                for k in 0..nk {
                    for j in 0..nj {
                        for i in 0..ni {
                            values.extend(number([start + i, j, k][axis] as f32));
                        }
                    }
                }
            }
            file.extend(record(values));
            start += ni - 1;
        }
        file
    }

    #[test]
    fn every_way_of_writing_is_told_by_its_length() {
        for (is_big_endian, has_records, is_double) in
            (0..8).map(|bits| (bits & 1 == 1, bits & 2 == 2, bits & 4 == 4))
        {
            let one = grid(&[[4, 3, 5]], is_big_endian, has_records, is_double);
            let (mesh, report) = read(&one, &[]).unwrap();
            assert_eq!((mesh.positions.len(), mesh.tetrahedra.len(), report.n_solids_cut), (60, 120, 24));
            assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0));
            assert!((mesh.volume() - 24.0).abs() < 1e-9);
            let two = grid(&[[4, 3, 5], [3, 3, 5]], is_big_endian, has_records, is_double);
            let (mesh, report) = read(&two, &[]).unwrap();
            assert_eq!((mesh.tetrahedra.len(), report.n_solids_cut), (6 * 40, 40));
            assert!((mesh.volume() - 40.0).abs() < 1e-9);
        }
        let mut cut = grid(&[[4, 3, 5]], true, false, false);
        cut.pop();
        assert!(matches!(read(&cut, &[]), Err(MeshError::Unexpected { .. })));
    }
}
