//! Promise: a mesh gives the same levels in every unit of length, from 1e-12 to 1e12 of it.
#![allow(clippy::cast_possible_truncation, reason = "coordinates are f32")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use nephrite::generate::{ball_volume, box_volume, torus};
use nephrite::measure::{MeasureOptions, measure, measure_fields};
use nephrite::{
    BuildOptions, History, JadeOptions, Placement, ProgressiveOptions, TetrahedronMesh, TriangleMesh,
    VolumeOptions, build, build_volume,
};

/// Powers of two near 1e-12, 1e-9 and so on.
const POWERS: [i32; 8] = [-40, -30, -20, -10, 10, 20, 30, 40];

fn scaled(positions: &[[f32; 3]], factor: f64) -> Vec<[f32; 3]> {
    positions.iter().map(|p| p.map(|x| (f64::from(x) * factor) as f32)).collect()
}

fn scaled_surface(mesh: &TriangleMesh, factor: f64) -> TriangleMesh {
    TriangleMesh { positions: scaled(&mesh.positions, factor), ..mesh.clone() }
}

fn scaled_volume(mesh: &TetrahedronMesh, factor: f64) -> TetrahedronMesh {
    TetrahedronMesh { positions: scaled(&mesh.positions, factor), ..mesh.clone() }
}

/// Checks that a history is another one with all lengths times `factor`, a power of two.
fn check<const N: usize>(name: &str, history: &History<N>, one: &History<N>, factor: f64) {
    assert!(history.simplices == one.simplices, "{name}: other simplices at a scale of {factor:e}");
    assert!(history.birth == one.birth && history.death == one.death, "{name} at {factor:e}");
    let expected: Vec<f64> = one.errors.iter().map(|error| error * factor).collect();
    assert_eq!(history.errors, expected, "{name} at {factor:e}");
    for (ours, theirs) in history.deviations.iter().zip(&one.deviations) {
        let factor = if ours.name == "planar quadric" { factor } else { 1.0 };
        let expected: Vec<f64> = theirs.values.iter().map(|value| value * factor).collect();
        assert_eq!(ours.values, expected, "{name}, {} at {factor:e}", ours.name);
    }
}

/// The error at half of the simplices.
fn half_error<const N: usize>(history: &History<N>) -> f64 {
    let n_alive = |step: u32| {
        let lives = history.birth.iter().zip(&history.death);
        lives.filter(|&(&birth, &death)| birth <= step && step < death).count()
    };
    let n_half = n_alive(0) / 2;
    let steps: Vec<u32> = (0..history.errors.len() as u32).collect();
    history.errors[steps.partition_point(|&step| n_alive(step) > n_half)]
}

#[test]
fn of_surfaces() {
    let mesh = torus(48, 24);
    let best = JadeOptions::certified(Placement::Best);
    let ways = [
        ("jade", BuildOptions::default()),
        ("jade that moves vertices", BuildOptions::with(best)),
        ("progressive", BuildOptions::with(ProgressiveOptions::default())),
    ];
    for (name, options) in ways {
        let built = |factor| build(scaled_surface(&mesh, factor), &options).unwrap();
        let one = built(1.0);
        for power in POWERS {
            let factor = 2.0_f64.powi(power);
            let scaled = built(factor);
            check(name, scaled.history(), one.history(), factor);
        }
        for factor in [1e-12, 1e12] {
            let error = half_error(built(factor).history()) / factor;
            let ratio = error / half_error(one.history());
            assert!((0.5..2.0).contains(&ratio), "{name}: {ratio} times the error at {factor:e}");
        }
    }
}

#[test]
fn of_volumes() {
    for mesh in [ball_volume(8), box_volume([7, 6, 5])] {
        let built = |factor| build_volume(&scaled_volume(&mesh, factor), &VolumeOptions::default());
        let one = built(1.0).unwrap();
        for power in POWERS {
            let factor = 2.0_f64.powi(power);
            let build = built(factor).unwrap();
            check("fusion", build.history(), one.history(), factor);
            assert_eq!(build.vertices().positions, scaled(one.vertices().positions, factor));
            assert_eq!(build.vertices().attributes, one.vertices().attributes);
        }
        for factor in [1e-12, 1e12] {
            let n_fusions = build_volume(&scaled_volume(&mesh, factor), &VolumeOptions::default())
                .unwrap()
                .fusions()
                .n_fusions;
            assert!(
                n_fusions.abs_diff(one.fusions().n_fusions) * 20 < one.fusions().n_fusions,
                "{n_fusions} at {factor:e}"
            );
        }
    }
}

#[test]
fn of_distances() {
    let [one, other] = [torus(24, 12), torus(12, 6)];
    let options = MeasureOptions { n_samples: 2000, ..MeasureOptions::default() };
    let volumes = [ball_volume(6), ball_volume(4)];
    let distance = measure(&one, &other, &options).unwrap();
    let fields = measure_fields(&volumes[0], &volumes[1]).unwrap();
    for factor in POWERS.map(|power| 2.0_f64.powi(power)).into_iter().chain([1e-12, 1e12]) {
        let scaled = [&one, &other].map(|mesh| scaled_surface(mesh, factor));
        let found = measure(&scaled[0], &scaled[1], &options).unwrap();
        for (found, expected) in [
            (found.max, distance.max),
            (found.rms, distance.rms),
            (found.mean, distance.mean),
            (found.lower_bound, distance.lower_bound),
            (found.upper_bound, distance.upper_bound),
        ] {
            let ratio = found / factor / expected;
            assert!((ratio - 1.0).abs() < 1e-4, "{ratio} times the distance at a scale of {factor:e}");
        }
        let scaled = [&volumes[0], &volumes[1]].map(|volume| scaled_volume(volume, factor));
        for (found, expected) in measure_fields(&scaled[0], &scaled[1]).unwrap().iter().zip(&fields) {
            assert!((found.max / expected.max - 1.0).abs() < 1e-4 && found.n_outside == expected.n_outside);
        }
    }
}
