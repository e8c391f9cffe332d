//! Opening a file: mapped and read, beside reading the bytes and nothing else.

#![allow(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]
#![allow(missing_docs, reason = "criterion's macros write undocumented functions")]

mod support;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nephrite::Lod;
use std::hint::black_box;

fn open(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap();
    let mut group = criterion.benchmark_group("open");
    for side in support::SIDES {
        let bytes = support::file_bytes(side, None);
        let path = folder.path().join(format!("{side}.neph"));
        std::fs::write(&path, &bytes).unwrap();
        let id = |name| BenchmarkId::new(name, format!("{} bytes", bytes.len()));
        group.throughput(Throughput::Bytes(bytes.len() as u64));
        group.bench_function(id("map"), |bencher| {
            bencher.iter(|| {
                // SAFETY: the temporary file is ours and nobody writes to it.
                let lod = unsafe { Lod::map(black_box(&path)) };
                lod.unwrap()
            });
        });
        group.bench_function(id("read"), |bencher| bencher.iter(|| Lod::open(black_box(&path)).unwrap()));
        group.bench_function(id("naive: read the bytes"), |bencher| {
            bencher.iter(|| std::fs::read(black_box(&path)).unwrap());
        });
        let lod = Lod::open(&path).unwrap();
        group.sample_size(10);
        group.bench_function(id("verify"), |bencher| bencher.iter(|| lod.verify().unwrap()));
        group.sample_size(100);
    }
    group.finish();
}

criterion_group!(benches, open);
criterion_main!(benches);
