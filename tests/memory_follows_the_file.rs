//! Promise: whatever a `.neph` file claims, opening, verifying and using it takes memory in
//! proportion to its length.
//!
//! The allocator of this test refuses more than that, and a refused allocation ends the process.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use cap::Cap;
use nephrite::StoreOptions;
use std::alloc::System;
use std::path::Path;
use support::damage::open_and_use;
use support::synthetic::{decimate, grid};

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Most bytes at a time: per byte of the file, and in any case.
const BYTES_PER_BYTE: usize = 64;
const BYTES_ALWAYS: usize = 1 << 20;

fn use_within(bytes: &[u8]) {
    ALLOCATOR.set_limit(ALLOCATOR.allocated() + BYTES_ALWAYS + BYTES_PER_BYTE * bytes.len()).unwrap();
    let outcome = open_and_use(bytes);
    ALLOCATOR.set_limit(usize::MAX).unwrap();
    drop(outcome);
}

/// The only test of this file, because the cap is for the whole process.
#[test]
fn of_every_bad_file_and_of_good_ones() {
    for side in [2, 30, 120] {
        let mesh = grid(side);
        let history = decimate(&mesh, usize::MAX, 3);
        for is_compact in [false, true] {
            let options = StoreOptions { is_compact, ..StoreOptions::default() };
            let bytes = support::file_bytes_with(&mesh, &history, &options);
            // Threads and their buffers are allocated with the first file.
            open_and_use(&bytes);
            use_within(&bytes);
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_neph/files");
    let mut n_files = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        use_within(&std::fs::read(entry.unwrap().path()).unwrap());
        n_files += 1;
    }
    assert!(n_files > 100, "{n_files}");
}
