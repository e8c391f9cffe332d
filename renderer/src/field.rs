//! Many instances on a plane, and the level of each.

use crate::color::{Color, color};
use crate::frame::{Frame, Group, InstanceRecord};
use crate::{Camera, Model};
use glam::{Mat4, Vec3};
use nephrite::{Picker, View};
use std::time::{Duration, Instant};

/// Distance between neighbours, in radii of an instance.
const SPACING: f32 = 2.3;
/// Sizes vary by this part to either side.
const SIZE_SPREAD: f32 = 0.2;
/// How far a shadow reaches beyond its object, in its radii.
const SHADOW_REACH: f32 = 3.0;

/// How a frame is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// The camera.
    pub camera: Camera,
    /// Largest error on the screen, in pixels.
    pub max_error_px: f64,
    /// What colours mean.
    pub color: Color,
}

/// Instances of some models, scattered over a square around the origin.
#[derive(Debug)]
pub struct Field {
    instances: Vec<Instance>,
    half: f32,
    /// Buffer of a frame: instances in the picture.
    seen: Vec<Seen>,
}

#[derive(Debug)]
struct Instance {
    model: usize,
    to_scene: Mat4,
    centre: Vec3,
    /// Radius in the scene.
    radius: f32,
    picker: Picker,
}

#[derive(Debug)]
struct Seen {
    instance: usize,
    view: View,
}

/// What the choice of the levels of a frame took and gave.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice {
    /// Instances whose level differs from the last frame in which they were seen.
    pub n_switches: usize,
    /// Time to find the levels of all instances in the picture and the runs of all groups.
    pub query_time: Duration,
}

impl Field {
    /// Scatters `n_instances` of the models, of which there must be at least one. The same numbers
    /// give the same field.
    pub fn new(models: &[Model], n_instances: usize) -> Self {
        let n_columns = (1..).find(|n| n * n >= n_instances).unwrap_or(1);
        // Fields have at most a million instances: places are exact in f32.
        let half = SPACING * n_columns as f32 / 2.0;
        let place = |index: usize| {
            let [x, z] = [index % n_columns, index / n_columns].map(|i| (i as f32 + 0.5) * SPACING - half);
            Vec3::new(x, 0.0, z)
        };
        let instances = (0..n_instances).map(|index| {
            let model = index % models.len();
            let [dx, dz, turn, size] = [0, 1, 2, 3].map(|salt| scatter(index, salt));
            let place = place(index) + 0.35 * Vec3::new(dx, 0.0, dz);
            let size = 1.0 + SIZE_SPREAD * size;
            let (standing, height) = models[model].standing();
            let to_scene = Mat4::from_translation(place)
                * Mat4::from_rotation_y(std::f32::consts::PI * turn)
                * Mat4::from_scale(Vec3::splat(size));
            Instance {
                model,
                to_scene: to_scene * standing,
                centre: place + Vec3::Y * (size * height),
                radius: size,
                picker: Picker::default(),
            }
        });
        Self { instances: instances.collect(), half, seen: Vec::new() }
    }

    /// Number of instances.
    pub fn len(&self) -> usize {
        self.instances.len()
    }

    /// Whether the field has no instances.
    pub fn is_empty(&self) -> bool {
        self.instances.is_empty()
    }

    /// Half the side of the square.
    pub fn half(&self) -> f32 {
        self.half
    }

    /// Chooses a level for every instance in the picture and lists what to draw.
    pub fn choose(&mut self, models: &[Model], look: &Look, frame: &mut Frame) -> Choice {
        self.look_around(models, look);
        let started = Instant::now();
        let n_switches = self.pick_levels(models);
        let mut query_time = started.elapsed();
        self.group(models, look.color, frame);
        let started = Instant::now();
        frame.list_draws(models);
        query_time += started.elapsed();
        Choice { n_switches, query_time }
    }

    /// Finds the instances in the picture.
    fn look_around(&mut self, models: &[Model], look: &Look) {
        self.seen.clear();
        for (instance, at) in self.instances.iter().enumerate() {
            if look.camera.sees(at.centre, SHADOW_REACH * at.radius) {
                let radius = models[at.model].radius();
                let scale = f64::from(at.radius) / radius;
                let view = look.camera.view(at.centre, radius, scale, look.max_error_px);
                self.seen.push(Seen { instance, view });
            }
        }
    }

    /// Asks every picker; returns how many changed their level.
    fn pick_levels(&mut self, models: &[Model]) -> usize {
        let mut n_switches = 0;
        for Seen { instance, view } in &self.seen {
            let Instance { model, picker, .. } = &mut self.instances[*instance];
            let before = picker.level();
            let level = picker.pick(models[*model].lod(), view).level();
            n_switches += usize::from(before.is_some_and(|before| before != level));
        }
        n_switches
    }

    /// Puts instances with the same runs together.
    fn group(&mut self, models: &[Model], color_by: Color, frame: &mut Frame) {
        let key = |instance: usize| {
            let at = &self.instances[instance];
            (at.model, at.picker.level().unwrap_or(0))
        };
        self.seen.sort_unstable_by_key(|seen| (key(seen.instance), seen.instance));
        frame.instances.clear();
        frame.groups.clear();
        for (place, seen) in (0u32..).zip(&self.seen) {
            let (model, level) = key(seen.instance);
            match frame.groups.last_mut() {
                Some(last) if (last.model, last.level) == (model, level) => last.instances.end = place + 1,
                _ => frame.groups.push(Group { model, level, instances: place..place + 1 }),
            }
            let n_levels = models[model].lod().n_levels();
            let color = color(color_by, [level, n_levels], scatter(seen.instance, 4));
            let rows = self.instances[seen.instance].to_scene.transpose();
            let rows = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.to_array());
            frame.instances.push(InstanceRecord { rows, color });
        }
    }
}

/// A number from -1 to 1 that looks random.
///
/// Reference: G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom number
/// generators" (OOPSLA 2014), with the constants of the finaliser published as splitmix64.
fn scatter(index: usize, salt: u64) -> f32 {
    let mut bits = (index as u64 * 8 + salt + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    // 24 bits are exact in f32.
    ((bits ^ (bits >> 31)) >> 40) as f32 / 8_388_608.0 - 1.0
}
