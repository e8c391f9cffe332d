//! Volume formats. Tetrahedra are kept; hexahedra, prisms and pyramids are cut into tetrahedra.

mod cells;
mod coning;
mod format;
mod ghosts;
mod gmsh;
mod medit;
mod meshb;
mod mfem;
mod pending;
mod plot3d;
mod scalars;
mod tetgen;
mod vtk;
mod vtu;
mod words;

pub use format::{VolumeFormat, read_plot3d, read_volume, read_volume_bytes, write_volume, write_volume_to};
