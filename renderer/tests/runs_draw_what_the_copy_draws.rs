//! Promise: levels drawn as runs of the static index buffer give the same pictures as copies of
//! them, pixel for pixel.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use nephrite::TriangleMesh;
use nephrite_renderer::{
    Camera, Color, Draw, Field, Frame, Geometry, Gpu, Group, InstanceRecord, Look, Model, Picture, Renderer,
    Shading, Up, knot, lod_of,
};

const SIZE_PX: [u32; 2] = [400, 260];

fn model(gpu: &Gpu, mesh: &TriangleMesh) -> Model {
    Model::upload(gpu, "test", lod_of(mesh).unwrap(), Up::Y).unwrap()
}

fn picture(renderer: &Renderer<'_>, camera: &Camera, frame: &Frame, geometries: &[Geometry]) -> Picture {
    renderer.draw(camera, frame, geometries).unwrap();
    renderer.picture().unwrap()
}

/// The picture of a frame drawn in runs.
fn by_runs(renderer: &Renderer<'_>, camera: &Camera, frame: &Frame, models: &[Model]) -> Picture {
    let geometries: Vec<Geometry> = models.iter().map(|model| model.geometry().clone()).collect();
    picture(renderer, camera, frame, &geometries)
}

/// The picture of the same groups, each drawn in one call from a copy of its level.
fn by_copies(
    gpu: &Gpu,
    renderer: &Renderer<'_>,
    camera: &Camera,
    frame: &Frame,
    models: &[Model],
) -> Picture {
    let mut copies = vec![Vec::new(); models.len()];
    let draws = frame.groups.iter().map(|group| {
        let (model, cut) = (group.model, models[group.model].lod().at_level(group.level));
        let start = copies[model].len();
        copies[model].resize(start + cut.n_indices(), 0);
        cut.extract_into(&mut copies[model][start..]).unwrap();
        let [start, end] = [start, copies[model].len()].map(|place| u32::try_from(place).unwrap());
        Draw { model, indices: start..end, instances: group.instances.clone() }
    });
    let copied = Frame { draws: draws.collect(), ..frame.clone() };
    let geometries: Vec<Geometry> =
        models.iter().zip(&copies).map(|(model, copy)| model.geometry_with(gpu, copy).unwrap()).collect();
    picture(renderer, camera, &copied, &geometries)
}

fn n_different(a: &Picture, b: &Picture) -> usize {
    assert_eq!((a.width, a.height, a.pixels.len()), (b.width, b.height, b.pixels.len()));
    a.pixels.chunks(4).zip(b.pixels.chunks(4)).filter(|(a, b)| a != b).count()
}

#[test]
fn every_level_drawn_as_runs_is_the_picture_of_its_copy() {
    let gpu = Gpu::new().unwrap();
    let models = [model(&gpu, &knot(3000))];
    let renderer = Renderer::new(&gpu, SIZE_PX, Shading::Flat).unwrap();
    let camera = Camera::new([0.0, 2.4, 3.2].into(), [0.0, 1.1, 0.0].into(), SIZE_PX);
    // The knot reaches some 3.5 to either side.
    let [right, up, near] = [[0.3, 0.0, 0.0, 0.0], [0.0, 0.3, 0.0, 1.2], [0.0, 0.0, 0.3, 0.0]];
    let instances = vec![InstanceRecord { rows: [right, up, near], color: [0.2, 0.5, 0.3, 1.0] }];
    let empty = by_runs(&renderer, &camera, &Frame::default(), &models);

    let last = models[0].lod().n_levels() - 1;
    let mut before: Option<Picture> = None;
    for level in [0, last / 4, last / 2, 3 * last / 4, last] {
        let groups = vec![Group { model: 0, level, instances: 0..1 }];
        let mut frame = Frame { instances: instances.clone(), groups, draws: Vec::new() };
        frame.list_draws(&models);
        let cut = models[0].lod().at_level(level);
        assert_eq!((frame.draws.len(), frame.n_triangles()), (cut.n_runs(), cut.n_simplices() as u64));

        let drawn = by_runs(&renderer, &camera, &frame, &models);
        let copied = by_copies(&gpu, &renderer, &camera, &frame, &models);
        assert_eq!(n_different(&drawn, &copied), 0, "level {level}");
        let n_pixels = drawn.pixels.len() / 4;
        assert!(n_different(&drawn, &empty) > n_pixels / 10, "level {level} is hardly there");
        if let Some(before) = &before {
            assert!(n_different(&drawn, before) > n_pixels / 100, "level {level} is no other picture");
        }
        let longest = (0..frame.draws.len()).max_by_key(|&draw| frame.draws[draw].indices.len()).unwrap();
        frame.draws.remove(longest);
        let lacking = by_runs(&renderer, &camera, &frame, &models);
        assert!(n_different(&drawn, &lacking) > 0, "a run that is missing at level {level} is not seen");
        before = Some(drawn);
    }
}

#[test]
fn a_flight_over_two_kinds_is_the_same_in_runs_and_in_copies() {
    let gpu = Gpu::new().unwrap();
    let models = [model(&gpu, &knot(3000)), model(&gpu, &nephrite::generate::sphere(12))];
    let renderer = Renderer::new(&gpu, SIZE_PX, Shading::Smooth).unwrap();
    let mut field = Field::new(&models, 120);
    let mut frame = Frame::default();
    let mut n_groups = 0;
    for time in [0.0, 0.4, 1.0] {
        let camera = Camera::on_flight(time, field.half(), SIZE_PX);
        let look = Look { camera, max_error_px: 1.0, color: Color::Level };
        let choice = field.choose(&models, &look, &mut frame);
        assert_eq!(choice.n_switches > 0, time > 0.0);
        let starts = frame.groups.iter().map(|group| group.instances.start);
        let ends = frame.groups.iter().map(|group| group.instances.end);
        assert!([0].into_iter().chain(ends).zip(starts).all(|(end, start)| end == start));
        n_groups += frame.groups.len();

        let drawn = by_runs(&renderer, &camera, &frame, &models);
        assert_eq!(n_different(&drawn, &by_copies(&gpu, &renderer, &camera, &frame, &models)), 0, "{time}");
    }
    assert!(n_groups > 30, "{n_groups} groups in three frames");
}

#[test]
fn a_tolerance_is_kept_and_a_tighter_one_takes_more_triangles() {
    let gpu = Gpu::new().unwrap();
    let models = [model(&gpu, &knot(3000))];
    let mut frame = Frame::default();
    let mut before = u64::MAX;
    for max_error_px in [1e-9, 0.3, 1.0, 5.0, 1e9] {
        let mut field = Field::new(&models, 100);
        let look =
            Look { camera: Camera::on_flight(0.0, field.half(), SIZE_PX), max_error_px, color: Color::Stone };
        field.choose(&models, &look, &mut frame);
        let finest = models[0].lod().at_level(0).n_simplices() * frame.instances.len();
        assert!(frame.n_triangles() < before);
        assert_eq!(frame.n_triangles() == finest as u64, max_error_px < 0.1);
        before = frame.n_triangles();
    }
}
