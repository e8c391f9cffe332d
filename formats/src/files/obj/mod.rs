//! OBJ, the text format of Wavefront's Advanced Visualizer: `v`, `vt`, `vn` lists and faces that
//! index each on its own.
//!
//! A vertex of the mesh is a distinct triple of position, texture coordinate and normal. The first
//! triple at a position keeps the position's number, so that files without seams come through in
//! their own order; further triples follow in the order seen. Colours after a position's
//! coordinates are read. V is counted from the bottom. Groups, materials, points, lines and curves
//! are left out and noted; normals that some corners lack are computed.

mod parse;
mod read;
mod regions;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;
