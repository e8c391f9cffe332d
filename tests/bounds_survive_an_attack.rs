//! Promise: no error that a history states as a bound is exceeded, whatever the mesh and the
//! options. Random adversarial meshes are built in every way, and a search looks for a point of the
//! input or of a step that is too far from the other. The search shares no code with the builder.
//! `tests/long` runs the long attack.

#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test")]
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small numbers")]

use nephrite::{
    BuildOptions, Decimator, JadeOptions, Placement, ProgressiveBound, ProgressiveOptions, TriangleMesh,
    build,
};
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

type Point = [f64; 3];

/// Numbers that look random (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// From -1 to 1.
    fn signed(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }
}

mod distance {
    //! Distances from a definition: the nearest point of a triangle is on its plane inside it, or
    //! on one of its sides.

    use super::Point;

    fn minus(a: Point, b: Point) -> Point {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }

    fn times(a: Point, b: Point) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    fn along(a: Point, b: Point, t: f64) -> Point {
        [0, 1, 2].map(|i: usize| a[i] + t * (b[i] - a[i]))
    }

    fn between(a: Point, b: Point) -> f64 {
        let d = minus(a, b);
        times(d, d)
    }

    fn to_side_sq(p: Point, a: Point, b: Point) -> f64 {
        let whole = between(a, b);
        let t = if whole > 0.0 { times(minus(p, a), minus(b, a)) / whole } else { 0.0 };
        between(p, along(a, b, t.clamp(0.0, 1.0)))
    }

    fn to_triangle_sq(p: Point, [a, b, c]: [Point; 3]) -> f64 {
        let mut least = to_side_sq(p, a, b).min(to_side_sq(p, b, c)).min(to_side_sq(p, c, a));
        // Gram-Schmidt in the plane.
        let (u, v, w) = (minus(b, a), minus(c, a), minus(p, a));
        let uu = times(u, u);
        let v_along = times(v, u) / uu;
        let v_across = [0, 1, 2].map(|i: usize| v[i] - v_along * u[i]);
        let across = times(v_across, v_across);
        let t = times(w, v_across) / across;
        let s = times(w, u) / uu - t * v_along;
        if s > 0.0 && t > 0.0 && s + t < 1.0 {
            let foot = [0, 1, 2].map(|i: usize| a[i] + s * u[i] + t * v[i]);
            least = least.min(between(p, foot));
        }
        least
    }

    fn to_surface(p: Point, surface: &[[Point; 3]]) -> f64 {
        surface.iter().map(|&triangle| to_triangle_sq(p, triangle)).fold(f64::INFINITY, f64::min).sqrt()
    }

    /// A point of `from` that is farther than `limit` from `to`, if one is found: triangles are
    /// halved until no point of a part can be too far, since distances differ by no more than their
    /// points; or until `effort` is used up.
    pub(super) fn beyond(
        from: &[[Point; 3]],
        to: &[[Point; 3]],
        limit: f64,
        mut effort: usize,
    ) -> Option<(Point, f64)> {
        let mut open: Vec<[Point; 3]> = from.to_vec();
        while let Some([a, b, c]) = open.pop() {
            let middle = [0, 1, 2].map(|i: usize| (a[i] + b[i] + c[i]) / 3.0);
            let radius =
                [a, b, c].map(|corner| between(middle, corner)).into_iter().fold(0.0, f64::max).sqrt();
            let found = to_surface(middle, to);
            if found > limit {
                return Some((middle, found));
            }
            for corner in [a, b, c] {
                let found = to_surface(corner, to);
                if found > limit {
                    return Some((corner, found));
                }
            }
            if found + radius <= limit || effort == 0 {
                continue;
            }
            effort -= 1;
            let sides = [(between(a, b), [a, b, c]), (between(b, c), [b, c, a]), (between(c, a), [c, a, b])];
            let (_, [p, q, r]) = sides.into_iter().max_by(|x, y| x.0.total_cmp(&y.0)).unwrap();
            let half = along(p, q, 0.5);
            open.extend([[p, half, r], [half, q, r]]);
        }
        None
    }
}

fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh { positions, triangles, ..TriangleMesh::default() }
}

