//! Opening a file, mapped and read, beside reading the bytes alone; and the first cut from a mapped
//! file, with the file in the page cache and, on Linux, after the page cache was dropped.

#![expect(unsafe_code, reason = "nobody writes to the files that are mapped here")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]
#![allow(missing_docs, reason = "criterion's macros write undocumented functions")]

mod support;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nephrite::Lod;
use std::hint::black_box;
use std::path::Path;

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
        group.sample_size(10);
        for (name, forget) in [("first cut, warm", false), ("first cut, cold", true)] {
            group.bench_function(id(name), |bencher| {
                let prepare = || {
                    if forget {
                        forget_file(&path);
                    }
                };
                bencher.iter_batched(prepare, |()| first_cut(&path), BatchSize::PerIteration);
            });
        }
        let lod = Lod::open(&path).unwrap();
        group.bench_function(id("verify"), |bencher| bencher.iter(|| lod.verify().unwrap()));
        group.sample_size(100);
    }
    group.finish();
}

/// Maps a file and copies a tenth of its triangles, like a program that starts.
fn first_cut(path: &Path) -> Vec<u32> {
    // SAFETY: the temporary file is ours and nobody writes to it.
    let lod = unsafe { Lod::map(black_box(path)) }.unwrap();
    let cut = lod.at_count(lod.at_level(0).n_simplices() / 10);
    let mut indices = vec![0; cut.n_indices()];
    cut.extract_into(&mut indices).unwrap();
    indices
}

/// Makes the system read the file from the disk again; does nothing if that is not possible.
fn forget_file(path: &Path) {
    #[cfg(target_os = "linux")]
    {
        let file = std::fs::File::open(path).unwrap();
        file.sync_all().unwrap();
        rustix::fs::fadvise(&file, 0, None, rustix::fs::Advice::DontNeed).unwrap();
    }
    #[cfg(not(target_os = "linux"))]
    let _ = path;
}

criterion_group!(benches, open);
criterion_main!(benches);
