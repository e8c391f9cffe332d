//! Inputs without a surface, and invalid options.

use nephrite::TriangleMesh;
use nephrite::measure::{MeasureError, MeasureOptions, Side, measure, sample_distances, vertex_distances};

use crate::meshes::{grid, mesh};

fn plane() -> TriangleMesh {
    grid(2, [1.0, 1.0], |_, _| 0.0)
}

/// The errors with the bad mesh on either side of the comparison.
fn errors(bad: &TriangleMesh) -> [MeasureError; 2] {
    let options = MeasureOptions { n_samples: 10, ..MeasureOptions::default() };
    [measure(bad, &plane(), &options).unwrap_err(), measure(&plane(), bad, &options).unwrap_err()]
}

#[test]
fn no_triangles() {
    let sides = [Side::Reference, Side::Mesh];
    assert_eq!(
        errors(&TriangleMesh::default()),
        sides.map(|side| MeasureError::NoTriangles { side, n_vertices: 0 })
    );
    let points = mesh(vec![[0.0; 3]; 5], Vec::new());
    assert_eq!(errors(&points), sides.map(|side| MeasureError::NoTriangles { side, n_vertices: 5 }));
}

#[test]
fn coordinates_that_are_not_finite() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut mesh = plane();
        mesh.positions[4][1] = bad;
        for error in errors(&mesh) {
            assert!(matches!(error, MeasureError::NotFinite { vertex: 4, .. }), "{error:?}");
        }
        let mesh = TriangleMesh { origin: [0.0, f64::from(bad), 0.0], ..plane() };
        for error in errors(&mesh) {
            assert!(matches!(error, MeasureError::OriginNotFinite { .. }), "{error:?}");
        }
    }
}

#[test]
fn indices_out_of_range() {
    for vertex in [9, 10, u32::MAX] {
        let mut mesh = plane();
        mesh.triangles[3][2] = vertex;
        for error in errors(&mesh) {
            assert!(
                matches!(error, MeasureError::VertexOutOfRange { triangle: 3, vertex: v, n_vertices: 9, .. } if v == vertex),
                "{error:?}"
            );
        }
    }
}

#[test]
fn origins_too_far_apart() {
    let far = TriangleMesh { origin: [1e200, 0.0, 0.0], ..plane() };
    for error in errors(&far) {
        assert!(matches!(error, MeasureError::TooFarApart { .. }), "{error:?}");
    }
    assert!(measure(&far, &far, &MeasureOptions::default()).is_ok_and(|distance| distance.max < 1e-12));
}

#[test]
fn options_out_of_range() {
    let with = |n_samples: usize, tolerance: f64| {
        measure(&plane(), &plane(), &MeasureOptions { n_samples, tolerance, ..MeasureOptions::default() })
    };
    assert_eq!(with(0, 0.01), Err(MeasureError::NoSamples));
    for tolerance in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(with(10, tolerance), Err(MeasureError::BadTolerance { found: tolerance }));
    }
    assert!(matches!(with(10, f64::NAN), Err(MeasureError::BadTolerance { .. })));
    assert!(with(1, 1e-9).is_ok());
}

#[test]
fn the_cap_is_honest() {
    let wave = |x: f32, y: f32| (3.0 * x).sin() * (2.0 * y).cos();
    let (fine, coarse) = (grid(40, [1.0, 1.0], wave), grid(7, [1.0, 1.0], wave));
    let options = MeasureOptions { n_samples: 100, tolerance: 1e-6, max_pieces: 100 };
    let capped = measure(&fine, &coarse, &options).unwrap();
    assert!(!capped.is_within_tolerance, "{capped:?}");
    let full = measure(&fine, &coarse, &MeasureOptions { max_pieces: 10_000_000, ..options }).unwrap();
    assert!(full.is_within_tolerance, "{full:?}");
    assert!(capped.lower_bound <= full.upper_bound && full.lower_bound <= capped.upper_bound);
}

#[test]
fn the_other_calls_check_as_well() {
    assert!(matches!(
        vertex_distances(&plane(), &TriangleMesh::default()),
        Err(MeasureError::NoTriangles { .. })
    ));
    assert!(matches!(
        sample_distances(&TriangleMesh::default(), &plane(), 5),
        Err(MeasureError::NoTriangles { .. })
    ));
    assert_eq!(sample_distances(&plane(), &plane(), 5).unwrap().len(), 5);
}