/// A grid whose heights are a few steps up and down, and whose vertices may change places sideways:
/// folds, overlaps, flat parts.
fn folded_grid(random: &mut Random, columns: usize, rows: usize) -> TriangleMesh {
    let (steps, aside, height) =
        (random.pick(&[1.0, 4.0, 1e6]), random.pick(&[0.0, 0.3, 1.2]), random.pick(&[0.2, 1.0, 3.0]));
    let mut positions = vec![];
    for (x, y) in (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y))) {
        let z = (random.signed() * steps).round() / steps * height;
        positions.push([x as f32 + aside * random.signed(), y as f32 + aside * random.signed(), z]);
    }
    let mut triangles = vec![];
    for (x, y) in (1..columns).flat_map(|x| (1..rows).map(move |y| (x, y))) {
        let [a, b, c, d] =
            [(x - 1, y - 1), (x, y - 1), (x, y), (x - 1, y)].map(|(x, y)| (x * rows + y) as u32);
        triangles.extend(random.pick(&[[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]]));
    }
    mesh(positions, triangles)
}

/// Small parts far apart: triangles, two-sided ones, tetrahedra, strips.
fn confetti(random: &mut Random) -> TriangleMesh {
    let (mut positions, mut triangles) = (vec![], vec![]);
    let spread = random.pick(&[2.0, 10.0, 100.0]);
    for _ in 0..1 + random.below(12) {
        let place = [0; 3].map(|_| spread * random.signed());
        let size = random.pick(&[0.01, 0.3, 1.0, 4.0]);
        let n = positions.len() as u32;
        let kinds: [&[[u32; 3]]; 5] = [
            &[[0, 1, 2]],
            &[[0, 1, 2], [2, 1, 0]],
            &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
            &[[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]],
            &[[0, 1, 2], [0, 3, 4], [0, 5, 1]],
        ];
        positions.extend((0..6).map(|_| place.map(|x| x + size * random.signed())));
        triangles.extend(random.pick(&kinds).iter().map(|triangle| triangle.map(|v| v + n)));
    }
    mesh(positions, triangles)
}

/// Fans that share a vertex, or an edge, with radii and heights of all sizes: cones, bow ties,
/// pages, slivers.
fn crooked_fans(random: &mut Random) -> TriangleMesh {
    let mut positions = vec![[0.0; 3], [0.0, 0.0, 1.0]];
    let mut triangles = vec![];
    for _ in 0..1 + random.below(3) {
        let (n, is_closed) = (3 + random.below(12) as u32, random.below(2) == 0);
        let first = positions.len() as u32;
        for i in 0..n {
            let angle = std::f32::consts::TAU * (i as f32 + 0.45 * random.signed()) / n as f32;
            let radius = random.pick(&[0.01, 0.5, 1.0, 1.0, 20.0]);
            positions.push([
                radius * angle.cos(),
                radius * angle.sin(),
                random.pick(&[0.0, 0.1, 1.0]) * random.signed(),
            ]);
        }
        let last = if is_closed { n } else { n - 1 };
        let hub = random.below(2) as u32;
        triangles.extend((0..last).map(|i| [hub, first + i, first + (i + 1) % n]));
        if random.below(3) == 0 {
            triangles.extend((0..n).map(|i| [0, 1, first + i]));
        }
    }
    mesh(positions, triangles)
}

/// Triangles among a few points: edges with many faces, faces on both sides, whatever comes.
fn soup(random: &mut Random) -> TriangleMesh {
    let n = 4 + random.below(20);
    let positions: Vec<[f32; 3]> =
        (0..n).map(|_| [0; 3].map(|_| (random.signed() * 4.0).round() / 2.0)).collect();
    let triangles = (0..2 + random.below(3 * n)).map(|_| [0; 3].map(|_| random.below(n) as u32)).collect();
    mesh(positions, triangles)
}

/// Repeats triangles, in either orientation, and adds segments and points.
fn spoil(random: &mut Random, mesh: &mut TriangleMesh) {
    for _ in 0..random.below(4) {
        let [a, b, c] = random.pick(&mesh.triangles);
        let beside = mesh.positions[a as usize].map(|x| x + 0.7 * random.signed());
        mesh.positions.push(beside);
        let tip = mesh.positions.len() as u32 - 1;
        mesh.triangles.push(random.pick(&[[a, b, c], [c, b, a], [a, tip, a], [tip; 3], [a, b, b]]));
    }
}

fn random_mesh(random: &mut Random) -> TriangleMesh {
    let mut mesh = match random.below(4) {
        0 => {
            let [columns, rows] = [0; 2].map(|_| 2 + random.below(7));
            folded_grid(random, columns, rows)
        }
        1 => confetti(random),
        2 => crooked_fans(random),
        _ => soup(random),
    };
    if random.below(2) == 0 {
        spoil(random, &mut mesh);
    }
    mesh
}

