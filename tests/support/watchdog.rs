//! A watchdog: it ends a process that hangs. It is no measure of speed: the inputs of tests that use it are so large that what is linear in
//! them takes seconds, and what is quadratic hours.

#![allow(clippy::print_stderr, reason = "what hangs is to be named")]

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Far more than anything takes that follows its input, on whatever machine and under whatever load.
const LONGEST: Duration = Duration::from_secs(20 * 60);

/// Ends the process, failed, unless it is dropped before.
pub(crate) struct Watchdog {
    _alive: Sender<()>,
}

impl Watchdog {
    /// Watches over something with a name.
    pub(crate) fn over(what: impl std::fmt::Display) -> Self {
        let (alive, end) = channel();
        let what = what.to_string();
        std::thread::spawn(move || {
            if end.recv_timeout(LONGEST) == Err(RecvTimeoutError::Timeout) {
                eprintln!("{what}: no end after {LONGEST:?}");
                std::process::abort();
            }
        });
        Self { _alive: alive }
    }
}
