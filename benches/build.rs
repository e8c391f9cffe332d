//! Building all levels at once, beside one run per level, which is what one does without a history
//! (table 3 of the JADE paper).

#![allow(
    missing_docs,
    clippy::unwrap_used,
    reason = "criterion writes the public functions; a bench may panic"
)]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nephrite::{
    Build, BuildOptions, EstimateKind, JadeOptions, TriangleMesh, bounding_diagonal, build, generate,
};

fn build_to(mesh: &TriangleMesh, jade: JadeOptions, max_error: Option<f64>) -> Build {
    build(mesh, &BuildOptions { max_error, ..BuildOptions::with(jade) }).unwrap()
}

/// Errors of the paper's LOD sets, from the finest to 5 % of the diagonal.
fn errors_of_lods(n_levels: u32, diagonal: f64) -> impl Iterator<Item = f64> {
    (1..n_levels).map(move |i| 0.05 * diagonal * f64::from(i) / f64::from(n_levels - 1))
}

fn all_levels(criterion: &mut Criterion) {
    let mesh = generate::cosine(60);
    let diagonal = bounding_diagonal(&mesh);
    let mut group = criterion.benchmark_group("build");
    group.throughput(Throughput::Elements(mesh.triangles.len() as u64)).sample_size(10);
    let estimates = [EstimateKind::Joint, EstimateKind::Removed, EstimateKind::Accumulated];
    let proof = JadeOptions::default();
    for jade in [proof].into_iter().chain(estimates.map(JadeOptions::estimate)) {
        let bound = BuildOptions::with(jade).bound();
        group.bench_function(BenchmarkId::new("all levels to 5 %", bound), |bencher| {
            bencher.iter(|| build_to(&mesh, jade, Some(0.05 * diagonal)));
        });
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    group.bench_function("all levels to 5 %, one thread", |bencher| {
        bencher.iter(|| pool.install(|| build_to(&mesh, proof, Some(0.05 * diagonal))));
    });
    for n_levels in [3, 5, 9] {
        group.bench_function(BenchmarkId::new("a run per level", n_levels), |bencher| {
            bencher.iter(|| {
                errors_of_lods(n_levels, diagonal)
                    .map(|error| build_to(&mesh, proof, Some(error)))
                    .collect::<Vec<_>>()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, all_levels);
criterion_main!(benches);
