//! STL, the stereolithography format: triangles without shared vertices, as bytes or as text.
//!
//! Which of the two a file is cannot be told from its first word: many binary files begin with
//! `solid`. A file whose length is the one its triangle count asks for is binary whatever it begins
//! with. Corners at exactly the same position become one vertex. The normals of the file are not
//! kept: they follow from the corners, and many programs write zeros.

mod colors;
mod read;
mod weld;
mod write;

pub(crate) use read::{length_of_binary, read};
pub(crate) use write::write;
