//! Planes of bytes: a block consists of planes, and each is compressed separately.
//!
//! Fields of one kind are stored together: numbers byte by byte, positions as differences from a
//! neighbour, on the scale on which floats are ordered like integers. Each plane is then deflated
//! (RFC 1951), or stored if that is shorter.

use super::StreamError;
use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use std::io::{Read, Write};

/// Names of the planes before those of the attributes.
pub(super) mod plane {
    /// Kind of each operation, and its number of new triangles.
    pub(in super::super) const KINDS: usize = 0;
    /// Four planes: the vertex beside which an operation happens, and other vertices that are named
    /// by number.
    pub(in super::super) const VERTICES: usize = 1;
    /// One bit per triangle of the star: whether it moves.
    pub(in super::super) const MASKS: usize = 5;
    /// Third corner of each new triangle, by its place among the neighbours.
    pub(in super::super) const LINKS: usize = 6;
    /// Order of the corners of a new triangle.
    pub(in super::super) const ORDERS: usize = 7;
    /// Four planes: coordinates.
    pub(in super::super) const COORDINATES: usize = 8;
    /// One plane per byte of attributes.
    pub(in super::super) const ATTRIBUTES: usize = 12;
}

/// Bytes in planes, written to their ends.
#[derive(Clone, Debug, Default)]
pub(super) struct Planes {
    planes: Vec<Vec<u8>>,
    /// How much of each plane has been read.
    read: Vec<usize>,
    block: usize,
}

impl Planes {
    pub(super) fn new(stride_bytes: usize) -> Self {
        let n = plane::ATTRIBUTES + stride_bytes;
        Self { planes: vec![Vec::new(); n], read: vec![0; n], block: 0 }
    }

    pub(super) fn put(&mut self, plane: usize, byte: u8) {
        self.planes[plane].push(byte);
    }

    /// Puts the bytes of a number into four planes.
    pub(super) fn put_u32(&mut self, plane: usize, value: u32) {
        value.to_le_bytes().into_iter().zip(plane..).for_each(|(byte, plane)| self.put(plane, byte));
    }

    pub(super) fn take(&mut self, plane: usize) -> Result<u8, StreamError> {
        let at = self.read[plane];
        let missing = StreamError::Block {
            block: self.block,
            what: "bytes",
            found: self.planes[plane].len() as u64,
            expected: at as u64 + 1,
        };
        let byte = self.planes[plane].get(at).copied().ok_or(missing)?;
        self.read[plane] += 1;
        Ok(byte)
    }

    pub(super) fn take_u32(&mut self, plane: usize) -> Result<u32, StreamError> {
        let mut bytes = [0; 4];
        for (byte, plane) in bytes.iter_mut().zip(plane..) {
            *byte = self.take(plane)?;
        }
        Ok(u32::from_le_bytes(bytes))
    }

    /// Checks that everything has been read.
    pub(super) fn check_end(&self) -> Result<(), StreamError> {
        for (plane, &read) in self.planes.iter().zip(&self.read) {
            if plane.len() != read {
                let (found, expected) = (plane.len() as u64, read as u64);
                return Err(StreamError::Block { block: self.block, what: "bytes", found, expected });
            }
        }
        Ok(())
    }

    /// Bytes before compression.
    pub(super) fn plain_bytes(&self) -> usize {
        self.planes.iter().map(Vec::len).sum()
    }

    /// The planes one after the other, each with its length before and after compression.
    pub(super) fn code(&self) -> Vec<u8> {
        let mut coded = Vec::new();
        for plane in &self.planes {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
            // Writing to memory does not fail; if it did, the plane would be stored.
            let deflated = encoder.write_all(plane).and_then(|()| encoder.finish());
            let shorter = deflated.ok().filter(|deflated| deflated.len() < plane.len());
            let bytes = shorter.as_ref().unwrap_or(plane);
            for len in [plane.len(), bytes.len()] {
                coded.extend_from_slice(&u32::try_from(len).unwrap_or(u32::MAX).to_le_bytes());
            }
            coded.extend_from_slice(bytes);
        }
        coded
    }

    /// The planes of a block. Takes at most about a thousand times the bytes, the limit of deflate.
    pub(super) fn decode(stride_bytes: usize, block: usize, mut coded: &[u8]) -> Result<Self, StreamError> {
        let mut planes = Self { block, ..Self::new(stride_bytes) };
        let wrong = |what, found: usize, expected: usize| StreamError::Block {
            block,
            what,
            found: found as u64,
            expected: expected as u64,
        };
        for plane in &mut planes.planes {
            let Some((head, rest)) = coded.split_first_chunk::<8>() else {
                return Err(wrong("bytes", coded.len(), 8));
            };
            let [plain_len, coded_len] = [0, 4]
                .map(|at| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]) as usize);
            let (Some(bytes), true) = (rest.get(..coded_len), coded_len <= plain_len) else {
                return Err(wrong("bytes", rest.len(), coded_len));
            };
            if coded_len == plain_len {
                plane.extend_from_slice(bytes);
            } else {
                let mut limited = DeflateDecoder::new(bytes).take(plain_len as u64 + 1);
                let is_read = limited.read_to_end(plane).is_ok();
                if !is_read || plane.len() != plain_len {
                    return Err(wrong("deflated bytes", plane.len(), plain_len));
                }
            }
            coded = &rest[coded_len..];
        }
        if coded.is_empty() { Ok(planes) } else { Err(wrong("bytes after its planes", coded.len(), 0)) }
    }
}

/// Difference of two floats, as a number that is small if they are close: their ranks in the order
/// of all floats, with the sign in the last bit.
pub(super) fn difference(value: f32, from: f32) -> u32 {
    let steps = place(value).wrapping_sub(place(from)).cast_signed();
    ((steps << 1) ^ (steps >> 31)).cast_unsigned()
}

/// The inverse of [`difference`].
pub(super) fn apply_difference(difference: u32, from: f32) -> f32 {
    let steps = (difference >> 1) ^ (difference & 1).wrapping_neg();
    let place = place(from).wrapping_add(steps);
    f32::from_bits(if place >> 31 == 0 { !place } else { place & 0x7fff_ffff })
}

/// Rank of a float in the order of all floats.
fn place(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 0x8000_0000 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn differences_are_undone(value in any::<u32>(), from in any::<u32>()) {
            let [value, from] = [value, from].map(f32::from_bits);
            prop_assert_eq!(apply_difference(difference(value, from), from).to_bits(), value.to_bits());
        }
    }

    #[test]
    fn neighbours_differ_by_little() {
        assert_eq!(difference(1.0_f32.next_up(), 1.0), 2);
        assert_eq!(difference(1.0_f32.next_down(), 1.0), 1);
        assert_eq!(difference(0.0, -0.0), 2);
    }
}
