//! Times and counts of a flight.

use serde::Serialize;
use std::fmt;

/// One file.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ModelStatistics {
    /// Its name.
    pub(crate) name: String,
    /// Triangles of the finest level.
    pub(crate) triangles: usize,
    /// Its levels.
    pub(crate) levels: u32,
    /// Length of the static index buffer.
    pub(crate) index_bytes: usize,
    /// Length of the static buffers of positions and normals.
    pub(crate) vertex_bytes: usize,
}

/// One frame.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct FrameStatistics {
    /// Its number.
    pub(crate) frame: u32,
    /// Instances in the picture.
    pub(crate) instances: usize,
    /// Different levels among them, counted by file.
    pub(crate) levels: usize,
    /// Instances whose level differs from the last frame in which they were seen.
    pub(crate) switches: usize,
    /// Calls that draw the objects: runs of all levels in use. Shadows take as many again.
    pub(crate) draws: usize,
    /// Triangles drawn, shadows left out.
    pub(crate) triangles: u64,
    /// Triangles if every instance were drawn at the finest level.
    pub(crate) triangles_finest: u64,
    /// Time to choose all levels and list all draw calls, in nanoseconds.
    pub(crate) query_ns: u64,
    /// Time to draw, until the device is done, in milliseconds.
    pub(crate) draw_ms: f64,
}

impl fmt::Display for FrameStatistics {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frame, instances, levels, switches, draws, triangles, .. } = self;
        write!(
            to,
            "frame {frame}: {instances} instances at {levels} levels ({switches} switched), {triangles} of {} triangles in \
             {draws} draws, {:.1} us for all queries, {:.1} ms to draw",
            self.triangles_finest,
            self.query_ns as f64 / 1e3,
            self.draw_ms,
        )
    }
}

/// A whole flight.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Statistics {
    /// What drew it.
    pub(crate) adapter: String,
    /// The files.
    pub(crate) models: Vec<ModelStatistics>,
    /// Instances in the field.
    pub(crate) instances: usize,
    /// Largest error allowed on the screen, in pixels.
    pub(crate) max_error_px: f64,
    /// Frame by frame.
    pub(crate) frames: Vec<FrameStatistics>,
}
