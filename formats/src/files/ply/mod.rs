//! PLY, the polygon file format (Greg Turk, Stanford, 1994): a header that declares elements and
//! their properties, then the elements' values as text or as bytes of either order.
//!
//! Everything the header can declare is read: properties in any order and of any type, lists of any
//! type, elements in any order. A vertex's scalars become attributes under their own names; `nx ny
//! nz`, `red green blue [alpha]` and the usual pairs of texture coordinates become `normal`,
//! `color` and `texcoord` where their types agree. Faces come from the lists `vertex_indices` or
//! `vertex_index` of the elements `face` and `tristrips` (a negative index starts a new strip). The
//! list `texcoord` of faces, two numbers for each corner, makes several vertices of one where its
//! pairs differ. V of texture coordinates is counted from the bottom. Colours are written in bytes,
//! which is all that most programs read.

mod binary;
mod corners;
mod face;
mod header;
mod names;
mod read;
mod text;
mod vertices;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;
