//! What one frame draws.

use crate::Model;
use std::ops::Range;

/// One instance as the vertex shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct InstanceRecord {
    /// The first three rows of the matrix from mesh units to the scene.
    pub rows: [[f32; 4]; 3],
    /// Linear red, green and blue; the fourth is unused.
    pub color: [f32; 4],
}

/// Instances of one model at one level: they share its runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Which model.
    pub model: usize,
    /// Its level.
    pub level: u32,
    /// Which records.
    pub instances: Range<u32>,
}

/// One call of `draw_indexed`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Draw {
    /// Whose buffers are read.
    pub model: usize,
    /// A contiguous range of its index buffer.
    pub indices: Range<u32>,
    /// Which records.
    pub instances: Range<u32>,
}

/// The lists of one frame, kept from frame to frame to reuse their memory.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Instances in the picture, those of a group together.
    pub instances: Vec<InstanceRecord>,
    /// Levels in use.
    pub groups: Vec<Group>,
    /// Draw calls.
    pub draws: Vec<Draw>,
}

impl Frame {
    /// Lists the draw calls: one for every run of every group.
    ///
    /// This is the whole cost of levels of detail on the way to the screen; no triangle is read.
    /// Ends of ranges fit in 32 bits because the device accepts no index buffer of 16 GiB.
    pub fn list_draws(&mut self, models: &[Model]) {
        self.draws.clear();
        for Group { model, level, instances } in &self.groups {
            let runs = models[*model].lod().at_level(*level).runs();
            self.draws.extend(runs.map(|run| Draw {
                model: *model,
                indices: 3 * run.start..3 * (run.start + run.len),
                instances: instances.clone(),
            }));
        }
    }

    /// Triangles in all draw calls.
    pub fn n_triangles(&self) -> u64 {
        self.draws.iter().map(|draw| draw.indices.len() as u64 / 3 * draw.instances.len() as u64).sum()
    }
}
