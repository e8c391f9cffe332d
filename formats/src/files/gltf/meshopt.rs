//! Buffer views compressed by `EXT_meshopt_compression`, decoded without trust in a single byte.
//!
//! Reference: A. Kapoulkine: "EXT_meshopt_compression" (Khronos Group, glTF extensions), appendices
//! A (bitstream) and B (filters). The words of the code are those of the appendices.

use super::document::{Compression, Filter, Mode};
use crate::files::error::{MeshError, Place};

/// The most bytes that one compressed byte can stand for: a byte of headers holds 4 groups of 16.
pub(crate) const MOST_PER_BYTE: u64 = 64;

/// Decodes the bytes of a view.
///
/// # Errors
///
/// [`MeshError::Unexpected`] for bytes that are no such stream, [`MeshError::CountTooLarge`] for
/// more elements than they can hold.
pub(crate) fn decode(compressed: &[u8], layout: &Compression, place: Place) -> Result<Vec<u8>, MeshError> {
    let broken = |found: &str| MeshError::Unexpected {
        place,
        expected: "a stream of EXT_meshopt_compression",
        found: found.to_owned(),
    };
    let limit = (compressed.len() as u64).saturating_mul(MOST_PER_BYTE) / layout.byte_stride.max(1);
    if layout.count > limit {
        let (what, count) = ("compressed elements", layout.count);
        return Err(MeshError::CountTooLarge { place, what, count, limit });
    }
    // Both are at most the length of a slice times a small number.
    let [count, stride] =
        [layout.count, layout.byte_stride].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    let mut bytes = match layout.mode {
        Mode::Attributes if stride > 0 && stride <= 256 && stride.is_multiple_of(4) => {
            attributes(compressed, count, stride)
        }
        Mode::Triangles if matches!(stride, 2 | 4) => {
            triangles(compressed, count).map(|indices| packed(&indices, stride))
        }
        Mode::Indices if matches!(stride, 2 | 4) => {
            indices(compressed, count).map(|indices| packed(&indices, stride))
        }
        _ => return Err(broken(&format!("a stride of {stride} bytes"))),
    }
    .ok_or_else(|| broken("other bytes"))?;
    match (layout.filter, stride) {
        (Filter::None, _) => {}
        (Filter::Octahedral, 4) => bytes.chunks_exact_mut(4).for_each(octahedral_8),
        (Filter::Octahedral, 8) => bytes.chunks_exact_mut(8).for_each(octahedral_16),
        (Filter::Quaternion, 8) => bytes.chunks_exact_mut(8).for_each(quaternion),
        (Filter::Exponential, _) => bytes.chunks_exact_mut(4).for_each(exponential),
        _ => return Err(broken(&format!("a filter on a stride of {stride} bytes"))),
    }
    Ok(bytes)
}

/// Bytes read one after another.
struct Stream<'a>(&'a [u8]);

impl<'a> Stream<'a> {
    fn byte(&mut self) -> Option<u8> {
        let (&byte, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(byte)
    }

    fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(taken)
    }

    /// A number in groups of 7 bits, lowest first; at most 5 groups.
    fn varint(&mut self) -> Option<u32> {
        let mut value = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }
}

/// Mode 0: elements of `stride` bytes as deltas, each byte of the element in a data block of its
/// own.
fn attributes(compressed: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    const BLOCK_BYTES: usize = 8192;
    const TAIL_BYTES: usize = 32;
    let mut stream = Stream(compressed);
    if stream.byte()? != 0xa0 {
        return None;
    }
    // The baseline stands at the end, padded in front to 32 bytes.
    let n_tail = stride.max(TAIL_BYTES);
    let (blocks, tail) = stream.0.split_at_checked(stream.0.len().checked_sub(n_tail)?)?;
    let mut previous = tail[n_tail - stride..].to_vec();
    let mut stream = Stream(blocks);
    let mut bytes = vec![0; count.checked_mul(stride)?];
    let most = ((BLOCK_BYTES / stride) & !15).min(256);
    for block in bytes.chunks_mut(most * stride) {
        let n_elements = block.len() / stride;
        for (at, previous) in previous.iter_mut().enumerate() {
            let mut deltas = [0; 256];
            data_block(&mut stream, &mut deltas[..n_elements.next_multiple_of(16)])?;
            for (element, delta) in block.chunks_exact_mut(stride).zip(deltas) {
                *previous = previous.wrapping_add(unzigzag_8(delta));
                element[at] = *previous;
            }
        }
    }
    stream.0.is_empty().then_some(bytes)
}

