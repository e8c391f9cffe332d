//! OFF, the text format of Geomview (The Geometry Center, Minneapolis) with its per-vertex forms `NOFF`, `COFF` and `STOFF`.
//!
//! One vertex and one face a line, as every program writes it. Colours after a face, and words after a vertex's own, are
//! passed over. The forms with four or n coordinates and the binary one are refused: programs disagree about them.

mod read;
mod write;

pub(crate) use read::{Keyword, read};
pub(crate) use write::write;
