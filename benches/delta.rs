//! The change between two levels, beside comparing the two cuts triangle by triangle.

#![allow(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]
#![allow(missing_docs, reason = "criterion's macros write undocumented functions")]

mod support;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nephrite::{Cut, Lod};
use std::collections::HashSet;
use std::hint::black_box;

fn delta(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("delta");
    for side in support::SIDES {
        let lod = Lod::from_bytes(&support::file_bytes(side, None)).unwrap();
        let level = lod.n_levels() / 8;
        for distance in [1, 2, 8, 64] {
            let delta = lod.delta(level, level + distance);
            let n_changed = delta.leaving().chain(delta.entering()).map(|run| u64::from(run.len)).sum();
            let n_runs = delta.leaving().chain(delta.entering()).count();
            group.throughput(Throughput::Elements(n_changed));
            let of = format!(
                "{} triangles, {distance} levels on, {n_changed} changed in {n_runs} runs",
                delta.before().n_simplices()
            );
            group.bench_function(BenchmarkId::new("runs", &of), |bencher| {
                bencher.iter(|| {
                    let delta = lod.delta(black_box(level), level + distance);
                    delta
                        .leaving()
                        .chain(delta.entering())
                        .map(|run| u64::from(run.start ^ run.len))
                        .sum::<u64>()
                });
            });
            group.sample_size(10);
            group.bench_function(BenchmarkId::new("naive: two sets", &of), |bencher| {
                bencher.iter(|| {
                    let [before, after] = [delta.before(), delta.after()].map(triangles);
                    before.symmetric_difference(&after).count()
                });
            });
            group.sample_size(100);
        }
    }
    group.finish();
}

fn triangles(cut: Cut<'_>) -> HashSet<[u32; 3]> {
    let indices = cut.lod().indices();
    cut.runs().flat_map(|run| indices[run.index_range(3)].as_chunks().0).copied().collect()
}

criterion_group!(benches, delta);
criterion_main!(benches);
