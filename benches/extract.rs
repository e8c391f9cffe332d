//! Copying a cut out, beside `memcpy` of the same bytes and beside a linear scan that gathers the
//! triangles.

#![allow(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]
#![allow(missing_docs, reason = "criterion's macros write undocumented functions")]

mod support;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nephrite::Lod;
use std::hint::black_box;

fn extract(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("extract");
    let side = 600;
    let lod = Lod::from_bytes(&support::file_bytes(side, None)).unwrap();
    let (_, history) = support::surface(side);
    for n_triangles in [2_000, 20_000, 200_000, 700_000] {
        let cut = lod.at_count(n_triangles);
        let mut indices = vec![0u32; cut.n_indices()];
        let source = &lod.indices()[..cut.n_indices()];
        group.throughput(Throughput::Elements(cut.n_simplices() as u64));
        let id =
            |name| BenchmarkId::new(name, format!("{} triangles, {} runs", cut.n_simplices(), cut.n_runs()));
        group.bench_function(id("copy"), |bencher| {
            bencher.iter(|| cut.extract_into(black_box(&mut indices)).unwrap());
        });
        group.bench_function(id("parallel copy"), |bencher| {
            bencher.iter(|| cut.par_extract_into(black_box(&mut indices)).unwrap());
        });
        group.bench_function(id("memcpy"), |bencher| {
            bencher.iter(|| black_box(&mut indices).copy_from_slice(black_box(source)));
        });
        group.bench_function(id("ordered copy"), |bencher| {
            bencher.iter(|| cut.extract_ordered_into(black_box(&mut indices)).unwrap());
        });
        let step = black_box(history.errors.partition_point(|&error| error <= cut.error()) - 1);
        let step = u32::try_from(step).unwrap();
        let mut gathered = Vec::with_capacity(cut.n_simplices() + 16);
        group.sample_size(10);
        group.bench_function(id("naive: linear scan"), |bencher| {
            bencher.iter(|| {
                gathered.clear();
                let lives = history.birth.iter().zip(&history.death);
                let alive = lives
                    .zip(&history.simplices)
                    .filter(|((birth, death), _)| **birth <= step && step < **death);
                gathered.extend(alive.map(|(_, triangle)| *triangle));
                gathered.len()
            });
        });
        group.sample_size(100);
    }
    group.finish();
}

criterion_group!(benches, extract);
criterion_main!(benches);
