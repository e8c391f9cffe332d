//! The `.neph` file: written once from a finished history, opened in constant time, verified on
//! demand.
//!
//! Writing chooses the levels, orders the vertices, lays out the interval tree and streams the
//! sections, so that it needs 4 bytes per slot and 8 per vertex beside mesh and history, never the
//! file itself. Opening looks at the first 16 KiB, and lays slots out that are in the compact form.
//! What is read later is clamped where it is used: a damaged file that opens gives wrong levels,
//! never slots out of range.
//!
//! The layout of the file is in `formats/SPEC.md`.

mod arrange;
mod attributes;
mod body;
mod compact;
mod content;
mod error;
mod integrity;
mod map;
mod memory;
mod metadata;
mod opened;
mod operations;
mod pieces;
mod publish;
mod report;
mod verify;
mod vertices;
mod write;

/// How a file writes that no bound is stated for a level, since it may hold finite errors only.
pub(crate) const NO_BOUND: f64 = f64::MAX;

pub use attributes::check_attributes;
pub use error::{CompactFault, OpenError, VerifyError, WriteError};
pub use metadata::{Bound, Metadata, Method};
pub use opened::AttributeView;
pub(crate) use opened::Opened;
pub use report::StoreReport;
pub use vertices::Vertices;
pub(crate) use write::Source;
pub use write::StoreOptions;
