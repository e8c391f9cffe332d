//! What the text formats of volumes share: checked counts, points, and vertices found by their
//! numbers.

use std::collections::HashMap;

use crate::files::error::{MeshError, Place};
use crate::files::text::{Scanner, parse_integer};

/// Reads a count of items that take at least 2 bytes each.
pub(super) fn count(scanner: &mut Scanner<'_>, what: &'static str) -> Result<usize, MeshError> {
    let word = scanner.word();
    checked_count(scanner, word, what)
}

/// A word as a count of items that take at least 2 bytes each and stand behind it.
pub(super) fn checked_count(
    scanner: &Scanner<'_>,
    word: Option<&[u8]>,
    what: &'static str,
) -> Result<usize, MeshError> {
    let count = word.and_then(parse_integer).and_then(|count| u64::try_from(count).ok());
    let count = count.ok_or_else(|| scanner.unexpected("a count", word))?;
    let limit = (scanner.n_bytes_left() as u64 / 2).min(u32::MAX.into());
    let valid = usize::try_from(count).ok().filter(|_| count <= limit);
    valid.ok_or(MeshError::CountTooLarge { place: scanner.place(), what, count, limit })
}

/// Reads an integer.
pub(super) fn integer(scanner: &mut Scanner<'_>) -> Result<i64, MeshError> {
    let word = scanner.word();
    word.and_then(parse_integer).ok_or_else(|| scanner.unexpected("a whole number", word))
}

/// Reads three numbers. They are not checked, because an unused point may be anything.
pub(super) fn point(scanner: &mut Scanner<'_>) -> Result<[f64; 3], MeshError> {
    Ok([scanner.number()?, scanner.number()?, scanner.number()?])
}

/// The numbers by which a file names its vertices, and the place of each in the file.
#[derive(Default)]
pub(super) struct Names {
    places: HashMap<i64, u32>,
    n: u32,
}

impl Names {
    /// Adds the next vertex by its number.
    pub(super) fn push(&mut self, name: i64, place: Place) -> Result<(), MeshError> {
        if self.places.insert(name, self.n).is_some() {
            return Err(MeshError::Unexpected {
                place,
                expected: "a vertex number that is not taken",
                found: name.to_string(),
            });
        }
        self.n += 1;
        Ok(())
    }

    /// The place of the vertex with this number.
    pub(super) fn find(&self, name: i64, place: Place) -> Result<u32, MeshError> {
        let count = self.n.into();
        let out_of_range = MeshError::IndexOutOfRange { place, what: "vertex", index: name, count };
        self.places.get(&name).copied().ok_or(out_of_range)
    }

    pub(super) fn len(&self) -> usize {
        self.n as usize
    }
}
