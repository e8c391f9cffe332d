//! Mesh files read and written for nephrite, and the records of its `.neph` file.
//!
//! The feature `importers`, on by default, has the readers and writers of mesh and volume files.
//! Without it the crate has [`TriangleMesh`], [`TetrahedronMesh`], [`neph`] and [`publish`](mod@publish)
//! alone.

#[cfg(feature = "importers")]
mod attributes;
#[cfg(feature = "importers")]
mod contents;
#[cfg(feature = "importers")]
mod coordinates;
#[cfg(feature = "importers")]
mod distinct;
#[cfg(feature = "importers")]
mod error;
#[cfg(feature = "importers")]
mod face_colors;
#[cfg(feature = "importers")]
mod faces;
mod fault;
#[cfg(feature = "importers")]
mod foreign;
#[cfg(feature = "importers")]
mod format;
#[cfg(feature = "importers")]
mod gltf;
#[cfg(feature = "importers")]
mod input;
pub mod mesh;
pub mod neph;
#[cfg(feature = "importers")]
mod normals;
#[cfg(feature = "importers")]
mod obj;
#[cfg(feature = "importers")]
mod off;
#[cfg(feature = "importers")]
mod ply;
#[cfg(feature = "importers")]
mod polygon;
pub mod publish;
#[cfg(feature = "importers")]
mod report;
#[cfg(feature = "importers")]
mod stl;
mod tetrahedra;
#[cfg(feature = "importers")]
mod text;
#[cfg(feature = "importers")]
mod unused;
mod values;
#[cfg(feature = "importers")]
mod vertices;
#[cfg(feature = "importers")]
mod volume;

#[cfg(feature = "importers")]
pub use contents::{Change, Fate, Item, Kind};
#[cfg(feature = "importers")]
pub use error::{MeshError, Place};
pub use fault::MeshFault;
#[cfg(feature = "importers")]
pub use format::{MeshFormat, read_mesh, read_mesh_bytes, write_mesh, write_mesh_to};
#[cfg(feature = "importers")]
pub use input::read_input;
pub use mesh::{Attribute, ScalarType, TriangleMesh};
pub use publish::{PublishError, publish};
#[cfg(feature = "importers")]
pub use report::{FileFormat, FileReport};
pub use tetrahedra::TetrahedronMesh;
#[cfg(feature = "importers")]
pub use volume::{VolumeFormat, read_plot3d, read_volume, read_volume_bytes, write_volume, write_volume_to};
