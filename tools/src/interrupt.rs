//! Ctrl-C: the first asks the command to stop before it writes anything, the second ends the
//! process.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::{Failure, INTERRUPTED};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Takes over Ctrl-C, SIGTERM and SIGHUP for the rest of the process.
///
/// If the system refuses, an interrupt ends the process in the default way. Files are published by
/// rename, so none is half-written even then.
pub(crate) fn listen() {
    let _ = ctrlc::set_handler(|| {
        if REQUESTED.swap(true, Ordering::Relaxed) {
            process::exit(i32::from(INTERRUPTED));
        }
    });
}

/// True after an interrupt.
pub(crate) fn is_requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// Ends a command that was interrupted, before it publishes anything.
///
/// # Errors
///
/// [`Failure::Interrupted`].
pub(crate) fn check() -> Result<(), Failure> {
    if is_requested() { Err(Failure::Interrupted) } else { Ok(()) }
}
