//! Fuzz targets: functions that take bytes and panic if a promise is broken.
//!
//! Under `cargo test` each target runs for a second on random bytes, and on every input that was
//! ever a find. `fuzz/run` lets libFuzzer search for inputs, guided by the coverage of the code;
//! its last results are in `fuzz/RESULTS.md`.
#![cfg(test)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a broken promise ends the run")]

#[path = "../../tests/support/damage.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the tests")]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small files")]
mod damage;
mod importers;
mod neph;
mod operations;
mod script;
mod soup;
#[path = "../../tests/support/synthetic.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the tests")]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small meshes")]
mod synthetic;
mod targets;
