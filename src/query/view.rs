//! From an error in mesh units to an error on the screen, and back.

use super::{Cut, Lod};

/// How a camera makes lengths into pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Lengths shrink with distance.
    Perspective {
        /// Angle that the height of the picture covers, in radians, below pi.
        fov_y: f64,
        /// Distance of the near plane, in mesh units: nothing is drawn closer.
        near: f64,
    },
    /// Lengths do not shrink.
    Orthographic {
        /// Length that the height of the picture covers, in mesh units.
        height: f64,
    },
}

/// An object as one camera sees it, and the error that its picture may have.
///
/// Lengths are in mesh units; for an instance scaled by `s`, divide the lengths of the scene by
/// `s`. The object is taken as the sphere around it ([`Lod::bounding_sphere`]), and the error
/// counts where the sphere is closest to the camera. In the corners of a wide picture a point is
/// closer in depth than in distance; there, use the depth of the centre as `distance`.
///
/// Heights, angle and tolerance should be positive numbers. Zero height gives the coarsest level,
/// because nothing is visible. A negative or NaN limit on the error gives the finest level.
///
/// ```
/// use nephrite::{Projection, View};
/// let projection = Projection::Perspective { fov_y: 90f64.to_radians(), near: 0.1 };
/// let (height_px, distance, radius, max_error_px) = (1000.0, 11.0, 1.0, 1.0);
/// let view = View { projection, height_px, distance, radius, max_error_px };
/// // 1,000 pixels cover a length of 20 at distance 10.
/// assert!((view.error_px(0.02) - 1.0).abs() < 1e-12);
/// assert!((view.max_error() - 0.02).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub projection: Projection,
    /// Height of the picture, in pixels.
    pub height_px: f64,
    /// From the eye to the centre of the sphere around the object.
    pub distance: f64,
    /// Radius of the sphere around the object.
    pub radius: f64,
    /// Largest error that is allowed, in pixels.
    pub max_error_px: f64,
}

impl View {
    /// The largest error in mesh units that stays within [`max_error_px`](Self::max_error_px).
    pub fn max_error(&self) -> f64 {
        self.max_error_px * self.covered_length() / self.height_px
    }

    /// Largest number of pixels that an error in mesh units can appear as.
    pub fn error_px(&self, error: f64) -> f64 {
        error * self.height_px / self.covered_length()
    }

    /// Length in mesh units that the height of the picture covers where the object is closest.
    fn covered_length(&self) -> f64 {
        match self.projection {
            Projection::Perspective { fov_y, near } => {
                // A NaN must survive the comparison with the near plane.
                let closest = self.distance - self.radius;
                let depth = if closest < near { near } else { closest };
                2.0 * (fov_y / 2.0).tan() * depth
            }
            Projection::Orthographic { height } => height,
        }
    }
}

impl Lod {
    /// The coarsest level whose error is at most [`View::max_error_px`] pixels:
    /// [`at_error`](Self::at_error) of [`View::max_error`]. Callers that ask every frame use a
    /// [`Picker`](super::Picker).
    pub fn at_pixels(&self, view: &View) -> Cut<'_> {
        self.at_error(view.max_error())
    }

    /// Centre, relative to [`origin`](Self::origin), and radius of the sphere around
    /// [`bounds`](Self::bounds). It contains all vertices.
    pub fn bounding_sphere(&self) -> ([f64; 3], f64) {
        let (min, max) = self.bounds();
        let centre = std::array::from_fn(|i| f64::midpoint(f64::from(min[i]), f64::from(max[i])));
        (centre, self.bounding_diagonal() / 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: View = View {
        projection: Projection::Perspective { fov_y: 1.0, near: 0.5 },
        height_px: 720.0,
        distance: 10.0,
        radius: 2.0,
        max_error_px: 1.5,
    };

    #[test]
    fn pixels_follow_the_formula_and_its_inverse() {
        for distance in [0.0, 2.4, 2.6, 10.0, 1e9] {
            let view = View { distance, ..VIEW };
            let expected = 0.01 * 720.0 / (2.0 * 0.5f64.tan() * (distance - 2.0).max(0.5));
            assert!((view.error_px(0.01) / expected - 1.0).abs() < 1e-12);
            assert!((view.error_px(view.max_error()) / 1.5 - 1.0).abs() < 1e-12);
        }
        let projection = Projection::Orthographic { height: 3.0 };
        for distance in [-5.0, 0.0, 1e9] {
            let view = View { projection, distance, ..VIEW };
            assert_eq!(view.error_px(0.01), 2.4);
            assert_eq!(view.max_error(), 0.00625);
        }
    }

    #[test]
    fn views_without_a_meaning_allow_everything_or_nothing() {
        let perspective = |fov_y, near| View { projection: Projection::Perspective { fov_y, near }, ..VIEW };
        let orthographic = |height| View { projection: Projection::Orthographic { height }, ..VIEW };
        let everything = [
            View { height_px: 0.0, ..VIEW },
            View { distance: f64::INFINITY, ..VIEW },
            View { max_error_px: f64::INFINITY, ..VIEW },
            orthographic(f64::INFINITY),
        ];
        let nan = f64::NAN;
        let nothing = [
            View { height_px: -1.0, ..VIEW },
            View { height_px: nan, ..VIEW },
            View { height_px: 0.0, max_error_px: 0.0, ..VIEW },
            View { distance: nan, ..VIEW },
            View { radius: nan, ..VIEW },
            View { max_error_px: nan, ..VIEW },
            View { max_error_px: -1.0, ..VIEW },
            perspective(nan, 0.5),
            perspective(-1.0, 0.5),
            perspective(4.0, 0.5),
            orthographic(-1.0),
            orthographic(nan),
        ];
        assert!(everything.iter().all(|view| view.max_error() == f64::INFINITY));
        assert!(
            nothing.iter().map(View::max_error).all(|error| error.is_nan() || error < 0.0),
            "{nothing:?}"
        );
        // A NaN near plane counts as no near plane.
        assert_eq!(perspective(1.0, nan).max_error(), VIEW.max_error());
    }
}
