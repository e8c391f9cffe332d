//! Agreement with dense sampling against every triangle.

use nephrite::TriangleMesh;
use nephrite::measure::{MeasureOptions, Verdict, check_within, measure};
use proptest::prelude::*;

use crate::meshes::{corners, mesh};
use crate::space::point_triangle_distance_sq;

/// Largest distance of lattice points of one mesh from another. No point of the mesh is farther
/// than that by more than the second number.
fn lattice_distance(from: &TriangleMesh, to: &TriangleMesh, n: u32) -> (f64, f64) {
    let targets: Vec<_> = (0..to.triangles.len()).map(|t| corners(to, t)).collect();
    let mut largest = 0.0f64;
    let mut spacing = 0.0f64;
    for t in 0..from.triangles.len() {
        let [a, b, c] = corners(from, t);
        let side = |p: [f64; 3], q: [f64; 3]| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt();
        spacing = spacing.max(side(a, b).max(side(b, c)).max(side(c, a)) / f64::from(n));
        for i in 0..=n {
            for j in 0..=(n - i) {
                let [v, w] = [i, j].map(|k| f64::from(k) / f64::from(n));
                let p: [f64; 3] =
                    std::array::from_fn(|axis| a[axis] + v * (b[axis] - a[axis]) + w * (c[axis] - a[axis]));
                let nearest_sq =
                    targets.iter().map(|to| point_triangle_distance_sq(p, to)).fold(f64::INFINITY, f64::min);
                largest = largest.max(nearest_sq.sqrt());
            }
        }
    }
    (largest, spacing)
}

fn soup() -> impl Strategy<Value = TriangleMesh> {
    let position = prop::array::uniform3(-1.0f32..1.0);
    prop::collection::vec(position, 3..12).prop_flat_map(|positions| {
        let v = 0..u32::try_from(positions.len()).unwrap();
        (Just(positions), prop::collection::vec(prop::array::uniform3(v), 1..8))
            .prop_map(|(positions, triangles)| mesh(positions, triangles))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_bracket_holds_on_triangle_soups(reference in soup(), other in soup()) {
        let options = MeasureOptions { n_samples: 500, tolerance: 0.01, ..MeasureOptions::default() };
        let distance = measure(&reference, &other, &options).unwrap();
        prop_assert!(distance.is_within_tolerance, "{:?}", distance);
        for (one_sided, from, to) in [
            (distance.forward, &reference, &other),
            (distance.backward, &other, &reference),
        ] {
            let (sampled, spacing) = lattice_distance(from, to, 40);
            prop_assert!(sampled <= one_sided.upper_bound, "{} > {:?}", sampled, one_sided);
            prop_assert!(sampled + spacing >= one_sided.lower_bound, "{} < {:?}", sampled, one_sided);
            prop_assert!(one_sided.lower_bound <= one_sided.max && one_sided.max <= one_sided.upper_bound);
            prop_assert!(one_sided.area_mean <= one_sided.max && one_sided.mean <= one_sided.rms + 1e-15);
        }
        let within = check_within(&reference, &other, distance.upper_bound * 1.01 + 1e-9, 1_000_000).unwrap();
        prop_assert_eq!(within, Verdict::Within);
        let beyond = check_within(&reference, &other, distance.lower_bound * 0.99 - 1e-9, 1_000_000).unwrap();
        prop_assert!(matches!(beyond, Verdict::Beyond { .. }), "{:?}", beyond);
    }
}
