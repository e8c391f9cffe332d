//! What the text formats of volumes share: counts that the bytes can hold, points, and indices into a table of names.

use std::collections::HashMap;

use crate::error::{MeshError, Place};
use crate::text::{Scanner, parse_integer};

/// A count of things that take two bytes each at least.
pub(super) fn count(scanner: &mut Scanner<'_>, what: &'static str) -> Result<usize, MeshError> {
    let word = scanner.word();
    checked_count(scanner, word, what)
}

/// A word as a count of things that take two bytes each at least, all of them behind it.
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

/// A whole number.
pub(super) fn integer(scanner: &mut Scanner<'_>) -> Result<i64, MeshError> {
    let word = scanner.word();
    word.and_then(parse_integer).ok_or_else(|| scanner.unexpected("a whole number", word))
}

/// Three numbers. A point that no cell uses may be anything, so they are not checked.
pub(super) fn point(scanner: &mut Scanner<'_>) -> Result<[f64; 3], MeshError> {
    Ok([scanner.number()?, scanner.number()?, scanner.number()?])
}

/// Numbers that a file gives its vertices, and their places in the order of the file.
#[derive(Default)]
pub(super) struct Names {
    places: HashMap<i64, u32>,
    n: u32,
}

impl Names {
    /// The next vertex has this number.
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

    /// The place of the vertex of a number.
    pub(super) fn find(&self, name: i64, place: Place) -> Result<u32, MeshError> {
        let count = self.n.into();
        let out_of_range = MeshError::IndexOutOfRange { place, what: "vertex", index: name, count };
        self.places.get(&name).copied().ok_or(out_of_range)
    }

    pub(super) fn len(&self) -> usize {
        self.n as usize
    }
}
