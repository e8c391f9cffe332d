//! An opened file: its bytes, and the sections that its checked head describes.

use super::compact::{CompactSections, Expanded, Narrow};
use super::memory::{Memory, OwnedBytes};
use super::{Metadata, OpenError};
use crate::tree::{Run, Tree};
use bytemuck::Pod;
use nephrite_formats::ScalarType;
use nephrite_formats::neph::{
    AttributeEntry, Directory, Header, MAX_HEAD_BYTES, SectionKind, read_attributes,
};
use std::ops::Range;
use std::path::Path;

/// A file whose head is in order. Sections have the lengths that the header's counts give; what is
/// in them has not been looked at, unless [`verify`](Self::verify) was called.
pub struct Opened {
    memory: Memory,
    directory: Directory,
    attributes: Vec<AttributeEntry>,
    /// The slots of a file that holds them in the compact form.
    expanded: Option<Expanded>,
}

/// A per-vertex attribute of an opened file.
///
/// ```no_run
/// use nephrite::{AttributeView, Lod};
/// let lod = Lod::open("bunny.neph")?;
/// let colors: Option<AttributeView> = lod.attributes().find(|attribute| attribute.name == "color");
/// assert!(colors.is_none_or(|colors| colors.bytes.len() == lod.vertices().len() * colors.stride_bytes()));
/// # Ok::<(), nephrite::OpenError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AttributeView<'a> {
    /// Its name.
    pub name: &'a str,
    /// Type of one component.
    pub scalar: ScalarType,
    /// Components per vertex, at least 1.
    pub n_components: u32,
    /// Little-endian values, `n_vertices * stride_bytes()` bytes. They begin at a multiple of 64 in
    /// the file.
    pub bytes: &'a [u8],
}

impl AttributeView<'_> {
    /// Bytes that one vertex takes.
    pub fn stride_bytes(&self) -> usize {
        self.n_components as usize * self.scalar.size_bytes()
    }
}

