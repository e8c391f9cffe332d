//! Writing a stream.

use super::StreamError;
use super::decode::{
    ARRANGEMENTS, BLOCK_HEADER_BYTES, ESCAPE, FIRST_BLOCK, LARGEST_BLOCK, MOVES, StreamHeader,
};
use super::growth::{Growth, GrowthKind};
use super::plan::{Planned, plan};
use super::planes::{Planes, difference, plane};
use crate::decimate::progressive::journal::Trace;
use crate::flat::NO_INDEX;
use nephrite_formats::TriangleMesh;

/// A stream and its sizes.
///
/// ```
/// use nephrite::{BuildOptions, Encoded, ProgressiveOptions, build, generate};
/// let options = BuildOptions::with(ProgressiveOptions::default());
/// let Encoded { bytes, plain_bytes, .. } = build(generate::cosine(20), &options)?.operations()?;
/// assert!(bytes.len() < plain_bytes);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Encoded {
    /// The stream.
    pub bytes: Vec<u8>,
    /// Its length before compression.
    pub plain_bytes: usize,
    /// Operations.
    pub n_operations: usize,
    /// Vertices that ever appear.
    pub n_vertices: usize,
}

/// The operations that led from a mesh down as a stream; `mesh` is that of the history, with its
/// triangles. O(n) apart from compression, which takes most of the time.
///
/// # Errors
///
/// [`StreamError::Meaningless`] if stars of hundreds of thousands of triangles moved so often that
/// no reader would accept the stream.
pub(crate) fn encode(mesh: &TriangleMesh, trace: &Trace) -> Result<Encoded, StreamError> {
    let mut writer = Writer::new(mesh);
    let planned = plan(mesh, trace);
    let mut n_in_block = 0;
    let mut block_len = FIRST_BLOCK;
    for operation in &planned {
        n_in_block += writer.put(operation);
        // No reader would accept it.
        if !writer.growth.may_move(0) {
            let operation = writer.growth.operations.len();
            return Err(StreamError::Meaningless { operation, what: MOVES });
        }
        if n_in_block >= block_len {
            writer.end_block(n_in_block);
            (n_in_block, block_len) = (0, (2 * block_len).min(LARGEST_BLOCK));
        }
    }
    writer.end_block(n_in_block);
    Ok(writer.finish())
}

struct Writer<'a> {
    mesh: &'a TriangleMesh,
    stride_bytes: usize,
    growth: Growth,
    /// Number of each vertex and slot, in the order of growth.
    number: Vec<u32>,
    triangle: Vec<u32>,
    /// Vertex of the mesh for each number.
    vertices: Vec<u32>,
    planes: Planes,
    link: Vec<u32>,
    bytes: Vec<u8>,
    plain_bytes: usize,
}

impl<'a> Writer<'a> {
    fn new(mesh: &'a TriangleMesh) -> Self {
        let stride_bytes = mesh.attributes.iter().map(nephrite_formats::Attribute::stride_bytes).sum();
        Self {
            mesh,
            stride_bytes,
            growth: Growth::default(),
            number: vec![NO_INDEX; mesh.positions.len()],
            triangle: vec![NO_INDEX; mesh.triangles.len()],
            vertices: Vec::new(),
            planes: Planes::new(stride_bytes),
            link: Vec::new(),
            bytes: vec![0; StreamHeader::BYTES],
            plain_bytes: StreamHeader::BYTES,
        }
    }

    /// Writes an operation; returns how many operations of the stream it took.
    fn put(&mut self, planned: &Planned) -> usize {
        match planned {
            &Planned::VertexMerge { vertex, beside } => {
                self.put_merge(vertex, beside);
                1
            }
            &Planned::Triangle { slot, corners } => {
                self.put_triangle(slot, corners);
                1
            }
            // A vertex that does not exist yet has no star to split: its triangles are written one
            // by one.
            Planned::EdgeSplit { beside, born, .. } if self.number[*beside as usize] == NO_INDEX => {
                born.iter().for_each(|&(slot, corners)| self.put_triangle(slot, corners));
                born.len()
            }
            Planned::EdgeSplit { vertex, beside, moved, born } => {
                self.put_edge_split([*vertex, *beside], moved, born);
                1
            }
        }
    }

    fn put_merge(&mut self, vertex: u32, beside: u32) {
        self.planes.put(plane::KINDS, kind_byte(GrowthKind::VertexMerge, 0));
        let [vertex, beside] = [vertex, beside].map(|v| self.number[v as usize]);
        self.planes.put_u32(plane::VERTICES, beside);
        self.planes.put_u32(plane::VERTICES, vertex);
        self.growth.vertex_merge(vertex, beside);
    }

    fn put_triangle(&mut self, slot: u32, corners: [u32; 3]) {
        self.planes.put(plane::KINDS, kind_byte(GrowthKind::Triangle, 0));
        let n_before = self.vertices.len();
        for v in corners {
            self.put_vertex_or_new(v, self.vertices.len().saturating_sub(1));
        }
        self.triangle[slot as usize] = count(self.growth.born.len());
        let numbers = corners.map(|v| self.number[v as usize]);
        self.growth.triangle(numbers, count(self.vertices.len() - n_before));
    }

