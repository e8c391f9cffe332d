//! Promise: certified errors hold for defective patches: rolled up, torn, folded over, with faces
//! missing, reversed or added anywhere, cut by seams, with coordinates that are tiny, huge or far
//! away; one by one, and all together in one mesh. Proven from the files, without the builder.

#![allow(clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small meshes")]

mod support;

use nephrite::{
    Attribute, BuildError, BuildOptions, ErrorTable, JadeOptions, Placement, ProgressiveOptions, ScalarType,
    TriangleMesh, build,
};
use support::served::served;
use support::synthetic::Random;

/// How a patch is rolled up.
#[derive(Clone, Copy)]
enum Roll {
    Flat,
    Tube,
    Torus,
}

/// A patch of squares, most of them two triangles, with the defects that the random numbers choose.
fn patch(random: &mut Random) -> TriangleMesh {
    let side = 2 + random.below(9);
    let roll = [Roll::Flat, Roll::Tube, Roll::Torus][random.below(3)];
    let relief = [0.0, 0.02, 0.25, 2.0][random.below(4)];
    let (wraps_x, wraps_y) = match roll {
        Roll::Flat => (false, false),
        Roll::Tube => (true, false),
        Roll::Torus => (true, true),
    };
    let turn = |i: usize| (i as f32 / side as f32 * std::f32::consts::TAU).sin_cos();
    let mut positions = vec![];
    for y in 0..=side {
        for x in 0..=side {
            let bump = (random.below(256) as f32 / 128.0 - 1.0) * relief;
            let ((sin_x, cos_x), (sin_y, cos_y)) = (turn(x), turn(y));
            let radius = 5.0 + cos_y * (2.0 + bump);
            positions.push(match roll {
                Roll::Flat => [x as f32, y as f32, bump],
                Roll::Tube => [cos_x * (3.0 + bump), sin_x * (3.0 + bump), y as f32],
                Roll::Torus => [cos_x * radius, sin_x * radius, sin_y * (2.0 + bump)],
            });
        }
    }
    let vertex = |x: usize, y: usize| {
        let x = if wraps_x { x % side } else { x };
        let y = if wraps_y { y % side } else { y };
        (y * (side + 1) + x) as u32
    };
    let mut triangles = vec![];
    for y in 0..side {
        for x in 0..side {
            let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
            let [first, second] =
                if random.below(2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            match random.below(32) {
                0 => {}
                1 => triangles.push(first),
                2 => triangles.extend([first, [second[1], second[0], second[2]]]),
                _ => triangles.extend([first, second]),
            }
        }
    }
    for _ in 0..random.below(5) * random.below(2) {
        triangles.push([(); 3].map(|()| random.below(positions.len()) as u32));
    }
    TriangleMesh { positions, triangles, ..TriangleMesh::default() }
}

/// The same with a colour for each third of the triangles, so that there is a seam between the
/// thirds.
fn coloured(mesh: &TriangleMesh) -> TriangleMesh {
    let n_triangles = mesh.triangles.len();
    let corners = || mesh.triangles.iter().flatten();
    let colors = (0..n_triangles).flat_map(|t| [u8::try_from(3 * t / n_triangles.max(1)).unwrap(); 3]);
    TriangleMesh {
        positions: corners().map(|&v| mesh.positions[v as usize]).collect(),
        triangles: (0..n_triangles as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        attributes: vec![Attribute {
            name: "color".into(),
            scalar: ScalarType::U8,
            n_components: 1,
            bytes: colors.collect(),
        }],
        ..TriangleMesh::default()
    }
}

fn ways() -> [BuildOptions; 4] {
    let usual = BuildOptions::default();
    [
        usual,
        BuildOptions { feature_angle_degrees: 0.0, ..usual },
        BuildOptions::with(JadeOptions::certified(Placement::Best)),
        BuildOptions::with(ProgressiveOptions::default()),
    ]
}

/// Builds a mesh and proves the errors of `n` levels, the last one among them. Returns the number
/// of levels; 0 if no triangle has an area.
fn check(name: &str, mesh: &TriangleMesh, options: &BuildOptions, n: u32) -> u32 {
    let build = match build(mesh, options) {
        Err(BuildError::NoTriangles { .. }) => return 0,
        build => build.unwrap(),
    };
    let lod = served(|stream, options| build.write_to(stream, options));
    let table = ErrorTable::new(&lod).unwrap();
    let last = (0..=table.last_certified()).rev().find(|&level| lod.at_level(level).n_simplices() > 0);
    let last = last.unwrap_or(0);
    for level in (1..=n).map(|i| last * i / n) {
        table.prove(level).unwrap_or_else(|error| panic!("{name}, {options:?}: {error}"));
    }
    lod.n_levels()
}

#[test]
fn of_each() {
    let mut random = Random(17);
    let mut n_levels = 0;
    for i in 0..150 {
        let mut mesh = patch(&mut random);
        let scale: f32 = [1.0, 1.0, 1e-3, 1e-30, 1e-40, 1e30][random.below(6)];
        let offset = [0.0, 0.0, 1e5, 1e7][random.below(4)] * scale;
        mesh.positions.iter_mut().flatten().for_each(|x| *x = *x * scale + offset);
        if random.below(3) == 0 {
            mesh = coloured(&mesh);
        }
        let options = &ways()[random.below(4)];
        n_levels += check(&format!("patch {i}"), &mesh, options, 4);
    }
    assert!(n_levels > 1500, "{n_levels}");
}

#[test]
fn of_all_together() {
    let mut random = Random(23);
    let mut all = TriangleMesh::default();
    // Enough triangles for slots to close up and pools to give back their gaps.
    while all.triangles.len() < 12_000 {
        let mesh = patch(&mut random);
        let offset = all.positions.len() as u32;
        let place = [(); 3].map(|()| random.below(60) as f32);
        all.positions.extend(mesh.positions.iter().map(|p| std::array::from_fn(|i| p[i] + place[i])));
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + offset)));
    }
    for options in &ways() {
        check("all patches", &all, options, 3);
    }
    check("all patches, coloured", &coloured(&all), &BuildOptions::default(), 3);
}
