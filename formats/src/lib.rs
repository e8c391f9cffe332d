//! Mesh files read and written for nephrite, and the records of its `.neph` file.

mod attributes;
#[cfg_attr(not(test), expect(dead_code, reason = "parts for the readers that follow"))]
mod coordinates;
mod error;
#[expect(dead_code, reason = "parts for the readers that follow")]
mod faces;
mod format;
pub mod mesh;
mod obj;
mod ply;
mod polygon;
mod publish;
mod report;
#[expect(dead_code, reason = "parts for the readers that follow")]
mod text;

pub use error::{MeshError, Place};
pub use format::{MeshFormat, read_mesh, read_mesh_bytes, write_mesh, write_mesh_to};
pub use mesh::{Attribute, ScalarType, TriangleMesh};
pub use report::{ReadReport, Warning};
