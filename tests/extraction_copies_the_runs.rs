//! Promise: extraction writes the indices of the runs and nothing after them, plain and parallel
//! alike.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::Lod;

#[test]
fn extraction_writes_what_the_runs_say_and_no_more() {
    let mesh = support::synthetic::grid(400);
    let history = support::synthetic::decimate(&mesh, 40_000, 6);
    let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, Some(20))).unwrap();
    for level in 0..lod.n_levels() {
        let cut = lod.at_level(level);
        let n_indices = cut.n_indices();
        let by_runs: Vec<u32> =
            cut.runs().flat_map(|run| lod.indices()[run.index_range(3)].iter().copied()).collect();
        let mut plain = vec![u32::MAX; n_indices + 10];
        let mut parallel = plain.clone();
        assert_eq!(cut.extract_into(&mut plain), Ok(n_indices));
        assert_eq!(cut.par_extract_into(&mut parallel), Ok(n_indices));
        assert!(plain[..n_indices] == by_runs && plain == parallel);
        assert!(plain[n_indices..].iter().all(|&index| index == u32::MAX));
        let error = nephrite::QueryError::BufferTooSmall { found: n_indices - 1, expected: n_indices };
        assert_eq!(cut.extract_into(&mut plain[..n_indices - 1]), Err(error));
    }
}
