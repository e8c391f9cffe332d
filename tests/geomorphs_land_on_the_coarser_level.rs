//! Promise: every vertex that leaves lands on a triangle of the coarser level, near its own place
//! on the surface.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{BuildOptions, Landing, Lod, TriangleMesh, generate};
use std::collections::HashSet;
use support::space::{Vector, add_scaled, distance_sq, point_triangle_distance_sq, widen};
use support::synthetic::{decimate, grid};

fn built(mesh: &TriangleMesh, max_error: Option<f64>) -> Lod {
    let options = BuildOptions { max_error, ..BuildOptions::default() };
    let build = nephrite::build(mesh, &options).unwrap();
    support::served::served(|stream, options| build.write_to(stream, options))
}

fn place(lod: &Lod, landing: &Landing) -> Vector {
    let corners = landing.triangle.map(|vertex| widen(lod.vertices()[vertex as usize]));
    (0..3).fold([0.0; 3], |sum, i| add_scaled(sum, f64::from(landing.weights[i]), corners[i]))
}

/// Checks what must hold of any landings, and returns the distance of each vertex from its landing.
fn check(lod: &Lod, fine: u32, coarse: u32) -> Vec<f64> {
    let landings = lod.geomorph(fine, coarse).unwrap();
    let cut = lod.at_level(coarse);
    let alive: HashSet<[u32; 3]> = cut.to_mesh().unwrap().triangles.into_iter().collect();
    let first = cut.prefix_len();
    assert_eq!(landings.len(), lod.at_level(fine).prefix_len() - first);
    let distance = |(vertex, landing): (usize, &Option<Landing>)| {
        let landing = landing.unwrap();
        assert!(alive.contains(&landing.triangle));
        assert!(landing.weights.iter().all(|&weight| weight >= 0.0));
        assert!((landing.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        distance_sq(place(lod, &landing), widen(lod.vertices()[vertex])).sqrt()
    };
    (first..).zip(&landings).map(distance).collect()
}

#[test]
fn on_a_flat_surface_every_vertex_stays_where_it_is() {
    let mut mesh = grid(20);
    mesh.positions.iter_mut().for_each(|position| position[2] = 0.0);
    // So small that the corners of the square stay.
    let lod = built(&mesh, Some(1e-3));
    assert!(lod.n_levels() > 1);
    for coarse in 1..lod.n_levels() {
        assert!(check(&lod, 0, coarse).into_iter().all(|distance| distance < 2e-3));
    }
}

#[test]
fn on_a_curved_surface_landings_are_about_as_near_as_can_be() {
    let lod = built(&generate::cosine(30), None);
    let last = lod.n_levels() - 1;
    for (fine, coarse) in
        [(0, 1), (3, 4), (0, last / 3), (last / 4, last / 2), (0, last / 2), (last / 2, last)]
    {
        let distances = check(&lod, fine, coarse);
        let cut = lod.at_level(coarse);
        let mesh = cut.to_mesh().unwrap();
        let corners: Vec<_> =
            mesh.triangles.iter().map(|t| t.map(|v| widen(mesh.positions[v as usize]))).collect();
        let (mut sum, mut nearest_sum) = (0.0, 0.0);
        for (vertex, &distance) in (cut.prefix_len()..).zip(&distances) {
            let position = widen(lod.vertices()[vertex]);
            let nearest = corners.iter().map(|corners| point_triangle_distance_sq(position, corners));
            let nearest = nearest.fold(f64::INFINITY, f64::min).sqrt();
            assert!(distance > nearest - 1e-5);
            // The bound is proven for the nearest point. A landing may be farther, because it
            // follows the replacements.
            assert!(distance <= 3.0 * cut.error() + 1e-5, "{distance} {}", cut.error());
            (sum, nearest_sum) = (sum + distance, nearest_sum + nearest);
        }
        assert!(sum <= 1.1 * nearest_sum + 1e-3, "{fine} to {coarse}: {sum} {nearest_sum}");
    }
}

#[test]
fn any_history_lands_and_other_questions_have_empty_answers() {
    let mesh = grid(40);
    let history = decimate(&mesh, usize::MAX, 4);
    for levels in [None, Some(u32::MAX), Some(2), Some(9)] {
        let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, levels)).unwrap();
        let last = lod.n_levels() - 1;
        for (fine, coarse) in [(0, 1), (0, last), (last / 2, last), (last - 1, last)] {
            check(&lod, fine, coarse);
        }
        assert_eq!(lod.geomorph(last, 0).unwrap(), []);
        assert_eq!(lod.geomorph(u32::MAX, u32::MAX).unwrap(), []);
    }
}
