//! The distance between two surfaces, in samples, beside the naive way, which compares every sample
//! with every triangle.

#![allow(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]
#![allow(missing_docs, reason = "criterion's macros write undocumented functions")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nephrite::measure::{MeasureOptions, check_within, measure, sample_distances};
use nephrite::{TriangleMesh, generate};
use space::{Vector, point_triangle_distance_sq};

#[path = "../tests/support/space.rs"]
mod space;

/// Frequencies of two spheres: 69,620 and 7,220 triangles.
const FREQUENCIES: [u32; 2] = [59, 19];

fn distance(criterion: &mut Criterion) {
    let [fine, coarse] = FREQUENCIES.map(generate::sphere);
    let name = format!("{} and {} triangles", fine.triangles.len(), coarse.triangles.len());
    let mut group = criterion.benchmark_group("measure");
    group.sample_size(10);
    for n_samples in [100_000, 1_000_000] {
        // On edges and in triangles, of both meshes.
        group.throughput(Throughput::Elements(4 * n_samples as u64));
        group.bench_function(BenchmarkId::new(&name, n_samples), |bencher| {
            let options = MeasureOptions { n_samples, ..MeasureOptions::default() };
            bencher.iter(|| measure(&fine, &coarse, &options).unwrap());
        });
    }
    let upper_bound = measure(&fine, &coarse, &MeasureOptions::default()).unwrap().upper_bound;
    group.throughput(Throughput::Elements(fine.triangles.len() as u64));
    group.bench_function(BenchmarkId::new(&name, "proof of a limit"), |bencher| {
        bencher.iter(|| check_within(&fine, &coarse, 1.05 * upper_bound, 1_000_000).unwrap());
    });
    group.finish();
}

fn samples(criterion: &mut Criterion) {
    let [source, target] = [12, 8].map(generate::sphere);
    let n_samples = 10_000;
    let mut group = criterion.benchmark_group("sample distances");
    group.throughput(Throughput::Elements(n_samples as u64));
    let name = format!("{} triangles", target.triangles.len());
    group.bench_function(BenchmarkId::new("hierarchy", &name), |bencher| {
        bencher.iter(|| sample_distances(&source, &target, n_samples).unwrap());
    });
    group.sample_size(10);
    group.bench_function(BenchmarkId::new("naive: every triangle", &name), |bencher| {
        let triangles = triangles(&target);
        let points = centroids(&source, n_samples);
        bencher.iter(|| {
            let nearest_sq = |p: &[f64; 3]| {
                triangles.iter().map(|to| point_triangle_distance_sq(*p, to)).fold(f64::INFINITY, f64::min)
            };
            points.iter().map(nearest_sq).fold(0.0, f64::max)
        });
    });
    group.finish();
}

fn triangles(mesh: &TriangleMesh) -> Vec<[Vector; 3]> {
    mesh.triangles.iter().map(|corners| corners.map(|v| mesh.point(v))).collect()
}

/// `n_points` centroids of triangles, repeated as needed.
fn centroids(mesh: &TriangleMesh, n_points: usize) -> Vec<[f64; 3]> {
    let centroid = |[a, b, c]: [Vector; 3]| std::array::from_fn(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
    triangles(mesh).into_iter().map(centroid).cycle().take(n_points).collect()
}

criterion_group!(benches, distance, samples);
criterion_main!(benches);
