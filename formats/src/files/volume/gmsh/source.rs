//! Words and numbers of a Gmsh file. In a binary file sections, counts of version 2 and names are
//! text, and numbers begin behind the end of a line.

use crate::files::error::{MeshError, Place};
use crate::files::text::{Scanner, Style, parse_integer};
use crate::files::volume::words::{count, integer};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Binary {
        is_big_endian: bool,
        /// Bytes of a count or of the number of an item in version 4.
        size_bytes: usize,
    },
}

/// A position in a file.
#[derive(Clone)]
pub(super) struct Source<'a> {
    n_bytes: usize,
    scanner: Scanner<'a>,
    pub encoding: Encoding,
}

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let scanner = Scanner::new(bytes, Style::default());
        Self { n_bytes: bytes.len(), scanner, encoding: Encoding::Text }
    }

    pub(super) fn is_text(&self) -> bool {
        self.encoding == Encoding::Text
    }

    /// Where the source is.
    pub(super) fn place(&self) -> Place {
        if self.is_text() {
            self.scanner.place()
        } else {
            Place::byte(self.n_bytes - self.scanner.n_bytes_left())
        }
    }

    /// The next word, in this line or a later one.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        self.scanner.word()
    }

    /// The words of the next line, with one blank between each.
    pub(super) fn next_line(&mut self) -> String {
        self.scanner.next_line();
        self.rest_of_line()
    }

    /// The words up to the end of this line, with one blank between each.
    pub(super) fn rest_of_line(&mut self) -> String {
        let words = std::iter::from_fn(|| self.scanner.word_in_line());
        words.map(String::from_utf8_lossy).collect::<Vec<_>>().join(" ")
    }

    /// The next word of this line as an integer; `None` at the end of the line.
    pub(super) fn integer_in_line(&mut self, what: &'static str) -> Result<Option<i64>, MeshError> {
        let Some(word) = self.scanner.word_in_line() else { return Ok(None) };
        let value = parse_integer(word);
        value.map(Some).ok_or_else(|| self.unexpected(what, Some(word)))
    }

    /// A count of items of at least 2 bytes each, which is text in binary files too.
    pub(super) fn text_count(&mut self, what: &'static str) -> Result<usize, MeshError> {
        count(&mut self.scanner, what)
    }

    /// An integer that is text in binary files too.
    pub(super) fn text_integer(&mut self) -> Result<i64, MeshError> {
        integer(&mut self.scanner)
    }

    /// A number that is text in binary files too.
    pub(super) fn text_number(&mut self) -> Result<f64, MeshError> {
        self.scanner.number()
    }

    /// Goes to where numbers begin: behind the end of this line in a binary file.
    pub(super) fn begin_numbers(&mut self) {
        if !self.is_text() {
            self.scanner.next_line();
        }
    }

    /// Reads the number 1, which tells the byte order of a binary file. Its counts have
    /// `size_bytes`.
    pub(super) fn begin_binary(&mut self, size_bytes: usize) -> Result<(), MeshError> {
        self.encoding = Encoding::Binary { is_big_endian: false, size_bytes };
        self.begin_numbers();
        let is_big_endian = match *self.take::<4>("the number 1")? {
            [1, 0, 0, 0] => false,
            [0, 0, 0, 1] => true,
            other => return Err(self.unexpected("the number 1 in the file's byte order", Some(&other))),
        };
        self.encoding = Encoding::Binary { is_big_endian, size_bytes };
        Ok(())
    }

    /// An integer of 32 bits.
    pub(super) fn int(&mut self) -> Result<i64, MeshError> {
        match self.encoding {
            Encoding::Text => self.text_integer(),
            Encoding::Binary { is_big_endian, .. } => {
                let bytes = *self.take("a whole number")?;
                Ok(if is_big_endian { i32::from_be_bytes(bytes) } else { i32::from_le_bytes(bytes) }.into())
            }
        }
    }

    /// A count or the number of an item in version 4.
    pub(super) fn size(&mut self) -> Result<i64, MeshError> {
        let Encoding::Binary { is_big_endian, size_bytes } = self.encoding else {
            return self.text_integer();
        };
        let value = if size_bytes == 4 {
            let bytes = *self.take("a count")?;
            u64::from(if is_big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
        } else {
            let bytes = *self.take("a count")?;
            if is_big_endian { u64::from_be_bytes(bytes) } else { u64::from_le_bytes(bytes) }
        };
        i64::try_from(value).map_err(|_| MeshError::Unexpected {
            place: self.place(),
            expected: "a whole number below 2^63",
            found: value.to_string(),
        })
    }

    /// A count, as [`Source::size`] reads it, of items of at least `bytes_each` bytes in a binary
    /// file.
    pub(super) fn count(&mut self, bytes_each: usize, what: &'static str) -> Result<usize, MeshError> {
        if self.is_text() {
            return self.text_count(what);
        }
        let count = self.size()?;
        self.checked(count, bytes_each, what)
    }

    /// A count of items of at least `bytes_each` bytes, which the rest of the file must hold.
    pub(super) fn checked(
        &self,
        count: i64,
        bytes_each: usize,
        what: &'static str,
    ) -> Result<usize, MeshError> {
        let not_negative = u64::try_from(count).map_err(|_| MeshError::Unexpected {
            place: self.place(),
            expected: "a count",
            found: count.to_string(),
        });
        let count = not_negative?;
        let limit = (self.scanner.n_bytes_left() / bytes_each) as u64;
        let valid = usize::try_from(count).ok().filter(|_| count <= limit);
        valid.ok_or(MeshError::CountTooLarge { place: self.place(), what, count, limit })
    }

    /// A number of 64 bits.
    pub(super) fn number(&mut self) -> Result<f64, MeshError> {
        match self.encoding {
            Encoding::Text => self.scanner.number(),
            Encoding::Binary { is_big_endian, .. } => {
                let bytes = *self.take("a number")?;
                Ok(if is_big_endian { f64::from_be_bytes(bytes) } else { f64::from_le_bytes(bytes) })
            }
        }
    }

    /// Three coordinates. They are not checked, because an unused point may be anything.
    pub(super) fn point(&mut self) -> Result<[f64; 3], MeshError> {
        Ok([self.number()?, self.number()?, self.number()?])
    }

    /// Skips everything up to and including a word, or up to the end of the file.
    pub(super) fn pass(&mut self, end: &[u8]) {
        if self.is_text() {
            while self.word().is_some_and(|word| word != end) {}
        } else {
            self.scanner.pass_bytes(end);
        }
    }

    fn take<const N: usize>(&mut self, what: &'static str) -> Result<&'a [u8; N], MeshError> {
        let (place, found) = (self.place(), self.scanner.n_bytes_left() as u64);
        let taken = self.scanner.take_bytes();
        taken.ok_or(MeshError::Truncated { place, what, expected: N as u64, found })
    }

    /// The error for something other than what is expected here.
    pub(super) fn unexpected(&self, expected: &'static str, found: Option<&[u8]>) -> MeshError {
        let error = self.scanner.unexpected(expected, found);
        match error {
            MeshError::Unexpected { expected, found, .. } => {
                MeshError::Unexpected { place: self.place(), expected, found }
            }
            other => other,
        }
    }
}
