//! Promise: hundreds of threads query one `Lod` at once and get the answers that one thread gets.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{Cut, Lod};

#[test]
fn one_file_serves_hundreds_of_threads() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Lod>();
    is_shared::<Cut<'_>>();
    let mesh = support::synthetic::grid(30);
    let history = support::synthetic::decimate(&mesh, usize::MAX, 6);
    let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, None)).unwrap();
    let expected: Vec<_> = (0..lod.n_levels()).map(|level| lod.at_level(level).to_mesh()).collect();
    std::thread::scope(|scope| {
        for thread in 0..200 {
            let (lod, expected) = (&lod, &expected);
            scope.spawn(move || {
                for level in 0..lod.n_levels() {
                    let level = (level + thread) % lod.n_levels();
                    assert_eq!(lod.at_level(level).to_mesh(), expected[level as usize]);
                }
            });
        }
    });
}
