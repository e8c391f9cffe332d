//! The graphics device.

use crate::RenderError;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// A device without a window.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    adapter: String,
}

impl Gpu {
    /// The best adapter that a Vulkan driver offers; a software one if there is no other.
    ///
    /// # Errors
    ///
    /// [`RenderError::NoAdapter`], [`RenderError::NoDevice`].
    pub fn new() -> Result<Self, RenderError> {
        let descriptor = wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        };
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter =
            pollster::block_on(instance.request_adapter(&options)).map_err(RenderError::NoAdapter)?;
        let name = adapter.get_info().name;
        let descriptor =
            wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|source| RenderError::NoDevice { adapter: name.clone(), source })?;
        Ok(Self { device, queue, adapter: name })
    }

    /// Name of the adapter.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Calls `act` and turns a refusal of the device into an error.
    pub(crate) fn checked<T>(&self, what: &'static str, act: impl FnOnce() -> T) -> Result<T, RenderError> {
        let filters =
            [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let done = act();
        // Scopes close in the reverse order of their opening.
        for scope in scopes.into_iter().rev() {
            if let Some(source) = pollster::block_on(scope.pop()) {
                return Err(RenderError::Refused { what, source });
            }
        }
        Ok(done)
    }

    /// A buffer that is filled once.
    pub(crate) fn static_buffer(
        &self,
        name: &str,
        what: &'static str,
        contents: &[u8],
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, RenderError> {
        let limit = self.device.limits().max_buffer_size;
        let found = contents.len() as u64;
        if found > limit {
            return Err(RenderError::BufferTooLarge { name: name.to_owned(), what, found, limit });
        }
        let descriptor = BufferInitDescriptor { label: Some(what), contents, usage };
        self.checked("a buffer", || self.device.create_buffer_init(&descriptor))
    }
}
