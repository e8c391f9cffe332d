//! nephrite beside other systems, as programs that anyone can run again.
//!
//! * `levels_check`: is the stated error of a level ever exceeded, and how close is it?
//! * `tables`: triangles at a given error and error at a given triangle count, beside published
//!   figures.
//! * `speed`: the whole history beside a chain of halvings by meshoptimizer, and the memory both
//!   take.
//! * `granularity`: levels and bytes beside that chain, and vertex transforms of levels drawn as
//!   runs.
//! * `growth`: query time from ten thousand lifetimes to a hundred million.
//! * `intervals`: extraction beside general interval trees over the same lifetimes.
//! * `progressive`: progressive decimation beside vtkDecimatePro, and its stream beside other
//!   codecs.
//! * `figure7`: its collapses and splits beside those of its paper.
//! * `any_count`: is every step of it a mesh in order, on any input?
//! * `volume_steps`: is every step of a fusion a whole volume, and what does a fusion take away?
//! * `parts`: parts for a database, millions of triangles in all.
//!
//! Scripts beside it, for what only Python has:
//!
//! * `builders_time.py`: the time of a certified history beside meshoptimizer, fast-simplification
//!   and vtkDecimatePro.
//! * `metro_check.py`: stated errors of levels against distances sampled by MeshLab.
//! * `volumes_check.py`: fusion beside VTK: time, boundary and field error at equal counts.
//! * `volumes_read_back.py`: levels of volumes as pyvista reads them, and the rate of their
//!   extraction.
//!
//! This crate is a workspace of its own: building or testing the project builds none of it.

pub mod anchors;
pub mod boundary_walk;
pub mod chain;
mod error;
mod every_level;
pub mod lifetimes;
mod progressive;
pub mod statistics;
pub mod stopwatch;
mod table;

pub use error::CompareError;
pub use every_level::{Build, KeptLevels, build_lod, load, spread_levels};
pub use progressive::decimate_progressively;
pub use table::Table;
