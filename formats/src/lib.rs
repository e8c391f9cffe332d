//! Mesh files read and written for nephrite, and the records of its `.neph` file.

mod attributes;
mod contents;
mod coordinates;
mod distinct;
mod error;
mod face_colors;
mod faces;
mod fault;
mod foreign;
mod format;
mod gltf;
mod input;
pub mod mesh;
pub mod neph;
mod normals;
mod obj;
mod off;
mod ply;
mod polygon;
pub mod publish;
mod report;
mod stl;
mod tetrahedra;
mod text;
mod unused;
mod volume;

pub use contents::{Change, Fate, Item, Kind};
pub use error::{MeshError, Place};
pub use fault::MeshFault;
pub use format::{MeshFormat, read_mesh, read_mesh_bytes, write_mesh, write_mesh_to};
pub use input::read_input;
pub use mesh::{Attribute, ScalarType, TriangleMesh};
pub use publish::{PublishError, publish};
pub use report::{FileFormat, FileReport};
pub use tetrahedra::TetrahedronMesh;
pub use volume::{VolumeFormat, read_plot3d, read_volume, read_volume_bytes, write_volume, write_volume_to};
