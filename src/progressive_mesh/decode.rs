//! Reads a stream, block by block. Whatever the bytes, a block is taken as far as its operations
//! are valid, up to the first that is not.

use super::StreamError;
use super::growth::Growth;
use super::planes::{Planes, apply_difference, plane};
use nephrite_formats::neph;

/// First four bytes of a stream.
const MAGIC: u32 = 0x3153_504e;
/// Operations of the first block. Each block has twice as many as the one before, so that something
/// is visible early.
pub(super) const FIRST_BLOCK: usize = 256;
/// Most operations of a block, unless its last one takes several steps.
pub(super) const LARGEST_BLOCK: usize = 1 << 14;
/// Bytes of the number of operations, the length and the checksum.
pub(super) const BLOCK_HEADER_BYTES: usize = 12;
/// Link of a corner that is not among the neighbours.
pub(super) const ESCAPE: u8 = u8::MAX;
/// Orders of the new vertex, the old one and the third corner.
pub(super) const ARRANGEMENTS: [[usize; 3]; 6] =
    [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]];
/// Most bytes of attributes per vertex: more than any file has, and few enough for a plane per
/// byte.
const MAX_STRIDE_BYTES: u32 = 1 << 14;

/// The beginning of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct StreamHeader {
    pub(super) stride_bytes: u32,
    pub(super) n_operations: u64,
}

impl StreamHeader {
    pub(super) const BYTES: usize = 16;

    pub(super) fn to_bytes(self) -> [u8; Self::BYTES] {
        let mut bytes = [0; Self::BYTES];
        bytes[..4].copy_from_slice(&MAGIC.to_le_bytes());
        bytes[4..8].copy_from_slice(&self.stride_bytes.to_le_bytes());
        bytes[8..].copy_from_slice(&self.n_operations.to_le_bytes());
        bytes
    }

    fn from_bytes(bytes: &[u8; Self::BYTES]) -> Result<Self, StreamError> {
        let found = u32_at(bytes, 0);
        if found != MAGIC {
            return Err(StreamError::Magic { found, expected: MAGIC });
        }
        let stride_bytes = u32_at(bytes, 4);
        if stride_bytes > MAX_STRIDE_BYTES {
            let (found, expected) = (u64::from(stride_bytes), u64::from(MAX_STRIDE_BYTES));
            return Err(StreamError::Block { block: 0, what: "attribute bytes", found, expected });
        }
        let n_operations = u64::from(u32_at(bytes, 8)) | u64::from(u32_at(bytes, 12)) << 32;
        Ok(Self { stride_bytes, n_operations })
    }
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..).and_then(|bytes| bytes.first_chunk()).map_or(0, |&bytes| u32::from_le_bytes(bytes))
}

/// Checksum of a block's coded bytes: the lower half of XXH3.
#[expect(clippy::cast_possible_truncation, reason = "half of it is meant")]
pub(super) fn checksum(coded: &[u8]) -> u32 {
    neph::checksum(coded) as u32
}

/// What [`Growth::may_move`] limits.
pub(super) const MOVES: &str = "triangles move from star to star without end";

/// Everything that has been read.
#[derive(Clone, Debug, Default)]
pub(super) struct Decoder {
    pub(super) header: Option<StreamHeader>,
    pub(super) growth: Growth,
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) attributes: Vec<u8>,
    n_blocks: usize,
    link: Vec<u32>,
}

impl Decoder {
    /// Reads the header or one block from the front; returns its length, or 0 if it is not complete
    /// yet.
    pub(super) fn read(&mut self, bytes: &[u8]) -> Result<usize, StreamError> {
        let Some(header) = self.header else {
            let Some(bytes) = bytes.first_chunk() else { return Ok(0) };
            self.header = Some(StreamHeader::from_bytes(bytes)?);
            return Ok(StreamHeader::BYTES);
        };
        if bytes.len() < BLOCK_HEADER_BYTES {
            return Ok(0);
        }
        let [n_operations, coded_len, expected] = [0, 4, 8].map(|at| u32_at(bytes, at));
        let block = self.n_blocks;
        let left = header.n_operations.saturating_sub(self.growth.operations.len() as u64);
        if u64::from(n_operations) > left || n_operations == 0 {
            let found = u64::from(n_operations);
            return Err(StreamError::Block { block, what: "operations", found, expected: left });
        }
        let end = BLOCK_HEADER_BYTES + coded_len as usize;
        let Some(coded) = bytes.get(BLOCK_HEADER_BYTES..end) else { return Ok(0) };
        let found = checksum(coded);
        if found != expected {
            return Err(StreamError::Checksum { block, found, expected });
        }
        let mut planes = Planes::decode(header.stride_bytes as usize, block, coded)?;
        for _ in 0..n_operations {
            self.take_operation(&mut planes)?;
        }
        planes.check_end()?;
        self.n_blocks += 1;
        Ok(end)
    }

    fn take_operation(&mut self, planes: &mut Planes) -> Result<(), StreamError> {
        let byte = planes.take(plane::KINDS)?;
        match byte & 3 {
            0 => self.take_edge_split(planes, byte >> 2),
            1 => {
                let [beside, vertex] = [self.take_vertex(planes)?, self.take_vertex(planes)?];
                let shared = |&triangle: &u32| self.growth.corners(triangle).contains(&beside);
                if vertex == beside || self.growth.star(vertex).iter().any(shared) {
                    return Err(self.meaningless("a triangle that has a corner twice"));
                }
                if !self.growth.may_move(self.growth.star(vertex).len()) {
                    return Err(self.meaningless(MOVES));
                }
                self.growth.vertex_merge(vertex, beside);
                Ok(())
            }
            2 => self.take_triangle(planes),
            kind => Err(self.name("kind", kind.into(), 3)),
        }
    }

