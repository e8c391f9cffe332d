//! What can go wrong while writing, opening and verifying.

use crate::history::HistoryError;
use crate::progressive_mesh::StreamError;
use crate::tree::{TreeError, TreeFault};
use nephrite_formats::PublishError;
use nephrite_formats::neph::NephError;
use std::io;
use std::path::PathBuf;

/// A file could not be written. The path given still holds what it held before.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The system refused.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// What was tried: `create a file in`, `write`, `sync`, `check`, `rename a file to` or
        /// `replace`.
        action: &'static str,
        /// The file concerned.
        path: PathBuf,
        /// Answer of the system.
        source: io::Error,
    },
    /// The stream given to [`Build::write_to`](crate::Build::write_to) refused.
    #[error("cannot write to the stream")]
    Stream(#[from] io::Error),
    /// What was read back differs from what was written.
    #[error("{} was damaged while it was written", path.display())]
    Damaged {
        /// The temporary file, which is removed.
        path: PathBuf,
        /// What differs.
        source: VerifyError,
    },
    /// The history breaks an invariant.
    #[error("history is not valid")]
    History(#[from] HistoryError),
    /// Operations are wanted of a build that has none, or none that a reader could follow.
    #[error("the operations cannot be written")]
    Operations(#[from] StreamError),
    /// The history and the mesh belong to different vertices.
    #[error("history has {found} vertices, the mesh {expected}")]
    VertexCount {
        /// Vertices of the history.
        found: u64,
        /// Vertices of the mesh.
        expected: u64,
    },
    /// A coordinate, the origin or the rounding is not finite.
    #[error("coordinate of {what} is not finite")]
    NotFinite {
        /// `vertex 17`, `the origin` or `the rounding`.
        what: String,
    },
    /// The lifetimes exceed what a tree can hold.
    #[error("history is too large for one file")]
    Tree(#[from] TreeError),
    /// An attribute does not fit the mesh or the file.
    #[error("attribute {name:?} has {found} {what}, expected {expected}")]
    Attribute {
        /// Its name.
        name: String,
        /// `bytes`, `components`, `bytes of name` or `attributes of that name`.
        what: &'static str,
        /// Value found.
        found: u64,
        /// Value expected, or the largest allowed.
        expected: u64,
    },
    /// More attributes, or longer names, than a file holds.
    #[error("{found} {what}, at most {max} are possible")]
    TooManyAttributes {
        /// `attributes` or `bytes of attribute names`.
        what: &'static str,
        /// How many.
        found: u64,
        /// How many a file holds.
        max: u64,
    },
    /// More deviations, or longer names of them, than a file holds.
    #[error("{found} {what}, at most {max} are possible")]
    TooManyDeviations {
        /// `deviations`, `bytes of deviation names` or `zero bytes in names of deviations`.
        what: &'static str,
        /// How many.
        found: u64,
        /// How many a file holds.
        max: u64,
    },
    /// The metadata cannot be written as JSON, as a map whose keys are not strings.
    #[error("metadata cannot be written as JSON")]
    Metadata(#[from] serde_json::Error),
    /// The metadata is longer than a file holds.
    #[error("metadata takes {found} bytes, at most {max} are possible")]
    MetadataBytes {
        /// Its length as JSON.
        found: u64,
        /// The largest length.
        max: u64,
    },
    /// The sections do not fit in a file.
    #[error("sections do not fit in a file")]
    Placement(#[from] NephError),
}

impl From<PublishError> for WriteError {
    fn from(PublishError { action, path, source }: PublishError) -> Self {
        Self::Io { action, path, source }
    }
}

/// A file could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The system refused.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// What was tried: `open`, `read` or `map`.
        action: &'static str,
        /// The file concerned.
        path: PathBuf,
        /// Answer of the system.
        source: io::Error,
    },
    /// A directory, a device or a pipe.
    #[error("{} is not a regular file", path.display())]
    NotAFile {
        /// The path given.
        path: PathBuf,
    },
    /// The file is longer than the memory to be had.
    #[error("no memory for a file of {bytes} bytes")]
    OutOfMemory {
        /// Length of the file.
        bytes: u64,
    },
    /// Header, directory or attribute table break a rule of the format.
    #[error("not a readable .neph file")]
    Format(#[from] NephError),
}

/// A file that opens breaks a rule of the format.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// The compact form of slots contradicts itself.
    #[error(transparent)]
    Compact(#[from] CompactFault),
    /// The head is damaged.
    #[error("header or directory are damaged")]
    Head(#[from] NephError),
    /// The file cannot be read to its end.
    #[error("cannot read the file")]
    Read(#[from] io::Error),
    /// A chunk of the body is damaged.
    #[error("chunk {chunk} of the body has checksum {found:016x}, expected {expected:016x}")]
    Chunk {
        /// Which chunk.
        chunk: u64,
        /// Checksum computed.
        found: u64,
        /// Checksum stored.
        expected: u64,
    },
    /// The checksums themselves are damaged.
    #[error("checksum section has checksum {found:016x}, expected {expected:016x}")]
    Checksums {
        /// Checksum computed.
        found: u64,
        /// Checksum stored.
        expected: u64,
    },
    /// A byte between two sections is not zero.
    #[error("padding at byte {offset} is not zero")]
    Padding {
        /// Where.
        offset: u64,
    },
    /// The metadata is not JSON of the known shape.
    #[error("metadata is not readable")]
    Metadata(#[from] serde_json::Error),
    /// An error is negative or not finite, or the table falls.
    #[error("error of level {level} is {found} after {before}")]
    Error {
        /// Which level.
        level: u32,
        /// Its error.
        found: f64,
        /// Error of the level before, or zero.
        before: f64,
    },
    /// A deviation is negative or not finite, falls, or has no name of its own.
    #[error("deviation {deviation} is not one number per level that never falls, under a name")]
    Deviation {
        /// Which one.
        deviation: usize,
    },
    /// A count of simplices or vertices rises from one level to the next, or is not the one the
    /// rest of the file gives.
    #[error("level {level} has {found} {what} where {expected} are possible")]
    Count {
        /// Which level.
        level: u32,
        /// `simplices` or `vertices`.
        what: &'static str,
        /// Count in the table.
        found: u64,
        /// Largest count allowed, or the count that the runs give.
        expected: u64,
    },
    /// The number of lifetimes in the header is wrong.
    #[error("header counts {found} lifetimes, the slots hold {expected}")]
    Lifetimes {
        /// Number in the header.
        found: u64,
        /// Lifetimes in the slots.
        expected: u64,
    },
    /// The interval tree is wrong.
    #[error("interval tree is damaged")]
    Tree(#[from] TreeFault),
    /// A simplex uses a vertex that some of its levels do not have.
    #[error("slot {slot} uses vertex {found}, its levels have {vertex_count}")]
    Vertex {
        /// Which slot.
        slot: u32,
        /// The vertex index.
        found: u32,
        /// Vertices of the last level in which the simplex is alive.
        vertex_count: u32,
    },
    /// A simplex uses a vertex that is born after it.
    #[error("slot {slot} is born at level {birth} and uses vertex {found}, born at level {vertex_birth}")]
    UnbornVertex {
        /// Which slot.
        slot: u32,
        /// The vertex index.
        found: u32,
        /// Birth of the simplex.
        birth: u32,
        /// Birth of the vertex.
        vertex_birth: u32,
    },
    /// A vertex is born when it is dead already.
    #[error("vertex {vertex} is born at level {found}, but not there from level {death} on")]
    VertexBirth {
        /// Which vertex.
        vertex: u32,
        /// Its birth.
        found: u32,
        /// First level without it.
        death: u32,
    },
    /// A position is not finite, or outside the bounds of the header.
    #[error("position of vertex {vertex} is not finite or outside the bounds")]
    Position {
        /// Which vertex.
        vertex: u32,
    },
    /// The operations are no stream, or one that contradicts itself.
    #[error("operations are damaged")]
    Operations(#[from] StreamError),
    /// The operations do not end where the stream says.
    #[error("{found} operations are there, {expected} were announced")]
    OperationCount {
        /// Whole operations in the section.
        found: u64,
        /// Operations that its beginning announces.
        expected: u64,
    },
    /// The operations build something else up than level 0.
    #[error("operations lead to {found} triangles that are those of level 0, of {expected}")]
    OperationsMesh {
        /// Triangles that both have.
        found: u64,
        /// The larger of the two numbers of triangles.
        expected: u64,
    },
}

/// What is wrong with the compact form of slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompactFault {
    /// Not as many bits as sources.
    #[error("{found} slots are marked as repeats, there are sources for {expected}")]
    Repeats {
        /// Bits that are set.
        found: u64,
        /// Sources there are.
        expected: u64,
    },
    /// A bit behind the last slot.
    #[error("slot {found} of {n_slots} is marked as a repeat")]
    Slot {
        /// The slot of the bit.
        found: u64,
        /// Slots there are.
        n_slots: u64,
    },
    /// A source that is no simplex of an earlier slot.
    #[error("a repeat names simplex {found} of the {n_distinct} before it")]
    Source {
        /// Its value.
        found: u64,
        /// Distinct simplices of the slots before.
        n_distinct: u64,
    },
}
