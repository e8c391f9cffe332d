//! Distances with a closed form.

use crate::space::{cross, dot, length, sub};
use nephrite::TriangleMesh;
use nephrite::measure::{Distance, MeasureOptions, Verdict, check_within, measure, vertex_distances};

use crate::meshes::{corners, grid, mesh, scaled, sphere};

/// Measures to 7 digits and compares both directions with the expected values, to 6.
fn check(reference: &TriangleMesh, mesh: &TriangleMesh, forward: f64, backward: f64) -> Distance {
    let options = MeasureOptions { n_samples: 10_000, tolerance: 1e-7, ..MeasureOptions::default() };
    let distance = measure(reference, mesh, &options).unwrap();
    let scale = distance.bounding_diagonal.max(forward).max(backward);
    for (found, expected) in [(distance.forward, forward), (distance.backward, backward)] {
        assert!(
            (found.max - expected).abs() <= 1e-6 * expected + 1e-12 * scale,
            "{found:?}, expected {expected}"
        );
        let slack = 1e-11 * scale;
        assert!(
            found.lower_bound <= expected + slack && expected <= found.upper_bound + slack,
            "{found:?}, {expected}"
        );
        assert!(found.upper_bound - found.lower_bound <= 1e-6 * expected + slack, "{found:?}");
    }
    let larger = forward.max(backward);
    assert!(distance.is_within_tolerance, "{distance:?}");
    assert!((distance.max - larger).abs() <= 1e-6 * larger + 1e-12 * scale);
    assert!(distance.lower_bound <= distance.max && distance.max <= distance.upper_bound);
    distance
}

#[test]
fn parallel_squares() {
    let distance = check(&grid(1, [1.0, 1.0], |_, _| 0.0), &grid(7, [1.0, 1.0], |_, _| 0.25), 0.25, 0.25);
    for one_sided in [distance.forward, distance.backward] {
        for mean in [one_sided.mean, one_sided.rms, one_sided.area_mean, one_sided.area_rms] {
            assert!((mean - 0.25).abs() < 1e-12, "{one_sided:?}");
        }
    }
}

#[test]
fn parallel_squares_that_nearly_touch() {
    // Halving alone would need pieces as small as the distance along every edge of the other grid.
    let gap = 1e-6f32;
    let distance =
        check(&grid(10, [1.0, 1.0], |_, _| 0.0), &grid(13, [1.0, 1.0], |_, _| gap), gap.into(), gap.into());
    assert!(distance.forward.n_pieces + distance.backward.n_pieces < 100_000, "{distance:?}");
}

#[test]
fn the_same_plane_cut_in_two_ways() {
    let distance = check(&grid(10, [1.0, 1.0], |_, _| 0.0), &grid(13, [1.0, 1.0], |_, _| 0.0), 0.0, 0.0);
    assert!(distance.upper_bound < 1e-11);
}

#[test]
fn a_surface_and_itself() {
    check(&sphere(3), &sphere(3), 0.0, 0.0);
}

#[test]
fn one_direction_is_zero() {
    // All of the half is on the whole; the far edge of the whole is 0.5 from the half.
    let (whole, half) = (grid(4, [1.0, 1.0], |_, _| 0.0), grid(3, [0.5, 1.0], |_, _| 0.0));
    let distance = check(&whole, &half, 0.5, 0.0);
    assert!((distance.max - 0.5).abs() < 1e-12);
    check(&half, &whole, 0.0, 0.5);
}

