//! Promise: volumes with tetrahedra missing, inverted, doubled or added anywhere, with vertices out
//! of place, flat, tiny, huge or far away, keep the promises of every volume. No fusion inverts or
//! flattens a tetrahedron or loses volume, and no level is farther from the boundary than it
//! states. Proven from the files, without the builder.

#![allow(clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small meshes")]

mod support;

use nephrite::generate::{ball_volume, box_volume};
use nephrite::measure::{Verdict, check_within};
use nephrite::{Attribute, BuildError, ErrorTable, ScalarType, TetrahedronMesh, VolumeOptions, build_volume};
use std::collections::{BTreeMap, BTreeSet};
use support::served::served;
use support::synthetic::Random;

/// A box or a ball, with the defects that the random numbers choose.
fn volume(random: &mut Random) -> TetrahedronMesh {
    let mut mesh = match random.below(3) {
        0 => ball_volume(2 + random.below(5) as u32),
        _ => box_volume([(); 3].map(|()| 1 + random.below(5) as u32)),
    };
    let jolt = [0.0, 0.0, 0.01, 0.05, 0.3][random.below(5)];
    for p in &mut mesh.positions {
        *p = p.map(|x| x + (random.below(256) as f32 / 128.0 - 1.0) * jolt);
        if random.below(200) == 0 {
            p[2] = 0.0;
        }
    }
    let n_vertices = mesh.positions.len();
    let (missing, turned) = ([0, 5, 30][random.below(3)], [0, 0, 3][random.below(3)]);
    let tetrahedra = std::mem::take(&mut mesh.tetrahedra);
    for mut tetrahedron in tetrahedra {
        let roll = random.below(100);
        if roll >= 100 - turned {
            tetrahedron.swap(0, 1);
        }
        if roll >= missing {
            mesh.tetrahedra.push(tetrahedron);
        }
        if roll == 50 && random.below(20) == 0 {
            mesh.tetrahedra.push(tetrahedron);
        }
    }
    for _ in 0..random.below(4) * random.below(2) {
        mesh.tetrahedra.push([(); 4].map(|()| random.below(n_vertices) as u32));
    }
    let scale: f32 = [1.0, 1.0, 1.0, 1e-3, 1e-30, 1e30][random.below(6)];
    let offset = [0.0, 0.0, 1e3, 1e6][random.below(4)] * scale;
    mesh.positions.iter_mut().flatten().for_each(|x| *x = *x * scale + offset);
    mesh
}

/// The mesh with vertices that no two parts share, and the part of each vertex as a field.
fn in_parts(mesh: &TetrahedronMesh, random: &mut Random) -> TetrahedronMesh {
    let mut split = TetrahedronMesh { positions: vec![], attributes: vec![], ..mesh.clone() };
    let (mut numbers, mut parts) = (BTreeMap::new(), Vec::new());
    let (n_parts, middle) = (random.below(3), mesh.positions[mesh.positions.len() / 2][0]);
    for (i, tetrahedron) in split.tetrahedra.iter_mut().enumerate() {
        let part = match n_parts {
            0 => usize::from(mesh.positions[tetrahedron[0] as usize][0] > middle),
            1 => random.below(3),
            _ => i,
        };
        for v in tetrahedron {
            *v = *numbers.entry((*v, part)).or_insert_with(|| {
                split.positions.push(mesh.positions[*v as usize]);
                parts.push(part as f64);
                parts.len() as u32 - 1
            });
        }
    }
    split.attributes = vec![Attribute::from_values("part", ScalarType::F64, 1, parts)];
    split
}

/// Positions of the corners of tetrahedra whose volume is not positive.
fn not_positive(mesh: &TetrahedronMesh) -> BTreeSet<[[u32; 3]; 4]> {
    let bad = mesh.tetrahedra.iter().filter(|&&t| mesh.six_volumes(t) <= 0.0);
    let positions = |t: &[u32; 4]| t.map(|v| mesh.positions[v as usize].map(f32::to_bits));
    let sorted = |mut corners: [[u32; 3]; 4]| {
        corners.sort_unstable();
        corners
    };
    bad.map(positions).map(sorted).collect()
}

