//! A mesh as a stream of operations: from nothing to the full input and back, by any number of
//! operations at a time.
//!
//! The operations of the progressive decimator, played backwards, build its input up from an empty
//! mesh (W. J. Schroeder, "A topology modifying progressive decimation algorithm", 1997, sections
//! 3.3 and 4.7; H. Hoppe, "Progressive meshes", SIGGRAPH 1996). An edge split makes a vertex beside
//! an old one, gives it some triangles of the old one, and makes new triangles between the two. A
//! vertex merge joins two vertices at the same position. A first triangle appears by itself.
//! Vertices and triangles are numbered as they appear, so a split need not name its own vertex.
//!
//! The naive player searches for the triangles that an operation moves. Here they are found once,
//! when the stream is [read](ProgressiveMesh::append), and playing only copies numbers.

mod decode;
#[cfg(feature = "build")]
mod encode;
mod error;
mod growth;
#[cfg(feature = "build")]
mod plan;
mod planes;

#[cfg(feature = "build")]
pub use encode::Encoded;
#[cfg(feature = "build")]
pub(crate) use encode::encode;
pub use error::StreamError;

use decode::{Decoder, StreamHeader};
use growth::{Growth, GrowthKind, GrowthStep};

/// Length of the header of a stream, before its first block.
pub const STREAM_HEADER_BYTES: usize = StreamHeader::BYTES;

/// A mesh that grows and shrinks by single operations.
///
/// Bytes may be [appended](Self::append) as they arrive; operations of whole blocks can be played
/// at once, and the mesh is valid after every single one. Memory: some 70 bytes per vertex of the
/// full mesh.
///
/// ```
/// use nephrite::ProgressiveOptions;
/// use nephrite::ProgressiveMesh;
/// use nephrite::{BuildOptions, build, generate};
/// let build = build(&generate::torus(16, 8), &BuildOptions::with(ProgressiveOptions::default()))?;
/// let encoded = build.operations()?;
/// let mut mesh = ProgressiveMesh::from_bytes(&encoded.bytes)?;
/// assert_eq!(mesh.triangles().len(), 0);
/// mesh.refine(usize::MAX);
/// assert_eq!(mesh.triangles().len(), 256);
/// mesh.seek(100);
/// assert!((99..=100).contains(&mesh.triangles().len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ProgressiveMesh {
    decoder: Decoder,
    /// Bytes of a block that is not complete yet.
    pending: Vec<u8>,
    /// Operations played.
    position: usize,
    triangles: Vec<[u32; 3]>,
    n_vertices: usize,
}

impl ProgressiveMesh {
    /// An empty mesh, for a stream whose bytes are still to come.
    pub fn new() -> Self {
        Self::default()
    }

    /// The mesh of a stream, or of the beginning of one, with nothing played yet.
    ///
    /// # Errors
    ///
    /// [`StreamError`] for bytes that are not a stream, or are damaged. A stream that ends early is
    /// not an error; see [`is_whole`](Self::is_whole).
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, StreamError> {
        let mut mesh = Self::new();
        mesh.append(bytes)?;
        Ok(mesh)
    }

    /// Takes more bytes of the stream; returns the number of operations that can be played now.
    /// What was read before an error stays.
    ///
    /// # Errors
    ///
    /// [`StreamError`] for bytes that are not a stream, or are damaged.
    pub fn append(&mut self, bytes: &[u8]) -> Result<usize, StreamError> {
        self.pending.extend_from_slice(bytes);
        let mut read = 0;
        let result = loop {
            match self.decoder.read(&self.pending[read..]) {
                Ok(0) => break Ok(()),
                Ok(n_bytes) => read += n_bytes,
                Err(error) => break Err(error),
            }
        };
        self.pending.drain(..read);
        result.map(|()| self.n_operations())
    }

    /// Whether the whole stream has been read.
    pub fn is_whole(&self) -> bool {
        self.decoder.header.is_some_and(|header| header.n_operations == self.n_operations() as u64)
    }

    /// Operations that have been read.
    pub fn n_operations(&self) -> usize {
        self.growth().operations.len()
    }

    /// Operations that the header announces; 0 before the header has been read.
    pub fn n_announced(&self) -> u64 {
        self.decoder.header.map_or(0, |header| header.n_operations)
    }

    /// Operations that have been played.
    pub fn position(&self) -> usize {
        self.position
    }

    /// Plays up to `n` operations towards the full mesh; returns how many were played. O(triangles
    /// changed).
    pub fn refine(&mut self, n: usize) -> usize {
        let end = self.position.saturating_add(n).min(self.n_operations());
        let Growth { operations, moved, born, .. } = &self.decoder.growth;
        for operation in &operations[self.position..end] {
            let GrowthStep { kind, vertex, beside, .. } = *operation;
            let (from, to) = match kind {
                GrowthKind::EdgeSplit | GrowthKind::Triangle => (beside, vertex),
                GrowthKind::VertexMerge => (vertex, beside),
            };
            rename(&mut self.triangles, &moved[operation.moved_range()], from, to);
            let start = self.triangles.len();
            self.triangles.extend_from_slice(&born[start..start + operation.n_triangles as usize]);
            self.n_vertices += operation.n_vertices as usize;
        }
        std::mem::replace(&mut self.position, end).abs_diff(end)
    }

    /// Undoes up to `n` operations; returns how many were undone. O(triangles changed).
    pub fn coarsen(&mut self, n: usize) -> usize {
        let start = self.position.saturating_sub(n);
        let Growth { operations, moved, .. } = &self.decoder.growth;
        for operation in operations[start..self.position].iter().rev() {
            let GrowthStep { kind, vertex, beside, .. } = *operation;
            let (from, to) = match kind {
                GrowthKind::EdgeSplit | GrowthKind::Triangle => (vertex, beside),
                GrowthKind::VertexMerge => (beside, vertex),
            };
            self.triangles.truncate(self.triangles.len() - operation.n_triangles as usize);
            rename(&mut self.triangles, &moved[operation.moved_range()], from, to);
            self.n_vertices -= operation.n_vertices as usize;
        }
        std::mem::replace(&mut self.position, start).abs_diff(start)
    }

    /// Plays to the largest mesh of at most `n` triangles that the operations read so far give;
    /// returns its number of triangles.
    pub fn seek(&mut self, n: usize) -> usize {
        let position = self.growth().n_triangles.partition_point(|&count| count as usize <= n);
        if position >= self.position {
            self.refine(position - self.position);
        } else {
            self.coarsen(self.position - position);
        }
        self.triangles.len()
    }

    /// The triangles of the current mesh, over [`positions`](Self::positions).
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Positions of all vertices that have appeared. Vertices that have been merged into others are
    /// in no triangle.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.decoder.positions[..self.n_vertices]
    }

    /// Attribute values of these vertices, in the order of the attribute table of the file:
    /// [`stride_bytes`](Self::stride_bytes) for each.
    pub fn attribute_bytes(&self) -> &[u8] {
        &self.decoder.attributes[..self.n_vertices * self.stride_bytes()]
    }

    /// Bytes of all attributes of one vertex.
    pub fn stride_bytes(&self) -> usize {
        self.decoder.header.map_or(0, |header| header.stride_bytes as usize)
    }

    fn growth(&self) -> &Growth {
        &self.decoder.growth
    }
}

/// Gives these triangles the corner `to` instead of `from`.
fn rename(triangles: &mut [[u32; 3]], moved: &[u32], from: u32, to: u32) {
    for &triangle in moved {
        for corner in &mut triangles[triangle as usize] {
            if *corner == from {
                *corner = to;
            }
        }
    }
}