impl Opened {
    /// Reads a file into memory and checks its head.
    ///
    /// # Errors
    ///
    /// [`OpenError`] when the system refuses or the head of the file is not in order.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        Self::new(Memory::Owned(OwnedBytes::read(path.as_ref())?))
    }

    /// Copies the bytes of a file and checks its head.
    ///
    /// # Errors
    ///
    /// [`OpenError::Format`] when the head is not in order, [`OpenError::OutOfMemory`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, OpenError> {
        Self::new(Memory::Owned(OwnedBytes::copy_of(bytes)?))
    }

    /// Checks the head of a file that lies in memory, and copies the file only if its records would
    /// not be aligned.
    ///
    /// # Errors
    ///
    /// As [`from_bytes`](Self::from_bytes).
    pub fn from_owner(owner: impl AsRef<[u8]> + Send + Sync + 'static) -> Result<Self, OpenError> {
        Self::new(Memory::shared(owner)?)
    }

    /// Touches the first 16 KiB and the attribute table, and the slots where they are in the
    /// compact form.
    pub(super) fn new(memory: Memory) -> Result<Self, OpenError> {
        let bytes = memory.bytes();
        let head = &bytes[..bytes.len().min(MAX_HEAD_BYTES)];
        let directory = Directory::read(head, bytes.len() as u64)?;
        let mut opened = Self { memory, directory, attributes: Vec::new(), expanded: None };
        opened.attributes = read_attributes(
            opened.section(SectionKind::AttributeTable),
            opened.section(SectionKind::AttributeNames),
            opened.header().n_vertices,
            opened.directory.section(SectionKind::AttributeValues).1,
        )?;
        opened.expanded = opened.compact_sections().map(CompactSections::expand).transpose()?;
        Ok(opened)
    }

    /// The header.
    pub fn header(&self) -> &Header {
        self.directory.header()
    }

    /// The checked head.
    pub fn directory(&self) -> &Directory {
        &self.directory
    }

    /// The whole file.
    pub fn bytes(&self) -> &[u8] {
        self.memory.bytes()
    }

    /// Operations from nothing to the input, for
    /// [`ProgressiveMesh`](crate::progressive_mesh::ProgressiveMesh); empty where the file has
    /// none.
    pub fn operations(&self) -> &[u8] {
        self.section(SectionKind::Operations)
    }

    /// Error of each level.
    pub fn errors(&self) -> &[f64] {
        self.section(SectionKind::Errors)
    }

    /// Simplices alive at each level, as the file states them.
    pub fn simplex_counts(&self) -> &[u32] {
        self.section(SectionKind::SimplexCounts)
    }

    /// Vertices that die after each level, as the file states them: a prefix that holds the
    /// vertices of the level.
    pub fn vertex_counts(&self) -> &[u32] {
        self.section(SectionKind::VertexCounts)
    }

    /// First level that has each vertex; empty where level 0 has them all.
    pub fn vertex_births(&self) -> &[u32] {
        self.section(SectionKind::VertexBirths)
    }

    /// What the levels state beside their errors: each with its name, a number per level. As many
    /// as there are both names and numbers for.
    pub fn deviations(&self) -> impl Iterator<Item = (&str, &[f64])> {
        let names: &[u8] = self.section(SectionKind::DeviationNames);
        let values: &[f64] = self.section(SectionKind::Deviations);
        let names = names.split(|&byte| byte == 0).map(|name| std::str::from_utf8(name).unwrap_or_default());
        names.zip(values.chunks_exact(self.header().n_levels.max(1) as usize))
    }

    /// Positions of all vertices.
    pub fn positions(&self) -> &[[f32; 3]] {
        self.section(SectionKind::Positions)
    }

    /// Vertex indices of all slots, `n_corners` each.
    pub fn simplices(&self) -> &[u32] {
        match &self.expanded {
            Some(expanded) => &expanded.simplices,
            None => self.section(SectionKind::Simplices),
        }
    }

    /// The stamp of each slot that its place does not give.
    pub fn stamps(&self) -> &[u32] {
        match &self.expanded {
            Some(expanded) => &expanded.stamps,
            None => self.section(SectionKind::Stamps),
        }
    }

    /// The slots in the compact form, if that is the file's.
    pub(super) fn compact_sections(&self) -> Option<CompactSections<'_>> {
        let header = self.header();
        self.directory.is_compact().then(|| CompactSections {
            n_corners: header.n_corners as usize,
            // The head was refused if the slots exceeded 32 bits.
            n_slots: usize::try_from(header.n_slots).unwrap_or(0),
            distinct: Narrow::indices(self.section(SectionKind::DistinctSimplices), header.n_vertices),
            repeat_bits: self.section(SectionKind::RepeatBits),
            repeat_sources: self.section(SectionKind::RepeatSources),
            stamps: Narrow::stamps(self.section(SectionKind::CompactStamps), header.n_levels),
        })
    }

    /// The interval tree.
    pub fn tree(&self) -> Tree<'_> {
        let runs: &[Run] = self.section(SectionKind::Runs);
        // The head was refused if the slots exceeded 32 bits.
        let n_slots = u32::try_from(self.header().n_slots).unwrap_or(0);
        Tree::new(self.section(SectionKind::RunOffsets), runs, n_slots)
    }

    /// The attributes.
    pub fn attributes(&self) -> impl ExactSizeIterator<Item = AttributeView<'_>> {
        let values: &[u8] = self.section(SectionKind::AttributeValues);
        self.attributes.iter().map(move |entry| AttributeView {
            name: &entry.name,
            scalar: entry.scalar,
            n_components: entry.n_components,
            bytes: usize_range(entry.values.clone()).and_then(|range| values.get(range)).unwrap_or(&[]),
        })
    }

    /// Reads the metadata.
    ///
    /// # Errors
    ///
    /// If the section is not a JSON object of the known shape.
    pub fn metadata(&self) -> Result<Metadata, serde_json::Error> {
        serde_json::from_slice(self.section(SectionKind::Metadata))
    }

    /// The records of a section; empty for an optional section that is not there.
    ///
    /// The checked head guarantees range, alignment and a whole number of records, so neither
    /// fallback is ever taken.
    fn section<T: Pod>(&self, kind: SectionKind) -> &[T] {
        let (offset, bytes) = self.directory.section(kind);
        let range = usize_range(offset..offset + bytes);
        let bytes = range.and_then(|range| self.memory.bytes().get(range)).unwrap_or(&[]);
        bytemuck::try_cast_slice(bytes).unwrap_or(&[])
    }
}

impl std::fmt::Debug for Opened {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Opened").field("header", self.header()).field("attributes", &self.attributes).finish()
    }
}

fn usize_range(range: Range<u64>) -> Option<Range<usize>> {
    Some(usize::try_from(range.start).ok()?..usize::try_from(range.end).ok()?)
}
