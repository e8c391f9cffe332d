//! Words and arrays of a legacy file, text or binary.

use crate::ScalarType;
use crate::files::error::{MeshError, Place};
use crate::files::text;
use crate::files::text::{Scanner, Style, parse_integer};
use crate::files::volume::scalars::{NumberType, Numbers, push_text};

/// What an array holds, by the name of its type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ArrayType {
    Numbers(NumberType),
    /// Zeros and ones, 8 in a byte in a binary file.
    Bits,
    Texts,
}

/// The file from behind its first three lines on.
pub(super) struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    is_binary: bool,
}

impl<'a> Source<'a> {
    /// Reads the signature, the title and the word `ASCII` or `BINARY`.
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, MeshError> {
        let mut source = Self { bytes, at: 0, line: 1, is_binary: false };
        let signature = source.take_line();
        if !signature.starts_with(b"# vtk DataFile") {
            return Err(source.unexpected("\"# vtk DataFile\"", Some(signature)));
        }
        source.take_line();
        let word = source.word();
        source.is_binary = match word {
            Some(word) if word.eq_ignore_ascii_case(b"binary") => true,
            Some(word) if word.eq_ignore_ascii_case(b"ascii") => false,
            word => return Err(source.unexpected("ASCII or BINARY", word)),
        };
        Ok(source)
    }

    /// Where the source is.
    pub(super) fn place(&self) -> Place {
        if self.is_binary { Place::byte(self.at) } else { Place::Line(self.line) }
    }

    pub(super) fn is_text(&self) -> bool {
        !self.is_binary
    }

    /// The rest of this line, without its end.
    pub(super) fn take_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let len = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.at += (len + 1).min(rest.len());
        self.line += 1;
        rest[..len].strip_suffix(b"\r").unwrap_or(&rest[..len])
    }

    /// The next word, in this line or a later one.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let skipped = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        self.line += rest[..skipped].iter().filter(|&&byte| byte == b'\n').count() as u64;
        let rest = &rest[skipped..];
        let len = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += skipped + len;
        Some(&rest[..len])
    }

    /// The next word of this line.
    pub(super) fn word_in_line(&mut self) -> Option<&'a [u8]> {
        let mut scanner = Scanner::new_at(self.bytes, self.at, self.line, Style::default());
        let word = scanner.word_in_line();
        self.at = self.bytes.len() - scanner.n_bytes_left();
        word
    }

    /// The next word if it passes `test`; otherwise nothing is read.
    pub(super) fn word_if(&mut self, test: impl Fn(&[u8]) -> bool) -> Option<&'a [u8]> {
        let (at, line) = (self.at, self.line);
        let word = self.word().filter(|word| test(word));
        if word.is_none() {
            (self.at, self.line) = (at, line);
        }
        word
    }

    /// A name, with its `%20` and the like decoded.
    pub(super) fn name(&mut self) -> Result<String, MeshError> {
        let word = self.word().ok_or_else(|| self.unexpected("a name", None))?;
        Ok(decode(word))
    }

    /// A count of items of at least 1 byte each.
    pub(super) fn count(&mut self, what: &'static str) -> Result<usize, MeshError> {
        let word = self.word();
        let count = word.and_then(parse_integer).and_then(|count| u64::try_from(count).ok());
        let count = count.ok_or_else(|| self.unexpected("a count", word))?;
        self.check_count(count, 1, what)
    }

    fn check_count(&self, count: u64, bytes_each: u64, what: &'static str) -> Result<usize, MeshError> {
        let left = (self.bytes.len() - self.at) as u64;
        let limit = (left / bytes_each).min(u32::MAX.into());
        let valid = usize::try_from(count).ok().filter(|_| count <= limit);
        valid.ok_or(MeshError::CountTooLarge { place: self.place(), what, count, limit })
    }

    /// Reads the type of an array.
    pub(super) fn array_type(&mut self) -> Result<ArrayType, MeshError> {
        let word = self.word();
        let lower = word.map(<[u8]>::to_ascii_lowercase);
        match lower.as_deref() {
            Some(b"bit") => Ok(ArrayType::Bits),
            Some(b"string" | b"utf8_string" | b"unicode_string") => Ok(ArrayType::Texts),
            _ => {
                let number = lower.as_deref().and_then(number_type).map(ArrayType::Numbers);
                number.ok_or_else(|| self.unexpected("a type of VTK", word))
            }
        }
    }

    /// Reads a type of numbers.
    pub(super) fn number_type(&mut self) -> Result<NumberType, MeshError> {
        let word = self.word();
        let number = word.and_then(|word| number_type(&word.to_ascii_lowercase()));
        number.ok_or_else(|| self.unexpected("a number type", word))
    }

    /// `n_tuples * n_components` numbers of a type. In a binary file they begin behind the end of
    /// this line.
    pub(super) fn numbers(
        &mut self,
        [n_tuples, n_components]: [usize; 2],
        number: NumberType,
    ) -> Result<Numbers, MeshError> {
        let count = n_tuples as u64 * n_components as u64;
        if self.is_binary {
            self.take_line();
            let n = self.check_count(count, number.size_bytes() as u64, "numbers")?;
            let n_bytes = n * number.size_bytes();
            let bytes = &self.bytes[self.at..self.at + n_bytes];
            self.at += n_bytes;
            return Ok(Numbers::from_bytes(number, bytes, true));
        }
        let n = self.check_count(count, 1, "numbers")?;
        let mut bytes = Vec::with_capacity(n * number.size_bytes());
        for _ in 0..n {
            let word = self.word();
            let pushed = word.and_then(|word| push_text(&mut bytes, number, word));
            pushed.ok_or_else(|| self.unexpected("a number of the array's type", word))?;
        }
        Ok(Numbers { number, bytes })
    }

    /// `n_tuples * n_components` bits, each as a byte. In a binary file they begin behind the end
    /// of this line, the highest bit of a byte first.
    pub(super) fn bits(&mut self, [n_tuples, n_components]: [usize; 2]) -> Result<Numbers, MeshError> {
        let number = NumberType::Kept(ScalarType::U8);
        if !self.is_binary {
            return self.numbers([n_tuples, n_components], number);
        }
        let count = n_tuples as u64 * n_components as u64;
        self.take_line();
        let n_bytes = self.check_count(count.div_ceil(8), 1, "bytes of bits")?;
        let packed = &self.bytes[self.at..self.at + n_bytes];
        self.at += n_bytes;
        let bits = packed.iter().flat_map(|byte| (0..8).rev().map(move |bit| byte >> bit & 1));
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        Ok(Numbers { number, bytes: bits.take(count).collect() })
    }

    /// Skips `n_tuples * n_components` texts. In a text file each has a line; in a binary one its
    /// length stands before it.
    pub(super) fn skip_texts(&mut self, [n_tuples, n_components]: [usize; 2]) -> Result<(), MeshError> {
        self.take_line();
        let n = self.check_count(n_tuples as u64 * n_components as u64, 1, "texts")?;
        for _ in 0..n {
            if self.is_binary {
                let length = self.text_length()?;
                let length = self.check_count(length, 1, "bytes of a text")?;
                self.at += length;
            } else {
                self.take_line();
            }
        }
        Ok(())
    }

    /// Length of a text in a binary file. Its two highest bits say in how many bytes it is written.
    fn text_length(&mut self) -> Result<u64, MeshError> {
        let rest = &self.bytes[self.at..];
        let n_bytes = rest.first().map_or(1, |first| 8 >> (first >> 6));
        let bytes = rest.get(..n_bytes).ok_or(MeshError::Truncated {
            place: self.place(),
            what: "the length of a text",
            expected: n_bytes as u64,
            found: rest.len() as u64,
        })?;
        self.at += n_bytes;
        let value = bytes.iter().fold(0, |value, &byte| value << 8 | u64::from(byte));
        Ok(value & (u64::MAX >> (64 - 8 * n_bytes) >> 2))
    }

    /// Skips information on arrays up to an empty line.
    pub(super) fn skip_metadata(&mut self) {
        self.take_line();
        while self.at < self.bytes.len() && !self.take_line().is_empty() {}
    }

    pub(super) fn unexpected(&self, expected: &'static str, found: Option<&[u8]>) -> MeshError {
        let found = found.map_or_else(|| "the end of the file".to_owned(), crate::files::error::excerpt);
        MeshError::Unexpected { place: self.place(), expected, found }
    }
}

