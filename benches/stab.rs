//! Finding a cut: error to level to runs, beside a linear scan over the lifetimes.

#![allow(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]
#![allow(missing_docs, reason = "criterion's macros write undocumented functions")]

mod support;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nephrite::{Levels, Lod};
use std::hint::black_box;

fn stab(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("stab");
    for (side, levels) in support::SIDES.into_iter().flat_map(|side| [(side, None), (side, Some(u32::MAX))]) {
        let lod = Lod::from_bytes(&support::file_bytes(side, levels)).unwrap();
        let errors = support::random_errors(&lod);
        let id = |name| {
            BenchmarkId::new(name, format!("{} lifetimes, {} levels", lod.n_lifetimes(), lod.n_levels()))
        };
        let mut next = errors.iter().cycle();
        group.bench_function(id("runs"), |bencher| {
            bencher.iter(|| {
                let cut = lod.at_error(black_box(*next.next().unwrap_or(&0.0)));
                cut.runs().map(|run| u64::from(run.start ^ run.len)).sum::<u64>()
            });
        });
        let lifetimes = lifetimes(side, levels);
        group.sample_size(10);
        group.bench_function(id("naive: linear scan"), |bencher| {
            bencher.iter(|| {
                let level = lod.at_error(black_box(*next.next().unwrap_or(&0.0))).level();
                lifetimes.iter().filter(|&&(birth, death)| birth <= level && level < death).count()
            });
        });
        group.sample_size(100);
    }
    group.finish();
}

fn lifetimes(side: usize, limit: Option<u32>) -> Vec<(u32, u32)> {
    let (_, history) = support::surface(side);
    let levels = Levels::choose(&history, limit).unwrap();
    let lives = history.birth.iter().zip(&history.death);
    lives
        .filter_map(|(&birth, &death)| levels.lifetime(birth, death))
        .map(|life| (life.birth(), life.death()))
        .collect()
}

criterion_group!(benches, stab);
criterion_main!(benches);
