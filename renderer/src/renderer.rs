//! From the lists of a frame to a picture.

use crate::frame::{Draw, Frame};
use crate::pipelines::Pipelines;
use crate::target::Target;
use crate::{Camera, Geometry, Gpu, Picture, RenderError};
use glam::{Mat4, Vec3};

/// How triangles are shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Shading {
    /// Normals of the finest level, at every level.
    #[default]
    Smooth,
    /// The plane of each triangle.
    Flat,
}

/// The scene as the shaders read it.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SceneRecord {
    view_projection: [[f32; 4]; 4],
    to_world: [[f32; 4]; 4],
    eye_and_flat: [f32; 4],
    sun_and_haze: [f32; 4],
}

/// Direction of the sun; normalised where it is used.
const TO_SUN: Vec3 = Vec3::new(0.55, 0.75, 0.35);
/// Distance at which haze takes about two thirds of the colour, in units of the scene.
const HAZE: f32 = 90.0;

/// Draws frames of one size.
#[derive(Debug)]
pub struct Renderer<'a> {
    gpu: &'a Gpu,
    pipelines: Pipelines,
    scene: wgpu::Buffer,
    scene_group: wgpu::BindGroup,
    target: Target,
    shading: Shading,
}

impl<'a> Renderer<'a> {
    /// For pictures of the given width and height.
    ///
    /// # Errors
    ///
    /// [`RenderError::PictureSize`], [`RenderError::Refused`].
    pub fn new(gpu: &'a Gpu, size_px: [u32; 2], shading: Shading) -> Result<Self, RenderError> {
        let target = Target::new(gpu, size_px)?;
        let (scene, layout, scene_group) = gpu.checked("a uniform buffer", || scene_group(gpu))?;
        Ok(Self { gpu, pipelines: Pipelines::new(gpu, &layout)?, scene, scene_group, target, shading })
    }

    /// Draws a frame and waits until it is done. `geometries` are what [`Draw::model`] refers to.
    ///
    /// # Errors
    ///
    /// [`RenderError::BufferTooLarge`], [`RenderError::Refused`], [`RenderError::Poll`].
    pub fn draw(&self, camera: &Camera, frame: &Frame, geometries: &[Geometry]) -> Result<(), RenderError> {
        let records = bytemuck::cast_slice(&frame.instances);
        let instances = self.gpu.static_buffer("field", "instances", records, wgpu::BufferUsages::VERTEX)?;
        self.gpu.checked("a frame", || {
            self.gpu.queue.write_buffer(&self.scene, 0, bytemuck::bytes_of(&self.scene_record(camera)));
            let mut encoder =
                self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = self.target.begin(&mut encoder);
            pass.set_bind_group(0, &self.scene_group, &[]);
            pass.set_pipeline(&self.pipelines.backdrop);
            pass.draw(0..3, 0..1);
            if !frame.instances.is_empty() {
                pass.set_vertex_buffer(2, instances.slice(..));
                for pipeline in [&self.pipelines.shadows, &self.pipelines.objects] {
                    pass.set_pipeline(pipeline);
                    draw_runs(&mut pass, &frame.draws, geometries);
                }
            }
            drop(pass);
            self.gpu.queue.submit([encoder.finish()]);
        })?;
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(())
    }

    /// Reads the picture back.
    ///
    /// # Errors
    ///
    /// [`RenderError::Refused`], [`RenderError::Poll`], [`RenderError::Map`].
    pub fn picture(&self) -> Result<Picture, RenderError> {
        self.target.read(self.gpu)
    }

    fn scene_record(&self, camera: &Camera) -> SceneRecord {
        let view_projection: Mat4 = camera.view_projection();
        let flat = if self.shading == Shading::Flat { 1.0 } else { 0.0 };
        SceneRecord {
            view_projection: view_projection.to_cols_array_2d(),
            to_world: view_projection.inverse().to_cols_array_2d(),
            eye_and_flat: camera.eye().extend(flat).to_array(),
            sun_and_haze: TO_SUN.normalize().extend(HAZE).to_array(),
        }
    }
}

/// One call per run; buffers are bound again only if the model changes.
fn draw_runs(pass: &mut wgpu::RenderPass<'_>, draws: &[Draw], geometries: &[Geometry]) {
    for of_model in draws.chunk_by(|before, after| before.model == after.model) {
        let Geometry { positions, normals, indices } = &geometries[of_model[0].model];
        // Empty buffers cannot be bound.
        if positions.size() == 0 || indices.size() == 0 {
            continue;
        }
        pass.set_vertex_buffer(0, positions.slice(..));
        pass.set_vertex_buffer(1, normals.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        for draw in of_model {
            pass.draw_indexed(draw.indices.clone(), 0, draw.instances.clone());
        }
    }
}

fn scene_group(gpu: &Gpu) -> (wgpu::Buffer, wgpu::BindGroupLayout, wgpu::BindGroup) {
    let scene = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("scene"),
        size: size_of::<SceneRecord>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("scene"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("scene"),
        layout: &layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: scene.as_entire_binding() }],
    });
    (scene, layout, group)
}
