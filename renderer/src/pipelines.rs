//! The three pipelines of a frame.

use crate::frame::InstanceRecord;
use crate::{Gpu, RenderError};

/// Colours are computed linearly and stored in sRGB.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Depth is 1 at the near plane and 0 at infinity, where floats are densest.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Samples per pixel.
pub(crate) const N_SAMPLES: u32 = 4;

/// Pipelines, in drawing order.
#[derive(Debug)]
pub(crate) struct Pipelines {
    /// Sky and ground, over the whole picture.
    pub(crate) backdrop: wgpu::RenderPipeline,
    /// Objects flattened onto the ground. Nothing is below the ground, so depth plays no part.
    pub(crate) shadows: wgpu::RenderPipeline,
    /// Objects.
    pub(crate) objects: wgpu::RenderPipeline,
}

/// One of them.
struct Kind {
    vertex: &'static str,
    fragment: &'static str,
    has_vertices: bool,
    has_depth: bool,
}

impl Pipelines {
    /// Compiles the shaders; group 0 is laid out as `scene`.
    pub(crate) fn new(gpu: &Gpu, scene: &wgpu::BindGroupLayout) -> Result<Self, RenderError> {
        gpu.checked("the shaders", || {
            let module = gpu.device.create_shader_module(wgpu::include_wgsl!("shader.wgsl"));
            let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                bind_group_layouts: &[Some(scene)],
                ..wgpu::PipelineLayoutDescriptor::default()
            });
            let pipeline = |vertex, fragment, has_vertices, has_depth| {
                pipeline(gpu, &module, &layout, &Kind { vertex, fragment, has_vertices, has_depth })
            };
            Self {
                backdrop: pipeline("backdrop_vertex", "backdrop_fragment", false, false),
                shadows: pipeline("shadow_vertex", "shadow_fragment", true, false),
                objects: pipeline("object_vertex", "object_fragment", true, true),
            }
        })
    }
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    kind: &Kind,
) -> wgpu::RenderPipeline {
    let depth_compare =
        if kind.has_depth { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Always };
    let buffers = vertex_buffers().map(Some);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(kind.fragment),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(kind.vertex),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: if kind.has_vertices { &buffers } else { &[] },
        },
        // Scanned surfaces have holes: both sides are drawn.
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(kind.has_depth),
            depth_compare: Some(depth_compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: N_SAMPLES, ..wgpu::MultisampleState::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(kind.fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(COLOR_FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Positions as in the file, normals, and one record per instance.
fn vertex_buffers() -> [wgpu::VertexBufferLayout<'static>; 3] {
    const POSITION: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![0 => Float32x3];
    const NORMAL: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![1 => Snorm16x4];
    const INSTANCE: &[wgpu::VertexAttribute] =
        &wgpu::vertex_attr_array![2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4];
    let buffer = |bytes, step_mode, attributes| wgpu::VertexBufferLayout {
        array_stride: bytes,
        step_mode,
        attributes,
    };
    [
        buffer(12, wgpu::VertexStepMode::Vertex, POSITION),
        buffer(8, wgpu::VertexStepMode::Vertex, NORMAL),
        buffer(size_of::<InstanceRecord>() as u64, wgpu::VertexStepMode::Instance, INSTANCE),
    ]
}
