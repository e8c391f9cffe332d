//! A panic told in one line.
//!
//! A panic is a bug of this program. It must not take the other parts of a database with it, and
//! the person who meets it should read one sentence and not a page of code. The hook notes what
//! panicked and where; [`catch`] makes a failure of it. With `RUST_BACKTRACE` set the usual output
//! appears as well.

use std::any::Any;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::{Mutex, PoisonError};

use crate::failure::Failure;

/// Panics that were not caught yet: the message and the place in the code of each.
static NOTED: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());

/// Replaces the page that a panic prints by a note for [`catch`].
pub(crate) fn note_silently() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        note(info);
        if std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0") {
            usual(info);
        }
    }));
}

fn note(info: &PanicHookInfo<'_>) {
    let place = info.location().map_or("unknown place".to_owned(), ToString::to_string);
    let mut noted = NOTED.lock().unwrap_or_else(PoisonError::into_inner);
    noted.push((message(info.payload()), place));
}

/// Runs `work`; a panic in it, on whatever thread, becomes [`Failure::Bug`].
///
/// # Errors
///
/// Those of `work`, and [`Failure::Bug`].
pub(crate) fn catch<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    // What `work` has left half done is dropped here or guarded by its own locks.
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let message = message(&*payload);
        let mut noted = NOTED.lock().unwrap_or_else(PoisonError::into_inner);
        // The panic may have come from another thread: it is known by what it said.
        let index = noted.iter().position(|(noted, _)| *noted == message);
        let place = index.map(|index| noted.swap_remove(index).1);
        Err(Failure::Bug { message, place })
    })
}

fn message(payload: &(dyn Any + Send)) -> String {
    let literal = payload.downcast_ref::<&str>().map(|&text| text.to_owned());
    literal.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_failure() {
        let line = |work: fn() -> Result<(), Failure>| catch(work).unwrap_err().line();
        let literal = line(|| panic!("no index"));
        assert!(literal.starts_with("nephrite: a bug in this program: no index"), "{literal}");
        let formatted = line(|| panic!("index {} of {}", 7, 3));
        assert!(formatted.contains("index 7 of 3"), "{formatted}");
        assert_eq!(catch(|| Ok(5)).unwrap(), 5);
    }

    #[test]
    fn a_panic_of_another_thread_is_caught_too() {
        let work = || {
            rayon::join(|| (), || panic!("over there"));
            Ok(())
        };
        assert!(catch(work).unwrap_err().line().contains("over there"));
    }
}
