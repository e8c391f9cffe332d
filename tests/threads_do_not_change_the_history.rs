//! Promise: the same input and options give the same history on any number of threads.

mod engine;

use engine::build_all;
use nephrite::{BuildOptions, EstimateKind, JadeOptions, Placement, generate};

#[test]
fn one_two_and_seven_threads_agree() {
    for jade in [
        JadeOptions::certified(Placement::Original),
        JadeOptions::certified(Placement::Best),
        JadeOptions::estimate(EstimateKind::Joint),
    ] {
        let options = BuildOptions::with(jade);
        let mesh = generate::cosine(50);
        let on_threads = |n_threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
            pool.install(|| build_all(&mesh, &options))
        };
        let one = on_threads(1);
        assert_eq!(one, on_threads(2), "{options:?}");
        assert_eq!(one, on_threads(7), "{options:?}");
    }
}
