//! Files that are served from memory.
#![allow(unreachable_pub, reason = "a test file is no library")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use nephrite::store::{Provenance, StoreOptions, Vertices, write_to};
use nephrite::{History, Lod};
use std::io::Cursor;

/// The verified file that holds a history.
pub fn served<'a, const CORNERS: usize>(
    mesh: impl Into<Vertices<'a>>,
    history: &History<CORNERS>,
    provenance: &Provenance,
) -> Lod {
    let mut stream = Cursor::new(Vec::new());
    write_to(&mut stream, mesh, history, provenance, &StoreOptions::default()).unwrap();
    let lod = Lod::from_bytes(stream.get_ref()).unwrap();
    lod.verify().unwrap();
    lod
}
