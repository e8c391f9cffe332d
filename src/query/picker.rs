//! Choosing a level every frame, without flicker.

use super::{Cut, Lod, View};

/// Part of the tolerance that a coarser level must leave free before it is taken.
const SLACK: f64 = 0.2;

/// Remembers the level of one object from frame to frame, so that a view that trembles does not make it switch.
///
/// A finer level is taken at once: the error on the screen never exceeds [`View::max_error_px`]. A coarser one is taken only
/// if it leaves a fifth of that free. A level that was taken as a finer one is therefore kept until the view has come
/// further away by a quarter. Two words, copied freely; nothing is allocated.
///
/// ```no_run
/// # use nephrite::query::{Picker, Projection, View};
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
/// # Ok::<(), nephrite::store::OpenError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Picker {
    level: Option<u32>,
}

impl Picker {
    /// The level for this frame: [`Lod::at_pixels`] the first time, and afterwards as the type says. A picker belongs to one
    /// `Lod`; used with another, its first answer may be finer than necessary. Cost: two binary searches over the levels.
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

    /// Level of the frame before, if there was one.
    pub fn level(&self) -> Option<u32> {
        self.level
    }
}