/// Options whose errors are bounds: those of the certified proof, and all that the progressive
/// decimator states.
fn random_options(random: &mut Random, size: f64) -> BuildOptions {
    let jade = |placement| Decimator::from(JadeOptions::certified(placement));
    let progressive = |bound, pre_split| {
        Decimator::from(ProgressiveOptions { bound, pre_split, ..ProgressiveOptions::default() })
    };
    let is_split = random.below(4) == 0;
    let decimator = random.pick(&[
        jade(Placement::Original),
        jade(Placement::Best),
        progressive(ProgressiveBound::Certified, is_split),
        progressive(ProgressiveBound::Certified, is_split),
        progressive(ProgressiveBound::Accumulated, is_split),
    ]);
    BuildOptions {
        max_error: random.pick(&[None, Some(0.02), Some(0.1), Some(0.3)]).map(|part| part * size),
        feature_angle_degrees: random.pick(&[0.0, 30.0, 60.0, 180.0]),
        lock_boundary: random.below(5) == 0,
        ..BuildOptions::with(decimator)
    }
}

fn corners_of(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[Point; 3]> {
    triangles.iter().map(|t| t.map(|v| positions[v as usize].map(f64::from))).collect()
}

/// Length of the box around everything.
fn size_of(input: &[[Point; 3]]) -> f64 {
    let range = |axis: usize| {
        let values = input.iter().flatten().map(|p| p[axis]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    (0..3).map(|axis| range(axis).powi(2)).sum::<f64>().sqrt()
}

/// At most 400 of the triangles, evenly spread.
fn some_of(triangles: &[[Point; 3]]) -> Vec<[Point; 3]> {
    triangles.iter().step_by(triangles.len().div_ceil(400).max(1)).copied().collect()
}

/// Builds a mesh and searches some steps, each with this effort. How many were searched.
fn attack(what: &str, mesh: &TriangleMesh, options: &BuildOptions, n_steps: usize, effort: usize) -> usize {
    let input = corners_of(&mesh.positions, &mesh.triangles);
    let size = size_of(&input);
    let Ok(build) = build(mesh, options) else { return 0 };
    let history = build.history();
    let last = history.errors.len() - 1;
    let steps: BTreeSet<usize> = (0..=n_steps).map(|i| last * i / n_steps.max(1)).collect();
    let mut n_searched = 0;
    for step in steps {
        let stated = history.errors[step];
        let level = corners_of(build.vertices().positions, &history.alive(step as u32).collect::<Vec<_>>());
        if level.is_empty() || stated == f64::INFINITY {
            assert!(
                level.is_empty() && stated == f64::INFINITY,
                "{what}: {stated} of {} triangles",
                level.len()
            );
            continue;
        }
        let limit = stated + 1e-9 * size;
        let found = distance::beyond(&some_of(&input), &level, limit, effort);
        let found = found.or_else(|| distance::beyond(&some_of(&level), &input, limit, effort));
        assert!(
            found.is_none(),
            "{what}: step {step} of {last} states {stated}, {found:?} is farther; {options:?}, {} triangles in, {} left, {} steps certified",
            mesh.triangles.len(),
            level.len(),
            build.progressive().map_or(u32::MAX, |report| report.n_certified_steps),
        );
        n_searched += 1;
    }
    n_searched
}

fn attack_small(seed: u64, effort: usize) -> usize {
    let mut random = Random(seed);
    let mesh = random_mesh(&mut random);
    let size = size_of(&corners_of(&mesh.positions, &mesh.triangles)).max(1e-3);
    let options = random_options(&mut random, size);
    attack(&format!("seed {seed}"), &mesh, &options, 8, effort)
}

/// More than 4,096 slots, which are numbered anew on the way.
fn attack_large(seed: u64) -> usize {
    let mut random = Random(seed);
    let side = 48 + random.below(8);
    let mesh = folded_grid(&mut random, side, side);
    assert!(mesh.triangles.len() > 4096);
    let options = random_options(&mut random, side as f64);
    attack(&format!("large, seed {seed}"), &mesh, &options, 4, 0)
}

#[test]
fn a_short_attack() {
    let n_searched: usize = (0..300).map(|seed| attack_small(seed, 100)).sum();
    assert!(n_searched > 1000, "{n_searched}");
    assert!((0..2).map(attack_large).sum::<usize>() > 2);
}

#[test]
#[ignore = "some minutes"]
fn a_long_attack() {
    let start = Instant::now();
    let (mut seed, mut n_searched) = (1_000_000, 0);
    while start.elapsed() < Duration::from_secs(240) {
        n_searched += (seed..seed + 100).map(|seed| attack_small(seed, 300)).sum::<usize>();
        n_searched += attack_large(seed);
        seed += 100;
    }
    eprintln!("{n_searched} steps of {} meshes", seed - 1_000_000);
}
