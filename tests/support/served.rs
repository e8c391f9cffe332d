//! Files that are served from memory.
#![allow(unreachable_pub, reason = "a test file is no library")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use nephrite::{Lod, StoreOptions, StoreReport, WriteError};
use std::io::Cursor;

/// The verified file that `write` makes.
pub fn served(
    write: impl FnOnce(&mut Cursor<Vec<u8>>, &StoreOptions) -> Result<StoreReport, WriteError>,
) -> Lod {
    let mut stream = Cursor::new(Vec::new());
    write(&mut stream, &StoreOptions::default()).unwrap();
    let lod = Lod::from_bytes(stream.get_ref()).unwrap();
    lod.verify().unwrap();
    lod
}
