//! Numbers of binary files, in either byte order.

use std::ops::Range;

/// A file on its way.
#[derive(Clone, Default)]
pub(crate) struct Binary {
    bytes: Vec<u8>,
    is_big_endian: bool,
}

impl Binary {
    pub(crate) fn new(is_big_endian: bool) -> Self {
        Self { bytes: Vec::new(), is_big_endian }
    }

    pub(crate) fn text(mut self, text: &str) -> Self {
        self.bytes.extend(text.as_bytes());
        self
    }

    /// Whole numbers of 32 bits.
    pub(crate) fn ints(self, values: &[i32]) -> Self {
        values.iter().fold(self, |file, value| file.ordered(value.to_le_bytes().to_vec()))
    }

    /// Whole numbers of 64 bits.
    pub(crate) fn longs(self, values: &[u64]) -> Self {
        values.iter().fold(self, |file, value| file.ordered(value.to_le_bytes().to_vec()))
    }

    pub(crate) fn doubles(self, values: &[f64]) -> Self {
        values.iter().fold(self, |file, value| file.ordered(value.to_le_bytes().to_vec()))
    }

    pub(crate) fn len(&self) -> usize {
        self.bytes.len()
    }

    pub(crate) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    fn ordered(mut self, mut bytes: Vec<u8>) -> Self {
        if self.is_big_endian {
            bytes.reverse();
        }
        self.bytes.extend(bytes);
        self
    }
}

/// Bytes with others in the place of a part.
pub(crate) fn spliced(bytes: &[u8], part: Range<usize>, by: &[u8]) -> Vec<u8> {
    [&bytes[..part.start], by, &bytes[part.end..]].concat()
}