#[test]
fn a_plane_with_a_bump() {
    let height = 0.5f32;
    let square = vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let plane = mesh(square.clone(), vec![[0, 1, 2], [0, 2, 3]]);
    let mut with_apex = square;
    with_apex.push([0.0, 0.0, height]);
    let pyramid = mesh(with_apex, vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
    // The apex is straight above the plane; the centre of the plane is as far from all four sides,
    // each of which lies in a plane like `height x + z = height`.
    let height = f64::from(height);
    let distance = check(&plane, &pyramid, height / height.hypot(1.0), height);
    let apex = distance.backward.farthest;
    assert!(apex[0].abs() < 1e-12 && apex[1].abs() < 1e-12 && (apex[2] - height).abs() < 1e-12, "{apex:?}");
}

#[test]
fn a_tilted_plane_has_a_known_mean() {
    let (flat, tilted) = (grid(1, [4.0, 1.0], |_, _| 0.0), grid(5, [1.0, 1.0], |x, _| 0.5 * x));
    let options = MeasureOptions { n_samples: 100_000, ..MeasureOptions::default() };
    let backward = measure(&flat, &tilted, &options).unwrap().backward;
    assert!((backward.area_mean - 0.25).abs() < 1e-4, "{backward:?}");
    assert!((backward.area_rms - 0.5 / 3f64.sqrt()).abs() < 1e-4, "{backward:?}");
    assert!((backward.max - 0.5).abs() < 1e-9, "{backward:?}");
}

#[test]
fn a_sphere_and_a_larger_one() {
    // An inscribed polyhedron and a copy about the same centre, `scale` times as large. A vertex of
    // the copy is nearest to the vertex that it is a copy of: the sphere's tangent plane there
    // supports the polyhedron. A point of a face is nearest to the copy of a face, and of those
    // planes its own is no farther than the difference of their distances from the centre; the
    // largest of these is attained where the farthest plane is nearest to the centre.
    let sphere = sphere(3);
    let scale = 1.03125f32;
    let larger = scaled(&sphere, scale);
    let plane_distance = |t: usize| {
        let [a, b, c] = corners(&sphere, t);
        let normal = cross(sub(b, a), sub(c, a));
        dot(normal, a) / length(normal)
    };
    let inradius = (0..sphere.triangles.len()).map(plane_distance).fold(0.0, f64::max);
    let radius = sphere.positions.iter().map(|p| length(p.map(f64::from))).fold(0.0, f64::max);
    let gap = f64::from(scale) - 1.0;
    let distance =
        measure(&sphere, &larger, &MeasureOptions { tolerance: 1e-6, ..MeasureOptions::default() }).unwrap();
    // The positions are rounded to f32, the closed form is not.
    assert!((distance.forward.max - gap * inradius).abs() < 1e-6 * gap, "{distance:?}, {}", gap * inradius);
    assert!((distance.backward.max - gap * radius).abs() < 3e-6 * gap, "{distance:?}, {}", gap * radius);
    assert!(distance.is_within_tolerance);
}

#[test]
fn points_and_segments_are_surfaces_too() {
    let point = mesh(vec![[1.0, 2.0, 3.0]; 3], vec![[0, 1, 2]]);
    let segment = mesh(vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 0.0, 0.0]], vec![[0, 1, 2]]);
    let far = mesh(vec![[1.0, 2.0, 8.0], [1.0, 2.0, 8.0], [1.0, 2.0, 8.0]], vec![[2, 1, 0], [0, 0, 0]]);
    let distance = check(&point, &far, 5.0, 5.0);
    assert_eq!([distance.mean, distance.rms], [5.0, 5.0]);
    check(&segment, &mesh(vec![[0.0, 3.0, 0.0], [4.0, 3.0, 0.0]], vec![[0, 1, 1]]), 3.0, 3.0);
    check(&segment, &mesh(vec![[1.0, 0.0, 4.0]], vec![[0, 0, 0]]), 5.0, 4.0);
}

#[test]
fn a_single_triangle_against_another() {
    let triangle = |z: f32| mesh(vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]], vec![[0, 1, 2]]);
    check(&triangle(0.0), &triangle(2.0), 2.0, 2.0);
    let reversed = TriangleMesh { triangles: vec![[2, 1, 0]], ..triangle(2.0) };
    check(&triangle(0.0), &reversed, 2.0, 2.0);
}

#[test]
fn a_hole_in_the_reference_is_seen_from_the_mesh() {
    let whole = grid(4, [4.0, 4.0], |_, _| 0.0);
    let mut holed = whole.clone();
    // The cells between 1 and 3: the centre of the hole is 1 from its rim.
    holed.triangles.retain(|corners| {
        let centre =
            |axis: usize| corners.iter().map(|&v| whole.positions[v as usize][axis]).sum::<f32>() / 3.0;
        !((1.0..3.0).contains(&centre(0)) && (1.0..3.0).contains(&centre(1)))
    });
    check(&holed, &whole, 0.0, 1.0);
}

