//! The eye and its flight over the field.

use glam::camera::rh::proj::directx::perspective_infinite_reverse;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use nephrite::{Projection, View};

/// Angle that the height of the picture covers, in radians.
const FOV_Y: f32 = 0.7;
/// Distance of the near plane, in units of the scene.
const NEAR: f32 = 0.05;

/// A perspective camera over a scene whose ground is at height 0.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    eye: Vec3,
    target: Vec3,
    width_px: f32,
    height_px: f32,
}

impl Camera {
    /// From `eye` towards `target`, for a picture of a size that the device takes.
    pub fn new(eye: Vec3, target: Vec3, size_px: [u32; 2]) -> Self {
        // Sides of a picture are exact in f32 up to 2^24.
        let [width_px, height_px] = size_px.map(|side| side as f32);
        Self { eye, target, width_px, height_px }
    }

    /// The camera on a flight over a field of side `2 * half` around the origin, at `time` from 0
    /// to 1. It enters at an edge, sinks towards the ground while it swings to both sides, and
    /// rises again.
    pub fn on_flight(time: f32, half: f32, size_px: [u32; 2]) -> Self {
        let swing = (std::f32::consts::TAU * time).sin();
        let height = 2.6 - 0.8 * (std::f32::consts::PI * time).sin();
        let eye = Vec3::new(2.0 * swing, height, half + 1.7 - 1.6 * half * time);
        Self::new(eye, eye + Vec3::new(0.3 * swing, -0.24, -1.0), size_px)
    }

    /// The eye.
    pub(crate) fn eye(&self) -> Vec3 {
        self.eye
    }

    /// From the scene to clip space: depth is 1 at the near plane and 0 at infinity.
    pub(crate) fn view_projection(&self) -> Mat4 {
        let projection = perspective_infinite_reverse(FOV_Y, self.width_px / self.height_px, NEAR);
        projection * look_at_mat4(self.eye, self.target, Vec3::Y)
    }

    /// Whether a sphere may be in the picture.
    pub(crate) fn sees(&self, centre: Vec3, radius: f32) -> bool {
        let seen = look_at_mat4(self.eye, self.target, Vec3::Y).transform_point3(centre);
        let tan_y = (FOV_Y / 2.0).tan();
        let tan_x = tan_y * self.width_px / self.height_px;
        // Distance to a side plane through the eye, whose normal is (1, tan) / |(1, tan)|.
        let is_within =
            |off_axis: f32, tan: f32| off_axis.abs() + seen.z * tan <= radius * (1.0 + tan * tan).sqrt();
        -seen.z + radius >= NEAR && is_within(seen.x, tan_x) && is_within(seen.y, tan_y)
    }

    /// An object of the scene in its own units, for the choice of its level. `radius` is that of
    /// its sphere in mesh units, `scale` the length of a mesh unit in the scene.
    pub(crate) fn view(&self, centre: Vec3, radius: f64, scale: f64, max_error_px: f64) -> View {
        // Depth, not distance: in the corners of a picture an object is nearer to the picture's
        // plane than to the eye.
        let depth = (centre - self.eye).dot((self.target - self.eye).normalize_or(Vec3::NEG_Z));
        View {
            projection: Projection::Perspective { fov_y: FOV_Y.into(), near: f64::from(NEAR) / scale },
            height_px: self.height_px.into(),
            distance: f64::from(depth) / scale,
            radius,
            max_error_px,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_sees_what_projects_into_the_picture() {
        let camera = Camera::new(Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 1.5, -4.0), [640, 360]);
        let matrix = camera.view_projection();
        for i in 0..4000u16 {
            let [x, y, z] = [i % 20, i / 20 % 20, i / 400].map(|i| f32::from(i) - 9.7);
            let point = Vec3::new(x, y, z);
            let clip = matrix * point.extend(1.0);
            let is_inside = clip.w >= NEAR && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w;
            assert_eq!(camera.sees(point, 0.0), is_inside, "{point}");
            assert!(!is_inside || (0.0..=1.0).contains(&(clip.z / clip.w)));
        }
    }

    #[test]
    fn errors_on_the_screen_are_those_of_the_projection() {
        let camera = Camera::new(Vec3::ZERO, Vec3::NEG_Z, [640, 360]);
        let view = camera.view(Vec3::new(3.0, -1.0, -8.0), 2.0, 0.5, 1.0);
        // An error of 0.1 mesh units is 0.05 in the scene; the sphere of radius 1 comes as close as
        // depth 7.
        let at = |y: f32| camera.view_projection().project_point3(Vec3::new(0.0, y, -7.0)).y * 180.0;
        assert!((view.error_px(0.1) - f64::from(at(0.05) - at(0.0))).abs() < 1e-4);
    }
}
