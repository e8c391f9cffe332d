//! One file on the graphics processor.

use crate::normals::vertex_normals;
use crate::{Gpu, RenderError};
use glam::{Mat4, Vec3};
use nephrite::Lod;
use std::path::Path;

/// Which coordinate of a mesh points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Up {
    /// The second one, usual for scanners and games.
    #[default]
    Y,
    /// The third one, usual in engineering.
    Z,
}

/// Buffers that a draw reads. Cloning copies handles.
#[derive(Clone, Debug)]
pub struct Geometry {
    pub(crate) positions: wgpu::Buffer,
    pub(crate) normals: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
}

/// A file, uploaded once: every level is drawn from these buffers.
#[derive(Debug)]
pub struct Model {
    lod: Lod,
    geometry: Geometry,
    up: Up,
}

impl Model {
    /// Reads, verifies and uploads a file.
    ///
    /// # Errors
    ///
    /// [`RenderError::Open`] and those of [`upload`](Self::upload).
    pub fn open(gpu: &Gpu, path: &Path, up: Up) -> Result<Self, RenderError> {
        let lod = Lod::open(path).map_err(|source| RenderError::Open { path: path.to_owned(), source })?;
        Self::upload(gpu, &path.display().to_string(), lod, up)
    }

    /// Verifies and uploads. `name` appears in errors. Cost: one pass over the file; 12 bytes per
    /// stored triangle and 20 per vertex on the device.
    ///
    /// # Errors
    ///
    /// [`RenderError::Verify`], [`RenderError::NotTriangles`], [`RenderError::BufferTooLarge`],
    /// [`RenderError::Refused`].
    pub fn upload(gpu: &Gpu, name: &str, lod: Lod, up: Up) -> Result<Self, RenderError> {
        if lod.n_corners() != 3 {
            return Err(RenderError::NotTriangles { name: name.to_owned(), found: lod.n_corners() });
        }
        lod.verify().map_err(|source| RenderError::Verify { name: name.to_owned(), source })?;
        let vertex = wgpu::BufferUsages::VERTEX;
        let positions = bytemuck::cast_slice(lod.vertices());
        let normals = vertex_normals(&lod);
        let indices = bytemuck::cast_slice(lod.indices());
        let geometry = Geometry {
            positions: gpu.static_buffer(name, "positions", positions, vertex)?,
            normals: gpu.static_buffer(name, "normals", bytemuck::cast_slice(&normals), vertex)?,
            indices: gpu.static_buffer(name, "triangles", indices, wgpu::BufferUsages::INDEX)?,
        };
        Ok(Self { lod, geometry, up })
    }

    /// The levels.
    pub fn lod(&self) -> &Lod {
        &self.lod
    }

    /// The static buffers.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Bytes of the vertex buffers on the device.
    pub fn vertex_bytes(&self) -> usize {
        self.lod.vertices().len() * (size_of::<[f32; 3]>() + size_of::<[i16; 4]>())
    }

    /// The same vertices with other triangles, for a caller that copies levels out.
    ///
    /// # Errors
    ///
    /// [`RenderError::BufferTooLarge`], [`RenderError::Refused`].
    pub fn geometry_with(&self, gpu: &Gpu, indices: &[u32]) -> Result<Geometry, RenderError> {
        let indices = bytemuck::cast_slice(indices);
        let indices = gpu.static_buffer("copy", "triangles", indices, wgpu::BufferUsages::INDEX)?;
        Ok(Geometry { indices, ..self.geometry.clone() })
    }

    /// Radius of the sphere around the mesh, in mesh units; 1 for a mesh of one point.
    pub(crate) fn radius(&self) -> f64 {
        let (_, radius) = self.lod.bounding_sphere();
        if radius > 0.0 { radius } else { 1.0 }
    }

    /// The transform from mesh units to a mesh of radius 1 that stands upright on the origin, and
    /// the height of its centre there.
    #[expect(clippy::cast_possible_truncation, reason = "positions on the device are f32")]
    pub(crate) fn standing(&self) -> (Mat4, f32) {
        let (centre, _) = self.lod.bounding_sphere();
        let scale = 1.0 / self.radius();
        let (min, _) = self.lod.bounds();
        let (up, turn) = match self.up {
            Up::Y => (1, Mat4::IDENTITY),
            Up::Z => (2, Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2)),
        };
        let height = ((centre[up] - f64::from(min[up])) * scale) as f32;
        let to_centre = Mat4::from_translation(-Vec3::from_array(centre.map(|x| x as f32)));
        let lift = Mat4::from_translation(Vec3::Y * height);
        (lift * turn * Mat4::from_scale(Vec3::splat(scale as f32)) * to_centre, height)
    }
}
