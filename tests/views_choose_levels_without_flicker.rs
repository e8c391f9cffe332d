//! Promise: a view gets the coarsest level within its tolerance, and a caller that asks every frame
//! gets no flicker.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{Lod, Picker, Projection, View};
use support::synthetic::{Random, decimate, grid};

fn lod() -> Lod {
    let mesh = grid(30);
    let history = decimate(&mesh, usize::MAX, 6);
    Lod::from_bytes(&support::file_bytes(&mesh, &history, None)).unwrap()
}

fn view(lod: &Lod, distance: f64) -> View {
    let projection = Projection::Perspective { fov_y: 0.8, near: 0.1 };
    View { projection, height_px: 1080.0, distance, radius: lod.bounding_sphere().1, max_error_px: 1.0 }
}

#[test]
fn a_view_gets_the_coarsest_level_within_its_tolerance() {
    let lod = lod();
    let mut levels = Vec::new();
    for distance in (0..400).map(|step| 1.1f64.powi(step / 4) * 20.0) {
        let view = view(&lod, distance);
        let cut = lod.at_pixels(&view);
        assert!(view.error_px(cut.error()) <= 1.0);
        if cut.level() + 1 < lod.n_levels() {
            assert!(view.error_px(lod.at_level(cut.level() + 1).error()) > 1.0);
        }
        levels.push(cut.level());
    }
    // Close by, no error is small enough: the coarsest level without error.
    let exact = lod.at_error(0.0).level();
    assert!(levels.is_sorted() && levels[0] == exact && levels[399] == lod.n_levels() - 1);
}

#[test]
fn views_without_a_meaning_get_the_nearest_level() {
    let lod = lod();
    let good = view(&lod, 100.0);
    let level = |view: View| lod.at_pixels(&view).level();
    let (finest, coarsest) = (0, lod.n_levels() - 1);
    assert_eq!(level(View { height_px: 0.0, ..good }), coarsest);
    assert_eq!(level(View { distance: f64::INFINITY, ..good }), coarsest);
    for bad in [f64::NAN, -1.0] {
        assert_eq!(level(View { height_px: bad, ..good }), finest);
        assert_eq!(level(View { max_error_px: bad, ..good }), finest);
        assert_eq!(level(View { projection: Projection::Orthographic { height: bad }, ..good }), finest);
    }
    assert_eq!(level(View { distance: f64::NAN, ..good }), finest);
    let mut picker = Picker::default();
    assert_eq!(picker.pick(&lod, &View { height_px: f64::NAN, ..good }).level(), finest);
    assert_eq!(picker.pick(&lod, &View { height_px: 0.0, ..good }).level(), coarsest);
}

#[test]
fn a_trembling_view_settles_on_one_level() {
    let lod = lod();
    let mut random = Random(1);
    let mut n_switches_without_memory = 0;
    for distance in (1..60).map(|step| 40.0 * 1.1f64.powi(step)) {
        let mut picker = Picker::default();
        let (mut before, mut plain_before) = (0, 0);
        let mut n_switches = 0;
        for frame in 0..100u32 {
            let trembling = distance * (1.0 + 0.05 * random.below(1000) as f64 / 1000.0);
            let view = view(&lod, trembling);
            let cut = picker.pick(&lod, &view);
            assert_eq!(picker.level(), Some(cut.level()));
            assert!(view.error_px(cut.error()) <= 1.0, "the tolerance holds in every frame");
            let plain = lod.at_pixels(&view).level();
            assert!(cut.level() <= plain);
            if frame > 0 {
                // Only to a finer level, never back and forth.
                assert!(cut.level() <= before);
                n_switches += u32::from(cut.level() != before);
                n_switches_without_memory += u32::from(plain != plain_before);
            }
            (before, plain_before) = (cut.level(), plain);
        }
        assert!(n_switches < 12, "{n_switches}");
    }
    assert!(n_switches_without_memory > 500, "{n_switches_without_memory}");
}

#[test]
fn the_picker_follows_a_view_that_moves() {
    let lod = lod();
    let mut picker = Picker::default();
    let exact = lod.at_error(0.0).level();
    picker.pick(&lod, &view(&lod, 0.0));
    assert_eq!(picker.level(), Some(exact));
    let far = picker.pick(&lod, &view(&lod, 1e9)).level();
    assert_eq!(far, lod.n_levels() - 1);
    assert_eq!(picker.pick(&lod, &view(&lod, 0.0)).level(), exact);
}
