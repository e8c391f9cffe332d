//! The statements of an OBJ file, gathered into flat lists.

use super::regions::Regions;
use crate::FileReport;
use crate::files::coordinates::{check_coordinate, nearest_f32};
use crate::files::error::{MeshError, Place};
use crate::files::text::{Scanner, Style, parse_integer};

/// A corner's index of a list it does not use.
pub(crate) const NONE: u32 = u32::MAX;

/// What an OBJ file lists. Indices count from 0 and are below the lengths of what they point at, or
/// [`NONE`].
#[derive(Default)]
pub(crate) struct Statements {
    pub positions: Vec<[f64; 3]>,
    /// Positions that `f32` cannot hold, with their lines.
    pub bad_places: Vec<(usize, Place)>,
    /// Positions with a weight other than 1, which rational curves would use.
    pub n_weights: u64,
    /// Texture coordinates with a third number other than 0.
    pub n_third_texcoords: u64,
    /// Empty, or one colour per position; white where the file gives none.
    pub colors: Vec<[f32; 4]>,
    pub n_colored: usize,
    /// Components that a colour has in the file, 3 or 4.
    pub n_color_components: u32,
    pub texcoords: Vec<[f32; 2]>,
    pub normals: Vec<[f32; 3]>,
    /// Position, texture coordinate and normal of every corner of every face.
    pub corners: Vec<[u32; 3]>,
    /// End of each face's corners; they begin where the previous face's end.
    pub face_ends: Vec<usize>,
}

/// What the three indices of a corner point at.
const LISTS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// The largest index into a list, and where it stands: the list may grow after it.
#[derive(Clone, Copy, Default)]
struct Largest {
    /// Index from 1; 0 if the corner has none.
    number: u64,
    line: Option<Place>,
}

impl Statements {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unexpected`] or [`MeshError::IndexOutOfRange`] with the line at fault.
    pub(crate) fn parse(bytes: &[u8], report: &mut FileReport) -> Result<Self, MeshError> {
        let mut scanner = Scanner::new(bytes, Style { hash_comments: true, continued_lines: true });
        let mut statements = Self { n_color_components: 3, ..Self::default() };
        let mut largest = [Largest::default(); 3];
        let mut regions = Regions::default();
        loop {
            match scanner.word_in_line() {
                None => {}
                Some(b"v") => statements.position(&mut scanner)?,
                Some(b"vt") => statements.texcoord(&mut scanner)?,
                Some(b"vn") => {
                    let normal =
                        [scanner.number_in_line()?, scanner.number_in_line()?, scanner.number_in_line()?];
                    statements.normals.push(normal.map(nearest_f32));
                }
                Some(b"f" | b"fo") => {
                    statements.face(&mut scanner, &mut largest)?;
                    regions.add_face(statements.n_triangles_of_last_face(), report);
                }
                Some(keyword) => regions.note(keyword, &mut scanner, report),
            }
            if !scanner.next_line() {
                break;
            }
        }
        for (list, Largest { number, line }) in largest.into_iter().enumerate() {
            let count = statements.list_lengths()[list];
            if let Some(place) = line.filter(|_| number > count) {
                let index = i64::try_from(number).unwrap_or(i64::MAX);
                return Err(MeshError::IndexOutOfRange { place, what: LISTS[list], index, count });
            }
        }
        Ok(statements)
    }

    fn n_triangles_of_last_face(&self) -> u64 {
        let start = self.face_ends.iter().rev().nth(1).copied().unwrap_or(0);
        (self.corners.len() - start).saturating_sub(2) as u64
    }

    fn list_lengths(&self) -> [u64; 3] {
        [self.positions.len(), self.texcoords.len(), self.normals.len()].map(|length| length as u64)
    }

    /// Three coordinates; a fourth number is a weight and ignored, three or four more are a colour.
    fn position(&mut self, scanner: &mut Scanner<'_>) -> Result<(), MeshError> {
        let mut numbers = [0.0; 7];
        let mut n_numbers = 0;
        while n_numbers < numbers.len() {
            let Some(word) = scanner.word_in_line() else { break };
            let value = crate::files::text::parse_number(word);
            numbers[n_numbers] = value.ok_or_else(|| scanner.unexpected("a number", Some(word)))?;
            n_numbers += 1;
        }
        if n_numbers < 3 {
            return Err(scanner.unexpected("three coordinates", None));
        }
        let [x, y, z, color @ ..] = numbers;
        if [x, y, z].iter().any(|&value| check_coordinate(value, scanner.place()).is_err()) {
            self.bad_places.push((self.positions.len(), scanner.place()));
        }
        self.n_weights += u64::from(n_numbers == 4 && color[0] != 1.0);
        if n_numbers >= 6 {
            self.colors.resize(self.positions.len(), [1.0; 4]);
            let alpha = if n_numbers == 7 { color[3] } else { 1.0 };
            self.colors.push([color[0], color[1], color[2], alpha].map(nearest_f32));
            self.n_colored += 1;
            if n_numbers == 7 {
                self.n_color_components = 4;
            }
        }
        self.positions.push([x, y, z]);
        Ok(())
    }

    /// One to three numbers, of which the first two are kept; a missing second one is zero.
    fn texcoord(&mut self, scanner: &mut Scanner<'_>) -> Result<(), MeshError> {
        let u = scanner.number_in_line()?;
        let v = match scanner.word_in_line() {
            Some(word) => crate::files::text::parse_number(word)
                .ok_or_else(|| scanner.unexpected("a number", Some(word)))?,
            None => 0.0,
        };
        // OBJ counts V from the bottom.
        self.texcoords.push([nearest_f32(u), nearest_f32(1.0 - v)]);
        let third: Option<f64> = scanner.word_in_line().and_then(crate::files::text::parse_number);
        self.n_third_texcoords += u64::from(third.is_some_and(|third| third != 0.0));
        Ok(())
    }

    fn face(&mut self, scanner: &mut Scanner<'_>, largest: &mut [Largest; 3]) -> Result<(), MeshError> {
        let counts = self.list_lengths();
        while let Some(word) = scanner.word_in_line() {
            let mut corner = [NONE; 3];
            for (list, part) in word.split(|&byte| byte == b'/').enumerate() {
                if list > 2 || (part.is_empty() && list == 0) {
                    return Err(scanner.unexpected("a corner such as 1, 1/2, 1//3 or 1/2/3", Some(word)));
                }
                if part.is_empty() {
                    continue;
                }
                let index = parse_integer(part);
                let index = index.ok_or_else(|| scanner.unexpected("an index", Some(part)))?;
                let out_of_range = || {
                    let (place, what, count) = (scanner.place(), LISTS[list], counts[list]);
                    MeshError::IndexOutOfRange { place, what, index, count }
                };
                // Counted from 1; negative ones count back from the last.
                let number = match u64::try_from(index) {
                    Ok(number) => number,
                    Err(_) => {
                        (counts[list] + 1).checked_sub(index.unsigned_abs()).ok_or_else(out_of_range)?
                    }
                };
                let place = number.checked_sub(1).and_then(|place| u32::try_from(place).ok());
                corner[list] = place.filter(|&place| place != NONE).ok_or_else(out_of_range)?;
                if number > largest[list].number {
                    largest[list] = Largest { number, line: Some(scanner.place()) };
                }
            }
            self.corners.push(corner);
        }
        self.face_ends.push(self.corners.len());
        Ok(())
    }
}
