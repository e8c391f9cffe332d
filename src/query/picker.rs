//! Choosing a level every frame, without flicker.

use super::{Cut, Lod, View};

/// Part of the tolerance that a coarser level must leave free before it is chosen.
const SLACK: f64 = 0.2;

/// Remembers the level of one object from frame to frame, so that small movements of the camera do
/// not make the level switch back and forth.
///
/// A finer level is chosen at once: the error on the screen never exceeds [`View::max_error_px`]. A
/// coarser level is chosen only if it leaves a fifth of that free. A finer level therefore stays
/// until the distance has grown by a quarter. A picker is two words long and freely copied.
///
/// ```no_run
/// # use nephrite::{Picker, Projection, View};
/// # let lod = nephrite::Lod::open("bunny.neph")?;
/// # let distances = [2.0, 2.01, 2.0];
/// let (_, radius) = lod.bounding_sphere();
/// let projection = Projection::Perspective { fov_y: 1.0, near: 0.01 };
/// let mut picker = Picker::default();
/// for distance in distances {
///     let view = View { projection, height_px: 1080.0, distance, radius, max_error_px: 1.0 };
///     let cut = picker.pick(&lod, &view);
///     assert!(view.error_px(cut.error()) <= 1.0);
/// }
/// # Ok::<(), nephrite::OpenError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Picker {
    level: Option<u32>,
}

impl Picker {
    /// The level for this frame: [`Lod::at_pixels`] the first time, afterwards as described for the
    /// type. A picker belongs to one `Lod`; used with another one, its first answer may be finer
    /// than necessary. Cost: two binary searches over the levels.
    pub fn pick<'a>(&mut self, lod: &'a Lod, view: &View) -> Cut<'a> {
        let coarsest_allowed = lod.at_pixels(view);
        let cut = match self.level {
            Some(level) if level < coarsest_allowed.level() => {
                let roomy = View { max_error_px: view.max_error_px * (1.0 - SLACK), ..*view };
                lod.at_level(lod.at_pixels(&roomy).level().max(level))
            }
            _ => coarsest_allowed,
        };
        self.level = Some(cut.level());
        cut
    }

    /// Level of the last frame, if there was one.
    pub fn level(&self) -> Option<u32> {
        self.level
    }
}