/// Number of levels; 0 if no tetrahedron is left.
fn check(name: &str, mesh: &TetrahedronMesh, options: &VolumeOptions) -> u32 {
    let build = match build_volume(mesh, options) {
        Err(BuildError::NoTetrahedra { .. }) => return 0,
        build => build.unwrap(),
    };
    let lod = served(|stream, options| build.write_to(stream, options));
    let table = ErrorTable::new(&lod).unwrap();
    let first = lod.at_level(0).to_volume().unwrap();
    // What the repair peels off is counted.
    let surfaces = [mesh, &first].map(|mesh| nephrite::boundary(mesh).unwrap());
    if !surfaces.iter().any(|surface| surface.triangles.is_empty()) {
        let largest = mesh.positions.iter().flatten().fold(0.0_f32, |largest, x| largest.max(x.abs()));
        let limit = build.history().errors[0] + 4.0 * f64::from(f32::EPSILON * largest);
        let verdict = check_within(&surfaces[0], &surfaces[1], limit, 5_000_000).unwrap();
        assert_eq!(verdict, Verdict::Within, "{name}: level 0 states {}", build.history().errors[0]);
    }
    // Repair rights what it can; the rest stays as it was.
    let bad_at_first = not_positive(&first);
    let last = lod.n_levels() - 1;
    for level in (0..=4).map(|i| last * i / 4) {
        let mesh = lod.at_level(level).to_volume().unwrap();
        mesh.check().unwrap();
        assert!(not_positive(&mesh).is_subset(&bad_at_first), "{name}: inverted at level {level}");
        let kept = mesh.volume() / first.volume();
        let is_known = build.repairs().tetrahedra_inverted == 0;
        assert!(!is_known || (kept - 1.0).abs() <= 0.001, "{name}: {kept} of the volume at level {level}");
        table.prove(level).unwrap_or_else(|error| panic!("{name}: {error}"));
        if let Some(parts) = mesh.attribute("part") {
            let parts: Vec<f64> = parts.values().collect();
            let is_of = |v: u32, part: f64| (parts[v as usize] - part).abs() < 1e-6;
            let is_one = |t: &[u32; 4]| t.iter().all(|&v| is_of(v, parts[t[0] as usize]));
            assert!(mesh.tetrahedra.iter().all(is_one), "{name}: a value crosses a jump at level {level}");
        }
    }
    lod.n_levels()
}

#[test]
fn of_each() {
    let mut random = Random(5);
    let mut n_levels = 0;
    for i in 0..200 {
        let mesh = volume(&mut random);
        let mut options = VolumeOptions::default();
        options.fusion.tetrahedron_share = [0.1, 1.0, 0.0][random.below(3)];
        n_levels += check(&format!("volume {i}"), &mesh, &options);
    }
    assert!(n_levels > 2000, "{n_levels}");
}

#[test]
fn of_each_in_parts() {
    let mut random = Random(7);
    let mut n_levels = 0;
    for i in 0..100 {
        let mesh = volume(&mut random);
        let mesh = in_parts(&mesh, &mut random);
        n_levels += check(&format!("volume {i} in parts"), &mesh, &VolumeOptions::default());
    }
    assert!(n_levels > 250, "{n_levels}");
}

/// A flat tetrahedron over two others, whose edge is pushed up through it: it is inside out.
fn inside_out() -> TetrahedronMesh {
    TetrahedronMesh {
        positions: vec![[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [0.5, 0.5, -1.0]],
        tetrahedra: vec![[0, 1, 2, 3], [3, 2, 0, 4], [2, 3, 1, 4]],
        ..TetrahedronMesh::default()
    }
}

#[test]
fn what_the_repair_drops_counts_at_every_level() {
    let build = |mesh: &TetrahedronMesh| {
        let build = build_volume(mesh, &VolumeOptions::default()).unwrap();
        assert!(build.history().errors.iter().all(|&error| error >= build.dropped_distance()));
        (*build.repairs(), build.dropped_distance())
    };
    // The middle of the edge that goes is 0.5 above that of the edge that comes, and 0.5 sin(54.7)
    // from the faces there.
    let (repairs, distance) = build(&inside_out());
    assert_eq!(repairs.tetrahedra_peeled, 1);
    assert!((0.408..0.413).contains(&distance), "{distance}");
    // Tetrahedra with fewer than four points: an edge of another one, and a triangle 5 units high
    // beside it.
    let mut mesh = TetrahedronMesh { tetrahedra: vec![[3, 2, 0, 4], [0, 0, 2, 3]], ..inside_out() };
    assert_eq!(build(&mesh).1, 0.0);
    mesh.positions.push([0.0, 0.0, 6.0]);
    mesh.tetrahedra.push([2, 5, 3, 2]);
    let (repairs, distance) = build(&mesh);
    assert_eq!(repairs.tetrahedra_degenerate, 2);
    assert!((5.5..5.65).contains(&distance), "{distance}");
}
