//! OFF, the format of Geomview (The Geometry Center, Minneapolis), text and binary, with its
//! per-vertex forms: `N`, `C` and `ST` before the keyword for normals, colours and texture
//! coordinates.
//!
//! One vertex and one face a line, as every program writes it. The forms with four or n coordinates
//! are refused: programs disagree about them. V of texture coordinates is counted from the bottom.

mod binary;
mod columns;
mod keyword;
mod read;
mod write;

pub(crate) use keyword::Keyword;
pub(crate) use read::read;
pub(crate) use write::write;
