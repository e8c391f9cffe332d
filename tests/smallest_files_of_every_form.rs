//! Promise: the smallest files of every form open from memory and from disk, verify, and answer
//! every query. They are small enough for `tests/miri`, which reads them under an interpreter that
//! checks each access to memory.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small files")]

mod support;

use nephrite::{Lod, StoreOptions};
use support::damage::{Outcome, open_and_use};
use support::synthetic::{decimate, grid, succeed};
use support::{file_bytes_with, on_this_thread};

#[test]
fn are_read_and_used() {
    let _pool = on_this_thread();
    let usual = StoreOptions::default();
    let forms = [
        usual,
        StoreOptions { window_levels: Some(2), ..usual },
        StoreOptions { is_compact: true, ..usual },
        StoreOptions { levels: Some(1), ..usual },
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file.neph");
    for has_births in [false, true] {
        let mut mesh = grid(2);
        let n_triangles = mesh.triangles.len();
        let mut history = decimate(&mesh, usize::MAX, 3);
        if has_births {
            succeed(&mut mesh, &mut history, 2);
        }
        for options in &forms {
            let bytes = file_bytes_with(&mesh, &history, options);
            assert!(matches!(open_and_use(&bytes), Outcome::Used(Ok(()))), "{options:?}");
            std::fs::write(&path, &bytes).unwrap();
            let lod = Lod::open(&path).unwrap();
            assert_eq!(lod.at_level(0).to_mesh().unwrap().triangles.len(), n_triangles);
        }
    }
}
