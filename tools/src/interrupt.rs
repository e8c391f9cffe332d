//! Ctrl-C: the first asks the command to stop where nothing is half-written, the second ends the process at once.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::{Failure, INTERRUPTED};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Takes over Ctrl-C and its like (SIGTERM, SIGHUP) for the rest of the process.
///
/// Where the system refuses, an interrupt ends the process the default way: files are published by rename, so even
/// then none is half-written.
pub(crate) fn listen() {
    let _ = ctrlc::set_handler(|| {
        if REQUESTED.swap(true, Ordering::Relaxed) {
            process::exit(i32::from(INTERRUPTED));
        }
    });
}

/// True once somebody asked the command to stop.
pub(crate) fn is_requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// Returns early from a command that was asked to stop, before it publishes anything.
///
/// # Errors
///
/// [`Failure::Interrupted`].
pub(crate) fn check() -> Result<(), Failure> {
    if is_requested() { Err(Failure::Interrupted) } else { Ok(()) }
}
