//! Promise: a cut drawn as runs reuses transformed vertices, and its ordered copy reuses more.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{CACHE_LEN, Levels, Lod, QueryError, StoreOptions, miss_ratio};
use support::synthetic::{decimate, grid};

fn sorted(indices: &[u32]) -> Vec<[u32; 3]> {
    let mut triangles = indices.as_chunks().0.to_vec();
    triangles.sort_unstable();
    triangles
}

#[test]
fn an_ordered_copy_is_the_same_set_with_fewer_misses() {
    let mesh = grid(100);
    let history = decimate(&mesh, usize::MAX, 2);
    let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, None)).unwrap();
    for n_triangles in [20_000, 10_000, 2_000, 500] {
        let cut = lod.at_count(n_triangles);
        let n_indices = cut.n_indices();
        let [mut plain, mut ordered] = [vec![0; n_indices + 3], vec![u32::MAX; n_indices + 3]];
        assert_eq!(cut.extract_into(&mut plain), Ok(n_indices));
        assert_eq!(cut.extract_ordered_into(&mut ordered), Ok(n_indices));
        assert_eq!(ordered[n_indices..], [u32::MAX; 3]);
        assert_eq!(sorted(&plain[..n_indices]), sorted(&ordered[..n_indices]));

        let ratio = |indices: &[u32]| miss_ratio(indices.as_chunks().0.iter().copied(), CACHE_LEN);
        let (of_runs, of_copy) = (ratio(&plain[..n_indices]), ratio(&ordered[..n_indices]));
        assert_eq!(cut.miss_ratio(CACHE_LEN), of_runs);
        assert!(
            of_copy < 1.1 && of_copy < 0.8 * of_runs && of_runs < 2.2,
            "{n_triangles}: {of_runs} {of_copy}"
        );
        let error = QueryError::BufferTooSmall { found: 1, expected: n_indices };
        assert_eq!(cut.extract_ordered_into(&mut [0]), Err(error));
    }
}

#[test]
fn windows_keep_every_level_and_draw_it_with_fewer_misses() {
    let mesh = grid(80);
    let history = decimate(&mesh, usize::MAX, 3);
    let levels = Levels::choose(&history, None).unwrap();
    let mut before = f64::INFINITY;
    for window_levels in [None, Some(31), Some(8), Some(1), Some(0)] {
        let options = StoreOptions { window_levels, ..StoreOptions::default() };
        let lod = Lod::from_bytes(&support::file_bytes_with(&mesh, &history, &options)).unwrap();
        lod.verify().unwrap();
        support::assert_levels_equal_scans(&lod, &mesh, &history, &levels);
        let mean = (0..lod.n_levels()).map(|level| lod.at_level(level).miss_ratio(CACHE_LEN)).sum::<f64>()
            / f64::from(lod.n_levels());
        assert!(mean < before || window_levels == Some(0), "{window_levels:?}: {mean} {before}");
        before = mean;
    }
}