    fn put_edge_split(&mut self, [vertex, beside]: [u32; 2], moved: &[u32], born: &[(u32, [u32; 3])]) {
        let n_before = self.vertices.len();
        let origin = self.number[beside as usize];
        let n_born = u8::try_from(born.len()).unwrap_or(u8::MAX);
        self.planes.put(plane::KINDS, kind_byte(GrowthKind::EdgeSplit, n_born));
        self.planes.put_u32(plane::VERTICES, count(n_before) - 1 - origin);
        let mut moved: Vec<u32> = moved.iter().map(|&slot| self.triangle[slot as usize]).collect();
        moved.sort_unstable();
        let star = self.growth.star(origin).to_vec();
        for part in star.chunks(8) {
            let bits = part.iter().zip(0..).fold(0, |bits, (triangle, bit)| {
                bits | u8::from(moved.binary_search(triangle).is_ok()) << bit
            });
            self.planes.put(plane::MASKS, bits);
        }
        // In the order of the star, in which the reader finds them.
        let moved: Vec<u32> =
            star.into_iter().filter(|triangle| moved.binary_search(triangle).is_ok()).collect();
        self.put_new(vertex, origin as usize);
        let mut link = std::mem::take(&mut self.link);
        self.growth.link(origin, &mut link);
        let mut numbers = Vec::with_capacity(born.len());
        for (at, &(slot, corners)) in born.iter().enumerate() {
            let third = corners.into_iter().find(|&v| v != vertex && v != beside).unwrap_or(vertex);
            let place = link.iter().position(|&v| v == self.number[third as usize]);
            match place.and_then(|place| u8::try_from(place).ok()).filter(|&place| place != ESCAPE) {
                Some(place) => self.planes.put(plane::LINKS, place),
                None => {
                    self.planes.put(plane::LINKS, ESCAPE);
                    self.put_vertex_or_new(third, n_before);
                }
            }
            let ends = [vertex, beside, third];
            let is_this = |order: &[usize; 3]| order.map(|i| ends[i]) == corners;
            let order = ARRANGEMENTS.iter().position(is_this).unwrap_or_default();
            self.planes.put(plane::ORDERS, u8::try_from(order).unwrap_or_default());
            self.triangle[slot as usize] = count(self.growth.born.len() + at);
            numbers.push(corners.map(|v| self.number[v as usize]));
        }
        self.link = link;
        self.growth.edge_split(origin, &moved, &numbers, count(self.vertices.len() - n_before));
    }

    /// Writes the number of a vertex. A new vertex gets the next number and is described.
    fn put_vertex_or_new(&mut self, vertex: u32, near: usize) {
        let number = self.number[vertex as usize];
        if number == NO_INDEX {
            self.planes.put_u32(plane::VERTICES, count(self.vertices.len()));
            self.put_new(vertex, near);
        } else {
            self.planes.put_u32(plane::VERTICES, number);
        }
    }

    /// Numbers a vertex and writes how its position and attributes differ from those of a vertex
    /// that has a number.
    fn put_new(&mut self, vertex: u32, near: usize) {
        self.number[vertex as usize] = count(self.vertices.len());
        let near = self.vertices.get(near).map(|&near| near as usize);
        let from = near.map_or([0.0; 3], |near| self.mesh.positions[near]);
        for (value, from) in self.mesh.positions[vertex as usize].into_iter().zip(from) {
            self.planes.put_u32(plane::COORDINATES, difference(value, from));
        }
        let mut plane = plane::ATTRIBUTES;
        for attribute in &self.mesh.attributes {
            let stride = attribute.stride_bytes();
            let bytes = &attribute.bytes[vertex as usize * stride..][..stride];
            for (i, byte) in bytes.iter().enumerate() {
                let from = near.map_or(0, |near| attribute.bytes[near * stride + i]);
                self.planes.put(plane, byte.wrapping_sub(from));
                plane += 1;
            }
        }
        self.vertices.push(vertex);
    }

    fn end_block(&mut self, n_operations: usize) {
        if n_operations == 0 {
            return;
        }
        let planes = std::mem::replace(&mut self.planes, Planes::new(self.stride_bytes));
        let coded = planes.code();
        self.plain_bytes += planes.plain_bytes() + BLOCK_HEADER_BYTES;
        let checksum = super::decode::checksum(&coded);
        for field in [count(n_operations), count(coded.len()), checksum] {
            self.bytes.extend_from_slice(&field.to_le_bytes());
        }
        self.bytes.extend_from_slice(&coded);
    }

    fn finish(mut self) -> Encoded {
        let header = StreamHeader {
            stride_bytes: count(self.stride_bytes),
            n_operations: self.growth.operations.len() as u64,
        };
        self.bytes[..StreamHeader::BYTES].copy_from_slice(&header.to_bytes());
        Encoded {
            bytes: self.bytes,
            plain_bytes: self.plain_bytes,
            n_operations: self.growth.operations.len(),
            n_vertices: self.vertices.len(),
        }
    }
}

/// GrowthKind in the two lowest bits, number of new triangles above.
fn kind_byte(kind: GrowthKind, n_born: u8) -> u8 {
    let kind = match kind {
        GrowthKind::EdgeSplit => 0,
        GrowthKind::VertexMerge => 1,
        GrowthKind::Triangle => 2,
    };
    kind | n_born << 2
}

#[expect(clippy::cast_possible_truncation, reason = "vertices, slots and operations of a build are u32")]
fn count(len: usize) -> u32 {
    len as u32
}
