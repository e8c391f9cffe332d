//! An allocator that refuses what the length of an input does not justify. A refused allocation
//! ends the process.
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

/// Held by the test that runs, because the cap is for the whole process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Until the guard is dropped, the calling test is the only one that runs.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Bytes that may be allocated at a time: per byte of input, and in any case, because the test
/// harness needs some.
const BYTES_PER_BYTE: usize = 64;
pub(crate) const BYTES_ALWAYS: usize = 1 << 20;

/// Lifts the cap when it is dropped, also during a panic, whose message needs memory.
pub(crate) struct Capped;

impl Capped {
    /// Limits memory to `n_bytes` more than is allocated now.
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

/// Calls `read` under the cap, and checks that it ends.
pub(crate) fn within<T>(n_bytes: usize, what: impl std::fmt::Display, read: impl FnOnce() -> T) -> T {
    let _watchdog = Watchdog::over(format_args!("{what} of {n_bytes} bytes"));
    let _capped = Capped::to(BYTES_ALWAYS + BYTES_PER_BYTE * n_bytes);
    read()
}
