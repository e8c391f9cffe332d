//! Promise: a build that its observer breaks off ends as interrupted, at any call and in every
//! phase, and the observer is not called again.
#![allow(clippy::unwrap_used, reason = "tests")]

use nephrite::{
    BuildError, BuildOptions, Decimator, JadeOptions, Observer, Phase, ProgressiveOptions, VolumeOptions,
    build_volume_with, build_with, generate,
};
use std::ops::ControlFlow;
use std::sync::Mutex;

/// Runs a build with an observer that breaks at call `last`, counted from 0; returns the phases of
/// its calls and the end of the build.
fn run_until<T>(
    build: &dyn Fn(Observer<'_>) -> Result<T, BuildError>,
    last: usize,
) -> (Vec<Phase>, Result<T, BuildError>) {
    let phases = Mutex::new(Vec::new());
    let end = build(&|progress| {
        let mut phases = phases.lock().unwrap();
        phases.push(progress.phase);
        if phases.len() > last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    (phases.into_inner().unwrap(), end)
}

/// Breaks a build off at the first and the last call of each phase and at some between.
fn check<T: std::fmt::Debug>(name: &str, build: &dyn Fn(Observer<'_>) -> Result<T, BuildError>) {
    let (phases, end) = run_until(build, usize::MAX);
    assert!(end.is_ok(), "{name}");
    let mut n_told = 0;
    for phase in [Phase::Repair, Phase::Decimate] {
        let calls: Vec<usize> = (0..phases.len()).filter(|&call| phases[call] == phase).collect();
        assert!(!calls.is_empty(), "{name} says nothing of {phase:?}");
        n_told += calls.len();
        for call in [calls[0], calls[calls.len() / 3], calls[calls.len() / 2], calls[calls.len() - 1]] {
            let (told, end) = run_until(build, call);
            assert!(matches!(end, Err(BuildError::Interrupted)), "{name}, call {call}: {end:?}");
            assert_eq!(told, phases[..=call], "{name}: the same calls up to the break, and none after it");
        }
    }
    assert_eq!(n_told, phases.len(), "{name}: a phase without a test");
}

#[test]
fn surfaces() {
    let mesh = generate::terrain(70, 3);
    let decimators = [
        ("jade", Decimator::from(JadeOptions::default())),
        ("best placement", JadeOptions::certified(nephrite::Placement::Best).into()),
        ("jade under an estimate", JadeOptions::estimate(nephrite::EstimateKind::Joint).into()),
        ("progressive", ProgressiveOptions::default().into()),
    ];
    for (name, decimator) in decimators {
        let options = BuildOptions::with(decimator);
        check(name, &|observer| build_with(&mesh, &options, observer));
    }
}

#[test]
fn volumes() {
    let mesh = generate::ball_volume(8);
    check("fusion", &|observer| build_volume_with(&mesh, &VolumeOptions::default(), observer));
}
