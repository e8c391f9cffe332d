//! Clears the caches of the processor and of the system before a sample.

use std::fs::File;
use std::hint::black_box;
use std::io;
use std::path::Path;

/// More than the caches of common processors hold.
const FLUSH_BYTES: usize = 128 << 20;

/// Bytes of a cache line.
const LINE_BYTES: usize = 64;

/// Memory that is read to evict everything else from the caches of the processor.
pub(super) struct CacheFlush {
    memory: Vec<u8>,
}

impl CacheFlush {
    /// Takes 128 MiB.
    pub(super) fn new() -> Self {
        Self { memory: vec![1; FLUSH_BYTES] }
    }

    /// Touches every line. Some 20 ms.
    pub(super) fn flush(&mut self) {
        for line in black_box(&mut self.memory).chunks_mut(LINE_BYTES) {
            line[0] = line[0].wrapping_add(1);
        }
    }
}

/// Asks the system to drop a file from its page cache; returns whether it can be asked.
///
/// # Errors
///
/// The system's, if the file cannot be opened or it refuses.
#[cfg(target_os = "linux")]
pub(super) fn forget_file(path: &Path) -> io::Result<bool> {
    let file = File::open(path)?;
    // Pages that were never written to the disk stay.
    file.sync_all()?;
    rustix::fs::fadvise(&file, 0, None, rustix::fs::Advice::DontNeed)?;
    Ok(true)
}

/// Asks the system to drop a file from its page cache; returns whether it can be asked.
///
/// # Errors
///
/// Never, elsewhere than on Linux.
#[cfg(not(target_os = "linux"))]
pub(super) fn forget_file(path: &Path) -> io::Result<bool> {
    File::open(path)?;
    Ok(false)
}