#[test]
fn unused_vertices_are_not_on_the_surface() {
    let plane = grid(3, [1.0, 1.0], |_, _| 0.0);
    let mut littered = plane.clone();
    littered.positions.extend([[100.0, 0.0, 0.0], [f32::NAN; 3], [f32::INFINITY; 3]]);
    check(&plane, &littered, 0.0, 0.0);
    let distance = check(&littered, &plane, 0.0, 0.0);
    assert!((distance.bounding_diagonal - 2f64.sqrt()).abs() < 1e-12);
}

#[test]
fn origins_are_added() {
    let low = TriangleMesh { origin: [1e7, -1e7, 5.0], ..grid(5, [1.0, 1.0], |_, _| 0.0) };
    let high = TriangleMesh { origin: [1e7, -1e7, 5.125], ..grid(3, [1.0, 1.0], |_, _| 0.0) };
    let distance = check(&low, &high, 0.125, 0.125);
    assert_eq!(distance.forward.farthest[2], 5.0);
    assert_eq!(distance.backward.farthest[2], 5.125);
    // A mesh far from its origin, against the same mesh stored near its own.
    let far = TriangleMesh {
        positions: low.positions.iter().map(|p| [p[0] + 1024.0, p[1], p[2]]).collect(),
        origin: [1e7 - 1024.0, -1e7, 5.0],
        ..low.clone()
    };
    assert!(measure(&low, &far, &MeasureOptions::default()).unwrap().upper_bound < 1e-4);
}

#[test]
fn scales_that_differ_wildly() {
    let sphere = sphere(4);
    let speck = scaled(&sphere, 1e-6);
    let options = MeasureOptions { n_samples: 20_000, ..MeasureOptions::default() };
    let distance = measure(&sphere, &speck, &options).unwrap();
    assert!((distance.forward.max - 1.0).abs() < 1e-5, "{distance:?}");
    assert!(distance.is_within_tolerance, "{distance:?}");
    let distance = measure(&speck, &sphere, &options).unwrap();
    assert!((distance.backward.max - 1.0).abs() < 1e-5, "{distance:?}");
    let vast = scaled(&sphere, 1e30);
    let distance = measure(&vast, &sphere, &options).unwrap();
    assert!((distance.forward.max - 1e30).abs() < 1e25, "{distance:?}");
}

#[test]
fn rounding_widens_the_bracket() {
    let plane = grid(3, [1.0, 1.0], |_, _| 0.0);
    let rounded = TriangleMesh { rounding: 0.125, ..grid(4, [1.0, 1.0], |_, _| 1.0) };
    let options = MeasureOptions { n_samples: 1000, tolerance: 1e-10, ..MeasureOptions::default() };
    let distance = measure(&plane, &rounded, &options).unwrap();
    assert!((distance.lower_bound - 0.875).abs() < 1e-9 && (distance.upper_bound - 1.125).abs() < 1e-9);
    assert!(distance.is_within_tolerance);
}

#[test]
fn limits_are_proven_and_refuted() {
    let (plane, other) = (grid(10, [1.0, 1.0], |_, _| 0.0), grid(13, [1.0, 1.0], |_, _| 0.25));
    assert_eq!(check_within(&plane, &other, 0.2501, 100_000).unwrap(), Verdict::Within);
    assert!(matches!(
        check_within(&plane, &other, 0.2499, 100_000).unwrap(),
        Verdict::Beyond { distance, .. } if (distance - 0.25).abs() < 1e-9
    ));
    assert!(matches!(check_within(&plane, &other, 0.25, 100_000).unwrap(), Verdict::Undecided { .. }));
    let half = grid(3, [0.5, 1.0], |_, _| 0.0);
    assert!(matches!(check_within(&half, &plane, 0.4, 100_000).unwrap(), Verdict::Beyond { .. }));
    assert!(matches!(check_within(&plane, &half, 0.4, 100_000).unwrap(), Verdict::Beyond { .. }));
}

#[test]
fn distances_of_vertices() {
    let mut tilted = grid(2, [1.0, 1.0], |x, _| x);
    tilted.positions.push([f32::NAN; 3]);
    let distances = vertex_distances(&tilted, &grid(5, [1.0, 1.0], |_, _| 0.0)).unwrap();
    for (distance, position) in distances.iter().zip(&tilted.positions).take(9) {
        assert!((distance - f64::from(position[2])).abs() < 1e-12);
    }
    assert!(distances[9].is_nan());
}
