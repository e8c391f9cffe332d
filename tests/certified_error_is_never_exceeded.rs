//! At every level the measured two-sided distance to the input is at most the certified error, on smooth, sharp, open,
//! one-sided, non-manifold and self-intersecting input. The distance is measured here by brute force: every triangle of
//! one surface is sampled and held against every triangle of the other.

#![allow(clippy::unwrap_used, clippy::cast_possible_truncation, reason = "tests on small meshes")]

mod engine;

use engine::{alive_at, build_all, spread_steps};
use nephrite::geometry::vector::{Vector, add, distance_sq, dot, scale, sub};
use nephrite::{Bound, BuildOptions, TriangleMesh, bounding_diagonal, generate};

/// Distance of `p` to a triangle by minimising over it: along each edge, and inside by the normal equations.
fn distance_to(p: Vector, [a, b, c]: [Vector; 3]) -> f64 {
    let on_edge = |a: Vector, b: Vector| {
        let (ab, ap) = (sub(b, a), sub(p, a));
        let s = if dot(ab, ab) > 0.0 { (dot(ab, ap) / dot(ab, ab)).clamp(0.0, 1.0) } else { 0.0 };
        distance_sq(p, add(a, scale(ab, s)))
    };
    let mut best = on_edge(a, b).min(on_edge(b, c)).min(on_edge(c, a));
    let (u, v, w) = (sub(b, a), sub(c, a), sub(p, a));
    let (uu, uv, vv, wu, wv) = (dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v));
    let determinant = uu * vv - uv * uv;
    let (s, t) = ((vv * wu - uv * wv) / determinant, (uu * wv - uv * wu) / determinant);
    if s > 0.0 && t > 0.0 && s + t < 1.0 {
        best = best.min(distance_sq(p, add(a, add(scale(u, s), scale(v, t)))));
    }
    best.sqrt()
}

/// Largest distance from samples on every triangle of `from` to the surface `to`.
fn one_sided(from: &[[Vector; 3]], to: &[[Vector; 3]], per_side: u32) -> f64 {
    let mut largest = 0.0_f64;
    for &[a, b, c] in from {
        for i in 0..=per_side {
            for j in 0..=per_side - i {
                let [s, t] = [i, j].map(|k| f64::from(k) / f64::from(per_side));
                let p = add(a, add(scale(sub(b, a), s), scale(sub(c, a), t)));
                largest = largest.max(to.iter().map(|&t| distance_to(p, t)).fold(f64::INFINITY, f64::min));
            }
        }
    }
    largest
}

/// Checks `n_levels` levels; returns the measured part of the stated error at each where it is not zero.
fn check(name: &str, mesh: &TriangleMesh, n_levels: u32) -> Vec<f64> {
    let build = build_all(mesh, &BuildOptions::default());
    let corners = |triangles: &[[u32; 3]]| -> Vec<[Vector; 3]> {
        let point = |v: u32| build.mesh.positions[v as usize].map(f64::from);
        triangles.iter().map(|t| t.map(point)).collect()
    };
    let input = corners(&mesh.triangles);
    let rounding = 1e-12 * bounding_diagonal(mesh);
    let mut ratios = vec![];
    for step in spread_steps(&build.history, n_levels) {
        let stated = build.history.errors[step as usize];
        let level = corners(&alive_at(&build.history, step));
        let per_side = if level.len() > 200 { 2 } else { 8 };
        let measured = one_sided(&input, &level, 2).max(one_sided(&level, &input, per_side));
        assert!(
            measured <= stated + rounding,
            "{name}, step {step} of {} triangles: measured {measured}, stated {stated}",
            level.len()
        );
        if stated > 1e-6 * bounding_diagonal(mesh) {
            ratios.push(measured / stated);
        }
    }
    ratios
}

#[test]
fn smooth_and_sharp_surfaces() {
    let mut ratios = vec![];
    ratios.extend(check("sphere", &generate::sphere(8), 12));
    ratios.extend(check("torus", &generate::torus(28, 14), 12));
    ratios.extend(check("plate", &generate::plate(2, 2, 10), 12));
    ratios.extend(check("cosine", &generate::cosine(24), 12));
    ratios.extend(check("terrain", &generate::terrain(24, 7), 12));
    ratios.extend(check("cylinder", &generate::cylinder(24, 8), 12));
    ratios.sort_by(f64::total_cmp);
    let (median, tenth) = (ratios[ratios.len() / 2], ratios[ratios.len() / 10]);
    assert!(median >= 0.8 && tenth >= 0.6, "a bound that is far too high: median {median}, tenth {tenth}");
}

#[test]
fn a_surface_with_one_side() {
    check("moebius", &generate::moebius(48, 5), 16);
}

#[test]
fn a_surface_through_itself_and_one_with_a_spine() {
    let mut crossed = generate::sphere(6);
    let shifted = crossed.clone();
    let offset = crossed.positions.len() as u32;
    crossed.positions.extend(shifted.positions.iter().map(|p| [p[0] + 0.4, p[1] - 0.3, p[2]]));
    crossed.triangles.extend(shifted.triangles.iter().map(|t| t.map(|v| v + offset)));
    check("two spheres through each other", &crossed, 12);

    let mut pages = generate::terrain(12, 3);
    let folded = pages.clone();
    let offset = pages.positions.len() as u32;
    pages.positions.extend(folded.positions.iter().map(|p| [p[0], p[2], p[1]]));
    pages.triangles.extend(folded.triangles.iter().map(|t| t.map(|v| v + offset)));
    check("two terrains across each other", &pages, 12);
}

#[test]
fn noise_as_large_as_the_triangles() {
    let mut mesh = generate::torus(24, 12);
    let mut state = 1_u32;
    for coordinate in mesh.positions.as_flattened_mut() {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *coordinate += ((state >> 8) as f32 / 16_777_216.0 - 0.5) * 0.1;
    }
    check("noisy torus", &mesh, 16);
}

#[test]
fn the_error_asked_for_is_kept() {
    let mesh = generate::cosine(40);
    let max_error = 0.005 * bounding_diagonal(&mesh);
    for bound in [Bound::Certified, Bound::Joint, Bound::Removed, Bound::Accumulated] {
        let options = BuildOptions { bound, max_error: Some(max_error), ..BuildOptions::default() };
        let build = build_all(&mesh, &options);
        let last = *build.history.errors.last().unwrap();
        assert!(last <= max_error && last > 0.8 * max_error, "{bound:?}: {last} of {max_error}");
    }
}
