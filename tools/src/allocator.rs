//! Large blocks go back to the system as soon as they are freed.
//!
//! The C library of GNU systems maps each large block on its own, and unmaps it when it is freed. But the first large block that is freed,
//! here the bytes of the file that was read, tells it that such blocks come and go: from then on it keeps all that are no larger, up
//! to 32 MiB, and what a build frees between its phases stays resident, in pieces that the next phase cannot use. A fixed threshold keeps
//! it at mapping. Peak of a build of the dragon (435,545 vertices): 268 instead of 342 bytes per vertex, in the same time.

/// Blocks from this many bytes on are mapped: where the C library starts.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const MAPPED_BYTES: i32 = 128 * 1024;

/// Asks the allocator to return large blocks. Where it has no such threshold nothing is asked.
pub(crate) fn return_large_blocks() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        // SAFETY: `mallopt` takes two numbers and may be called at any time; where it refuses, the threshold stays as it was.
        unsafe { libc::mallopt(libc::M_MMAP_THRESHOLD, MAPPED_BYTES) };
    }
}
