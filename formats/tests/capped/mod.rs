//! An allocator that refuses what an input of its length does not justify. A refused allocation ends the process.
#![allow(dead_code, reason = "each test file takes what it needs")]
#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

use std::alloc::System;
use std::sync::{Mutex, MutexGuard, PoisonError};

use cap::Cap;
pub(crate) use watchdog::Watchdog;

#[path = "../../../tests/support/watchdog.rs"]
mod watchdog;

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Held by the test that runs, as the cap is for the process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// The test that asks is the only one until it lets go.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Bytes that may be allocated at once per byte of input, and in any case: the harness needs some itself.
const BYTES_PER_BYTE: usize = 64;
pub(crate) const BYTES_ALWAYS: usize = 1 << 20;

/// Lifts the cap when it goes, also when a panic needs memory to be told.
pub(crate) struct Capped;

impl Capped {
    /// Refuses whatever goes beyond so many bytes more than there are now.
    pub(crate) fn to(n_bytes: usize) -> Self {
        ALLOCATOR.set_limit(ALLOCATOR.allocated() + n_bytes).unwrap();
        Self
    }
}

impl Drop for Capped {
    fn drop(&mut self) {
        ALLOCATOR.set_limit(usize::MAX).unwrap();
    }
}

/// Does something with an input under the cap, and to an end.
pub(crate) fn within<T>(n_bytes: usize, what: impl std::fmt::Display, read: impl FnOnce() -> T) -> T {
    let _watchdog = Watchdog::over(format_args!("{what} of {n_bytes} bytes"));
    let _capped = Capped::to(BYTES_ALWAYS + BYTES_PER_BYTE * n_bytes);
    read()
}
