//! The surface that the benches share, and queries spread over it.
#![allow(dead_code, unreachable_pub, reason = "each bench uses its part")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, reason = "sizes are chosen below")]

#[path = "../../tests/support/synthetic.rs"]
pub mod synthetic;

use nephrite::{History, Lod, StoreOptions};
use std::io::Cursor;
use synthetic::{Random, decimate, grid};

/// Vertices along one side of the surfaces: 7 thousand, 115 thousand and 1.8 million lifetimes.
pub const SIDES: [usize; 3] = [40, 150, 600];

/// A surface decimated to the end.
pub fn surface(side: usize) -> (nephrite::TriangleMesh, History<3>) {
    let mesh = grid(side);
    let history = decimate(&mesh, usize::MAX, 1);
    (mesh, history)
}

/// Its file, with the default levels or one for each step.
pub fn file_bytes(side: usize, levels: Option<u32>) -> Vec<u8> {
    let (mesh, history) = surface(side);
    let mut stream = Cursor::new(Vec::new());
    let options = StoreOptions { levels, ..StoreOptions::default() };
    history.write_to(&mut stream, &mesh, &options).unwrap();
    stream.into_inner()
}

/// Errors spread over a file's levels, in random order.
pub fn random_errors(lod: &Lod) -> Vec<f64> {
    let mut random = Random(7);
    let errors = lod.errors();
    (0..4096).map(|_| errors[random.below(errors.len())] * 1.000_001).collect()
}