    fn take_triangle(&mut self, planes: &mut Planes) -> Result<(), StreamError> {
        let n_before = self.positions.len();
        let mut corners = [0; 3];
        let result = corners.iter_mut().try_for_each(|corner| {
            let near = self.positions.len().saturating_sub(1);
            *corner = self.take_vertex_or_new(planes, near)?;
            Ok(())
        });
        let [a, b, c] = corners;
        let result = result.and_then(|()| {
            if a != b && b != c && c != a {
                Ok(())
            } else {
                Err(self.meaningless("a triangle that has a corner twice"))
            }
        });
        self.undo_unless(result, n_before)?;
        self.growth.triangle(corners, count(self.positions.len() - n_before));
        Ok(())
    }

    fn take_edge_split(&mut self, planes: &mut Planes, n_born: u8) -> Result<(), StreamError> {
        let n_before = self.positions.len();
        let back = planes.take_u32(plane::VERTICES)?;
        let origin = count(n_before).checked_sub(1).and_then(|last| last.checked_sub(back));
        let origin = origin.ok_or_else(|| self.name("vertex", back.into(), n_before as u64))?;
        let star = self.growth.star(origin);
        let mut moved = Vec::with_capacity(star.len());
        for part in star.chunks(8) {
            let bits = planes.take(plane::MASKS)?;
            moved.extend(
                part.iter().zip(0..).filter(|&(_, bit)| bits >> bit & 1 == 1).map(|(&triangle, _)| triangle),
            );
        }
        if !self.growth.may_move(moved.len()) {
            return Err(self.meaningless(MOVES));
        }
        let mut link = std::mem::take(&mut self.link);
        self.growth.link(origin, &mut link);
        let mut born = Vec::with_capacity(n_born.into());
        let result = self.take_new(planes, origin as usize).and_then(|vertex| {
            for _ in 0..n_born {
                let place = planes.take(plane::LINKS)?;
                let third = match link.get(usize::from(place)) {
                    _ if place == ESCAPE => self.take_vertex_or_new(planes, n_before)?,
                    Some(&third) => third,
                    None => return Err(self.name("neighbour", place.into(), link.len() as u64)),
                };
                let order = planes.take(plane::ORDERS)?;
                let Some(order) = ARRANGEMENTS.get(usize::from(order)) else {
                    return Err(self.name("order", order.into(), 6));
                };
                if third == vertex || third == origin {
                    return Err(self.meaningless("a triangle that has a corner twice"));
                }
                born.push(order.map(|i| [vertex, origin, third][i]));
            }
            Ok(())
        });
        self.link = link;
        self.undo_unless(result, n_before)?;
        self.growth.edge_split(origin, &moved, &born, count(self.positions.len() - n_before));
        Ok(())
    }

    /// Reads the number of a vertex that exists.
    fn take_vertex(&self, planes: &mut Planes) -> Result<u32, StreamError> {
        let vertex = planes.take_u32(plane::VERTICES)?;
        let n_there = self.positions.len();
        if (vertex as usize) < n_there {
            Ok(vertex)
        } else {
            Err(self.name("vertex", vertex.into(), n_there as u64))
        }
    }

    fn take_vertex_or_new(&mut self, planes: &mut Planes, near: usize) -> Result<u32, StreamError> {
        let vertex = planes.take_u32(plane::VERTICES)?;
        let n_there = self.positions.len();
        match (vertex as usize).cmp(&n_there) {
            std::cmp::Ordering::Less => Ok(vertex),
            std::cmp::Ordering::Equal => self.take_new(planes, near),
            std::cmp::Ordering::Greater => Err(self.name("vertex", vertex.into(), n_there as u64)),
        }
    }

    /// Reads a new vertex and returns its number.
    fn take_new(&mut self, planes: &mut Planes, near: usize) -> Result<u32, StreamError> {
        let number = self.positions.len();
        let stride = self.header.map_or(0, |header| header.stride_bytes as usize);
        let from = self.positions.get(near).copied().unwrap_or_default();
        let mut position = [0.0; 3];
        for (value, from) in position.iter_mut().zip(from) {
            *value = apply_difference(planes.take_u32(plane::COORDINATES)?, from);
        }
        if !position.iter().all(|value| value.is_finite()) {
            return Err(self.meaningless("a position that is not finite"));
        }
        let start = self.attributes.len();
        for i in 0..stride {
            let from = if near < number { self.attributes[near * stride + i] } else { 0 };
            match planes.take(plane::ATTRIBUTES + i) {
                Ok(byte) => self.attributes.push(byte.wrapping_add(from)),
                Err(error) => {
                    self.attributes.truncate(start);
                    return Err(error);
                }
            }
        }
        self.positions.push(position);
        Ok(count(number))
    }

    /// Removes the vertices of an operation that failed.
    fn undo_unless(&mut self, result: Result<(), StreamError>, n_vertices: usize) -> Result<(), StreamError> {
        if result.is_err() {
            self.positions.truncate(n_vertices);
            let stride = self.header.map_or(0, |header| header.stride_bytes as usize);
            self.attributes.truncate(n_vertices * stride);
        }
        result
    }

    fn name(&self, what: &'static str, found: u64, n_there: u64) -> StreamError {
        StreamError::Name { operation: self.growth.operations.len(), what, found, n_there }
    }

    fn meaningless(&self, what: &'static str) -> StreamError {
        StreamError::Meaningless { operation: self.growth.operations.len(), what }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "each vertex takes bytes of a stream, which is shorter than 2^32 of them"
)]
fn count(len: usize) -> u32 {
    len as u32
}
