//! A watchdog that ends a process that hangs. It does not measure speed: the inputs of the tests
//! that use it are so large that linear work takes seconds, and quadratic work hours.

#![allow(clippy::print_stderr, reason = "what hangs is to be named")]

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Far more than any linear work takes, on any machine and under any load.
const LONGEST: Duration = Duration::from_secs(20 * 60);

/// Ends the process with a failure unless it is dropped first.
pub(crate) struct Watchdog {
    _alive: Sender<()>,
}

impl Watchdog {
    /// Watches over the work with this name.
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