/// The deltas of one byte in groups of 16: two bits of header for each group, then the groups.
fn data_block(stream: &mut Stream<'_>, deltas: &mut [u8]) -> Option<()> {
    let headers = stream.take((deltas.len() / 16).div_ceil(4))?;
    for (i, group) in deltas.chunks_exact_mut(16).enumerate() {
        match headers[i / 4] >> (2 * (i % 4)) & 3 {
            0 => group.fill(0),
            1 => sentinels(stream, group, 2)?,
            2 => sentinels(stream, group, 4)?,
            _ => group.copy_from_slice(stream.take(16)?),
        }
    }
    Some(())
}

/// Deltas of `n_bits` each, highest bits first; all ones stand for a byte behind the group.
fn sentinels(stream: &mut Stream<'_>, group: &mut [u8], n_bits: usize) -> Option<()> {
    let packed = stream.take(2 * n_bits)?;
    let sentinel = (1_u8 << n_bits) - 1;
    let per_byte = 8 / n_bits;
    for (i, delta) in group.iter_mut().enumerate() {
        let shift = 8 - n_bits * (i % per_byte + 1);
        let value = packed[i / per_byte] >> shift & sentinel;
        *delta = if value == sentinel { stream.byte()? } else { value };
    }
    Some(())
}

fn unzigzag_8(value: u8) -> u8 {
    if value & 1 != 0 { !(value >> 1) } else { value >> 1 }
}

fn unzigzag_32(value: u32) -> u32 {
    if value & 1 != 0 { !(value >> 1) } else { value >> 1 }
}

/// The last 16 things that were pushed; 0 is the newest.
#[derive(Default)]
struct Fifo<T> {
    entries: [T; 16],
    next: usize,
}

impl<T: Copy> Fifo<T> {
    fn push(&mut self, entry: T) {
        self.entries[self.next] = entry;
        self.next = (self.next + 1) % 16;
    }

    fn get(&self, back: u8) -> T {
        self.entries[(self.next + 15 - usize::from(back & 15)) % 16]
    }
}

/// What mode 1 remembers from triangle to triangle.
#[derive(Default)]
struct Triangles {
    next: u32,
    last: u32,
    edges: Fifo<[u32; 2]>,
    vertices: Fifo<u32>,
}

/// Mode 1: lists of triangles.
fn triangles(compressed: &[u8], n_indices: usize) -> Option<Vec<u32>> {
    const TABLE_BYTES: usize = 16;
    let mut stream = Stream(compressed);
    if stream.byte()? != 0xe1 || !n_indices.is_multiple_of(3) {
        return None;
    }
    let codes = stream.take(n_indices / 3)?;
    let (data, table) = stream.0.split_at_checked(stream.0.len().checked_sub(TABLE_BYTES)?)?;
    let mut data = Stream(data);
    let mut state = Triangles::default();
    let mut indices = Vec::with_capacity(n_indices);
    for &code in codes {
        indices.extend(state.triangle(code, table, &mut data)?);
    }
    data.0.is_empty().then_some(indices)
}

impl Triangles {
    fn triangle(&mut self, code: u8, table: &[u8], data: &mut Stream<'_>) -> Option<[u32; 3]> {
        if code < 0xf0 {
            return self.at_edge(code, data);
        }
        let (pair, has_own_indices) = match code {
            0xfe | 0xff => (data.byte()?, true),
            _ => (table[usize::from(code & 15)], false),
        };
        if has_own_indices && pair == 0 {
            self.next = 0;
        }
        let a = if code == 0xff { self.decode_index(data)? } else { self.next_vertex() };
        let mut corner = |this: &mut Self, nibble: u8| match nibble {
            0 => Some((this.next_vertex(), true)),
            15 if has_own_indices => Some((this.decode_index(data)?, true)),
            _ => Some((this.vertices.get(nibble - 1), false)),
        };
        let (b, is_new_b) = corner(self, pair >> 4)?;
        let (c, is_new_c) = corner(self, pair & 15)?;
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        self.vertices.push(a);
        if is_new_b {
            self.vertices.push(b);
        }
        if is_new_c {
            self.vertices.push(c);
        }
        Some([a, b, c])
    }