/// The number type of a name in lower case.
fn number_type(name: &[u8]) -> Option<NumberType> {
    let kept = |scalar| Some(NumberType::Kept(scalar));
    match name {
        b"char" | b"signed_char" | b"vtktypeint8" => kept(ScalarType::I8),
        b"unsigned_char" | b"vtktypeuint8" => kept(ScalarType::U8),
        b"short" | b"vtktypeint16" => kept(ScalarType::I16),
        b"unsigned_short" | b"vtktypeuint16" => kept(ScalarType::U16),
        // Ids are written as `int` whatever they are in memory.
        b"int" | b"vtkidtype" | b"vtktypeint32" => kept(ScalarType::I32),
        b"unsigned_int" | b"vtktypeuint32" => kept(ScalarType::U32),
        b"long" | b"long_long" | b"vtktypeint64" => Some(NumberType::I64),
        b"unsigned_long" | b"unsigned_long_long" | b"vtktypeuint64" => Some(NumberType::U64),
        b"float" | b"vtktypefloat32" => kept(ScalarType::F32),
        b"double" | b"vtktypefloat64" => kept(ScalarType::F64),
        _ => None,
    }
}

/// Decodes `%` and two hexadecimal digits, as VTK writes blanks in names.
fn decode(word: &[u8]) -> String {
    let mut bytes = Vec::with_capacity(word.len());
    let mut at = 0;
    while let Some(&byte) = word.get(at) {
        let digits = word.get(at + 1..at + 3).and_then(|digits| std::str::from_utf8(digits).ok());
        let code = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match code.filter(|_| byte == b'%') {
            Some(code) => (bytes.push(code), at += 3).1,
            None => (bytes.push(byte), at += 1).1,
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A number of components from 1 to 64.
pub(super) fn small_count(word: Option<&[u8]>) -> Option<usize> {
    let count = text::parse_integer(word?)?;
    usize::try_from(count).ok().filter(|count| (1..=64).contains(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_decoded() {
        assert_eq!(decode(b"total%20energy%"), "total energy%");
        assert_eq!(decode(b"100%2"), "100%2");
    }

    #[test]
    fn lengths_of_texts_take_one_to_eight_bytes() {
        let length = |bytes: &[u8]| {
            let mut source = Source { bytes, at: 0, line: 1, is_binary: true };
            source.text_length().map(|length| (length, source.at))
        };
        assert_eq!(length(&[0xC7]).unwrap(), (7, 1));
        assert_eq!(length(&[0x81, 0x02]).unwrap(), (0x102, 2));
        assert_eq!(length(&[0x40, 1, 2, 3]).unwrap(), (0x1_0203, 4));
        assert_eq!(length(&[0x3F, 0, 0, 0, 0, 0, 0, 1]).unwrap(), ((0x3F << 56) + 1, 8));
        assert!(matches!(length(&[0x40, 1]), Err(MeshError::Truncated { .. })));
    }
}
