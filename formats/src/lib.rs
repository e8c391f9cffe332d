//! Mesh files read and written for nephrite, and the records of its `.neph` file.
//!
//! The feature `importers`, on by default, has the readers and writers of mesh and volume files.
//! Without it the crate has [`TriangleMesh`], [`TetrahedronMesh`], [`neph`] and
//! [`publish`](mod@publish) alone.

mod fault;
#[cfg(feature = "importers")]
mod files;
pub mod mesh;
pub mod neph;
pub mod publish;
mod tetrahedra;
mod values;

pub use fault::MeshFault;
#[cfg(feature = "importers")]
pub use files::{
    Change, Fate, FileFormat, FileReport, Item, Kind, MeshError, MeshFormat, Place, VolumeFormat, read_input,
    read_mesh, read_mesh_bytes, read_plot3d, read_volume, read_volume_bytes, write_mesh, write_mesh_to,
    write_volume, write_volume_to,
};
pub use mesh::{Attribute, ScalarType, TriangleMesh};
pub use publish::{PublishError, publish};
pub use tetrahedra::TetrahedronMesh;
