//! A renderer that draws a field of meshes, each at the level that its distance needs.
//!
//! The naive way keeps some ten meshes per object and uploads each. Here every [`Model`] is one
//! static vertex buffer and one static index buffer, those of the file. A frame asks a `Picker` per
//! instance for a level, groups instances of the same level, and lists one [`Draw`] per run of that
//! level ([`Field::choose`], [`Frame::list_draws`]). Only the positions of instances are uploaded,
//! and no triangle is read.

mod builtin;
mod camera;
mod color;
mod error;
mod field;
mod frame;
mod gpu;
mod model;
mod normals;
mod picture;
mod pipelines;
mod renderer;
mod target;

pub use builtin::{knot, lod_of};
pub use camera::Camera;
pub use color::Color;
pub use error::RenderError;
pub use field::{Choice, Field, Look};
pub use frame::{Draw, Frame, Group, InstanceRecord};
pub use gpu::Gpu;
pub use model::{Geometry, Model, Up};
pub use picture::Picture;
pub use renderer::{Renderer, Shading};
