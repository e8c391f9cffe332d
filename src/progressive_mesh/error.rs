//! What can be wrong with a stream.

/// A stream could not be read or written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StreamError {
    /// The build has no operations, because another decimator made it.
    #[error("only the progressive decimator leaves operations")]
    NoOperations,
    /// The bytes are not the beginning of a stream of this version.
    #[error("operation stream begins with {found:08x}, expected {expected:08x}")]
    Magic {
        /// First four bytes.
        found: u32,
        /// What they must be.
        expected: u32,
    },
    /// A block is damaged.
    #[error("block {block} has checksum {found:08x}, expected {expected:08x}")]
    Checksum {
        /// Which block.
        block: usize,
        /// Checksum of the bytes.
        found: u32,
        /// Checksum in the block.
        expected: u32,
    },
    /// A block holds too little or too much for its operations.
    #[error("block {block} has {found} {what}, expected {expected}")]
    Block {
        /// Which block.
        block: usize,
        /// What there is too little or too much of.
        what: &'static str,
        /// How many.
        found: u64,
        /// How many are needed, at least or at most.
        expected: u64,
    },
    /// An operation names something that does not exist.
    #[error("operation {operation} names {what} {found}, there are {n_there}")]
    Name {
        /// Which operation.
        operation: usize,
        /// `vertex`, `neighbour` or `kind`.
        what: &'static str,
        /// What it names.
        found: u64,
        /// How many there are.
        n_there: u64,
    },
    /// An operation makes an invalid triangle or a position that is not finite.
    #[error("operation {operation} makes {what}")]
    Meaningless {
        /// Which operation.
        operation: usize,
        /// What it makes.
        what: &'static str,
    },
}
