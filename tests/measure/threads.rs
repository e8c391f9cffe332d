//! The same numbers on any number of threads.

use nephrite::measure::{Distance, MeasureOptions, measure, sample_distances};

use crate::meshes::grid;

#[test]
fn threads_change_no_bit() {
    let wave = |x: f32, y: f32| (9.0 * x).sin() * (7.0 * y).cos() + x * y;
    let (fine, coarse) = (grid(60, [1.0, 1.0], wave), grid(11, [1.0, 1.0], wave));
    let options = MeasureOptions { n_samples: 30_000, tolerance: 1e-3, ..MeasureOptions::default() };
    let on = |n_threads: usize| -> (Distance, Vec<f64>) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            (measure(&fine, &coarse, &options).unwrap(), sample_distances(&coarse, &fine, 5000).unwrap())
        })
    };
    let alone = on(1);
    for n_threads in [2, 3, 8] {
        assert_eq!(on(n_threads), alone);
    }
}