    /// A triangle at an edge of the last 16.
    fn at_edge(&mut self, code: u8, data: &mut Stream<'_>) -> Option<[u32; 3]> {
        let [a, b] = self.edges.get(code >> 4);
        let (c, is_new) = match code & 15 {
            0 => (self.next_vertex(), true),
            back @ 1..=12 => (self.vertices.get(back), false),
            13 => (self.last.wrapping_sub(1), true),
            14 => (self.last.wrapping_add(1), true),
            _ => (self.decode_index(data)?, true),
        };
        if matches!(code & 15, 13 | 14) {
            self.last = c;
        }
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        if is_new {
            self.vertices.push(c);
        }
        Some([a, b, c])
    }

    fn next_vertex(&mut self) -> u32 {
        let vertex = self.next;
        self.next = vertex.wrapping_add(1);
        vertex
    }

    fn decode_index(&mut self, data: &mut Stream<'_>) -> Option<u32> {
        self.last = self.last.wrapping_add(unzigzag_32(data.varint()?));
        Some(self.last)
    }
}

/// Mode 2: indices as differences to one of two baselines.
fn indices(compressed: &[u8], count: usize) -> Option<Vec<u32>> {
    const TAIL_BYTES: usize = 4;
    let mut stream = Stream(compressed);
    if stream.byte()? != 0xd1 {
        return None;
    }
    let (data, _) = stream.0.split_at_checked(stream.0.len().checked_sub(TAIL_BYTES)?)?;
    let mut data = Stream(data);
    let mut last = [0_u32; 2];
    let mut indices = Vec::with_capacity(count.min(data.0.len()));
    for _ in 0..count {
        let value = data.varint()?;
        let last = &mut last[(value & 1) as usize];
        *last = last.wrapping_add(unzigzag_32(value >> 1));
        indices.push(*last);
    }
    data.0.is_empty().then_some(indices)
}

/// Indices in 2 or 4 bytes each.
fn packed(indices: &[u32], stride: usize) -> Vec<u8> {
    indices.iter().flat_map(|index| index.to_le_bytes().into_iter().take(stride)).collect()
}

/// Filter 1 for bytes.
fn octahedral_8(element: &mut [u8]) {
    let [x, y, one] = [0, 1, 2].map(|i| f32::from(element[i].cast_signed()));
    let vector = from_octahedron([x, y], one);
    for (byte, value) in element.iter_mut().zip(vector) {
        *byte = to_i8(value * 127.0).cast_unsigned();
    }
}

/// Filter 1 for 16-bit numbers.
fn octahedral_16(element: &mut [u8]) {
    let [x, y, one] = [0, 2, 4].map(|at| f32::from(i16::from_le_bytes([element[at], element[at + 1]])));
    for (bytes, value) in element.chunks_exact_mut(2).zip(from_octahedron([x, y], one)) {
        bytes.copy_from_slice(&to_i16(value * 32767.0).to_le_bytes());
    }
}

/// The unit vector of a point on the octahedron whose corners are at distance `one`.
fn from_octahedron([x, y]: [f32; 2], one: f32) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let t = z.min(0.0);
    let (x, y) = (x - t.copysign(x), y - t.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

/// Filter 2.
fn quaternion(element: &mut [u8]) {
    let number = |at: usize| i16::from_le_bytes([element[at], element[at + 1]]);
    let one = f32::from(number(6) | 3);
    let largest = usize::from(element[6] & 3);
    let [x, y, z] = [0, 2, 4].map(|at| f32::from(number(at)) / one * std::f32::consts::FRAC_1_SQRT_2);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    for (i, value) in [w, x, y, z].into_iter().enumerate() {
        let at = 2 * ((largest + i) % 4);
        element[at..at + 2].copy_from_slice(&to_i16(value * 32767.0).to_le_bytes());
    }
}

/// Filter 3: an exponent of 8 bits above a mantissa of 24.
fn exponential(element: &mut [u8]) {
    let bits = i32::from_le_bytes([element[0], element[1], element[2], element[3]]);
    #[expect(clippy::cast_precision_loss, reason = "24 bits are exact in f32")]
    let mantissa = (bits << 8 >> 8) as f32;
    element.copy_from_slice(&(mantissa * 2.0_f32.powi(bits >> 24)).to_le_bytes());
}

#[expect(clippy::cast_possible_truncation, reason = "rounded, and such casts go to the nearest value")]
fn to_i8(value: f32) -> i8 {
    value.round() as i8
}

#[expect(clippy::cast_possible_truncation, reason = "rounded, and such casts go to the nearest value")]
fn to_i16(value: f32) -> i16 {
    value.round() as i16
}
