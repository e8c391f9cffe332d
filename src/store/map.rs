//! Mapping a file: the one module with `unsafe`.
//!
//! A map shows the file, not a copy of it. That is what makes opening cheap and lets many processes
//! share one page cache, and it is why mapping cannot be a safe function: Rust promises that bytes
//! behind a shared reference do not change.

#![expect(unsafe_code, reason = "a map shows what others write to the file, see above")]

use super::OpenError;
use super::memory::{Memory, open_regular};
use super::opened::Opened;
use crate::query::Lod;
use std::path::Path;

impl Opened {
    /// Maps a file and checks its head.
    ///
    /// # Safety
    ///
    /// As [`Lod::map`].
    ///
    /// # Errors
    ///
    /// [`OpenError`] when the system refuses or the head of the file is not in order.
    pub unsafe fn map(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let file = open_regular(path)?;
        // SAFETY: the caller promises that the file is neither written nor truncated while the map
        // lives, which is what `Mmap::map` asks for. The map is private to `Memory` and is only
        // ever read.
        let map = unsafe { memmap2::Mmap::map(&file) };
        let map = map.map_err(|source| OpenError::Io { action: "map", path: path.to_owned(), source })?;
        Self::new(Memory::shared(map)?)
    }
}

impl Lod {
    /// Maps a file and checks its head. Cost: constant, a few pages whatever the size of the file.
    /// The slots of a file in the compact form are read and laid out in memory, see
    /// [`StoreOptions::is_compact`](crate::StoreOptions::is_compact).
    ///
    /// # Safety
    ///
    /// While the result lives,
    ///
    /// * nobody writes to the file, in this process or in any other: its bytes are borrowed as
    ///   shared references;
    /// * nobody truncates it: access to a page behind the end is a fault (SIGBUS) that ends the
    ///   process;
    /// * the file lies on a device that stays readable: a failing read is the same fault.
    ///
    /// Renaming another file over the path, or deleting it, is safe: the map keeps the file it was
    /// made from. `Build::write` publishes by rename and so keeps this
    /// contract.
    ///
    /// # Errors
    ///
    /// [`OpenError`] when the system refuses or the head of the file is not in order.
    pub unsafe fn map(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        // SAFETY: the caller keeps the contract, which is the same.
        unsafe { Opened::map(path) }.map(Self::from)
    }
}
