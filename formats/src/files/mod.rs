//! Readers and writers of mesh and volume files: a folder for each format of surfaces, `volume` for
//! those of volumes, and beside them what several of them need.

mod attributes;
mod contents;
mod coordinates;
mod distinct;
mod error;
mod face_colors;
mod faces;
mod foreign;
mod format;
mod gltf;
mod input;
mod normals;
mod obj;
mod off;
mod ply;
mod polygon;
mod report;
mod stl;
mod text;
mod unused;
mod vertices;
mod volume;

pub use contents::{Change, Fate, Item, Kind};
pub use error::{MeshError, Place};
pub use format::{MeshFormat, read_mesh, read_mesh_bytes, write_mesh, write_mesh_to};
pub use input::read_input;
pub use report::{FileFormat, FileReport};
pub use volume::{VolumeFormat, read_plot3d, read_volume, read_volume_bytes, write_volume, write_volume_to};
