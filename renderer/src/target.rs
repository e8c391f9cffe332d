//! The textures of a picture, and the way back to memory.

use crate::pipelines::{COLOR_FORMAT, DEPTH_FORMAT, N_SAMPLES};
use crate::{Gpu, Picture, RenderError};

/// Bytes per pixel of [`COLOR_FORMAT`].
const PIXEL_BYTES: u32 = 4;

/// Colour and depth of one picture.
#[derive(Debug)]
pub(crate) struct Target {
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    resolved: wgpu::Texture,
    resolved_view: wgpu::TextureView,
    read_back: wgpu::Buffer,
    /// Bytes from row to row of `read_back`.
    stride: u32,
}

impl Target {
    pub(crate) fn new(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<Self, RenderError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if [width, height].iter().any(|side| !(1..=limit).contains(side)) {
            return Err(RenderError::PictureSize { width, height, limit });
        }
        let stride = (width * PIXEL_BYTES).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        gpu.checked("a picture", || {
            let texture = |format, sample_count, usage| {
                gpu.device.create_texture(&wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                    mip_level_count: 1,
                    sample_count,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage,
                    view_formats: &[],
                })
            };
            let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
            let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
            let resolved = texture(COLOR_FORMAT, 1, drawn | wgpu::TextureUsages::COPY_SRC);
            Self {
                samples: view(&texture(COLOR_FORMAT, N_SAMPLES, drawn)),
                depth: view(&texture(DEPTH_FORMAT, N_SAMPLES, drawn)),
                resolved_view: view(&resolved),
                resolved,
                read_back: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("picture"),
                    size: u64::from(stride) * u64::from(height),
                    usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                    mapped_at_creation: false,
                }),
                stride,
            }
        })
    }

    /// Begins an empty picture.
    pub(crate) fn begin<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.samples,
                depth_slice: None,
                resolve_target: Some(&self.resolved_view),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        })
    }

    /// The picture drawn last.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Picture, RenderError> {
        let size = self.resolved.size();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(self.stride),
            rows_per_image: Some(size.height),
        };
        gpu.checked("a copy", || {
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let buffer = wgpu::TexelCopyBufferInfo { buffer: &self.read_back, layout };
            encoder.copy_texture_to_buffer(self.resolved.as_image_copy(), buffer, size);
            gpu.queue.submit([encoder.finish()]);
        })?;
        let (sender, receiver) = std::sync::mpsc::sync_channel(1);
        self.read_back.map_async(wgpu::MapMode::Read, .., move |mapped| {
            // The receiver is gone only if polling failed, which is reported there.
            let _ = sender.send(mapped);
        });
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        receiver.recv().unwrap_or(Err(wgpu::BufferAsyncError))?;
        let rows = self.read_back.get_mapped_range(..)?;
        let row_bytes = (size.width * PIXEL_BYTES) as usize;
        let pixels = rows.chunks(self.stride as usize).flat_map(|row| &row[..row_bytes]).copied().collect();
        drop(rows);
        self.read_back.unmap();
        Ok(Picture { width: size.width, height: size.height, pixels })
    }
}
