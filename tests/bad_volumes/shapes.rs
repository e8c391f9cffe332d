//! Files that are in order and hold volumes that are not: topology and geometry of every unpleasant
//! kind, as legacy VTK.

use super::Case;
use std::fmt::Write;

/// A legacy VTK file of tetrahedra.
fn vtk(points: &[[f64; 3]], tetrahedra: &[[usize; 4]]) -> Vec<u8> {
    let mut text = format!(
        "# vtk DataFile Version 3.0\nshape\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
        points.len()
    );
    points.iter().for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").unwrap());
    writeln!(text, "CELLS {} {}", tetrahedra.len(), 5 * tetrahedra.len()).unwrap();
    tetrahedra.iter().for_each(|[a, b, c, d]| writeln!(text, "4 {a} {b} {c} {d}").unwrap());
    writeln!(text, "CELL_TYPES {}", tetrahedra.len()).unwrap();
    tetrahedra.iter().for_each(|_| text.push_str("10\n"));
    text.into_bytes()
}

/// A cube of `side` cells along each axis, each cut into six tetrahedra around its diagonal.
fn cube(side: usize) -> (Vec<[f64; 3]>, Vec<[usize; 4]>) {
    let n = side + 1;
    let at = |[x, y, z]: [usize; 3]| (z * n + y) * n + x;
    let points = (0..n * n * n).map(|i| [i % n, i / n % n, i / (n * n)].map(|x| x as f64)).collect();
    let mut tetrahedra = Vec::new();
    for cell in (0..side * side * side).map(|i| [i % side, i / side % side, i / (side * side)]) {
        for [a, b, c] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]] {
            let mut corner = cell;
            let mut path = [at(cell); 4];
            for (place, axis) in path[1..].iter_mut().zip([a, b, c]) {
                corner[axis] += 1;
                *place = at(corner);
            }
            // Every other order of the axes turns it inside out.
            if [[0, 2, 1], [1, 0, 2], [2, 1, 0]].contains(&[a, b, c]) {
                path.swap(2, 3);
            }
            tetrahedra.push(path);
        }
    }
    (points, tetrahedra)
}

fn mapped(map: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<u8> {
    let (points, tetrahedra) = cube(2);
    vtk(&points.into_iter().map(map).collect::<Vec<_>>(), &tetrahedra)
}

/// Tetrahedra around the edge from the origin along z.
fn fan(n: usize) -> Vec<u8> {
    let angle = |i: usize| i as f64 * std::f64::consts::TAU / n as f64;
    let round = |x: f64| (x * 65536.0).round() / 65536.0;
    let mut points = vec![[0.0; 3], [0.0, 0.0, 1.0]];
    points.extend((0..n).map(|i| [round(angle(i).cos()), round(angle(i).sin()), 0.5]));
    vtk(&points, &(0..n).map(|i| [0, 1, i + 2, (i + 1) % n + 2]).collect::<Vec<_>>())
}

fn components(n: usize) -> Vec<u8> {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let points: Vec<_> = (0..n)
        .flat_map(|i| corners.map(|[x, y, z]| [x + 2.0 * (i % 20) as f64, y + 2.0 * (i / 20) as f64, z]))
        .collect();
    vtk(&points, &(0..n).map(|i| [4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3]).collect::<Vec<_>>())
}

pub(crate) fn cases() -> Vec<Case> {
    let lists = [topology(), positions()];
    lists
        .into_iter()
        .flatten()
        .map(|(name, bytes)| (format!("shape-{name}.vtk"), bytes))
        .chain(unknown())
        .collect()
}

fn topology() -> Vec<(&'static str, Vec<u8>)> {
    let (points, tetrahedra) = cube(2);
    let with = |more: &[[usize; 4]]| vtk(&points, &[&tetrahedra[..], more].concat());
    let with_points = |more: &[[f64; 3]], more_tetrahedra: &[[usize; 4]]| {
        vtk(&[&points[..], more].concat(), &[&tetrahedra[..], more_tetrahedra].concat())
    };
    let [first, ..] = tetrahedra[..] else { return Vec::new() };
    let inverted = |is_inverted: fn(usize) -> bool| {
        let turn = |(i, t): (usize, &[usize; 4])| if is_inverted(i) { [t[1], t[0], t[2], t[3]] } else { *t };
        vtk(&points, &tetrahedra.iter().enumerate().map(turn).collect::<Vec<_>>())
    };
    vec![
        ("whole", vtk(&points, &tetrahedra)),
        ("one-tetrahedron", components(1)),
        ("200-components", components(200)),
        ("all-inverted", inverted(|_| true)),
        ("one-inverted", inverted(|i| i == 20)),
        ("half-inverted", inverted(|i| i % 2 == 0)),
        ("duplicate", with(&[first, first])),
        ("duplicate-inverted", with(&[[first[1], first[0], first[2], first[3]]])),
        ("corner-repeated", with(&[[0, 0, 1, 2]])),
        ("face-of-three", with_points(&[[-1.0; 3]], &[[first[0], first[1], first[2], 27]])),
        ("overlapping", with(&[[0, 2, 6, 18]])),
        ("isolated-vertices", with_points(&[[9.0; 3], [8.0; 3]], &[])),
        (
            "touching-at-a-vertex",
            with_points(&[[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]], &[[0, 28, 27, 29]]),
        ),
        ("touching-at-an-edge", with_points(&[[-1.0, -1.0, 0.0], [-1.0, -1.0, 1.0]], &[[0, 9, 27, 28]])),
        ("fan-of-1000", fan(1000)),
        ("fan-of-3", fan(3)),
    ]
}

fn positions() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("all-equal", mapped(|_| [3.0; 3])),
        ("collinear", mapped(|[x, y, z]| [x + 4.0 * y + 16.0 * z, 0.0, 0.0])),
        ("planar", mapped(|[x, y, _]| [x, y, 0.0])),
        ("one-layer-flat", mapped(|[x, y, z]| [x, y, z.min(1.0)])),
        ("nearly-flat", mapped(|[x, y, z]| [x, y, z * 1e-20])),
        ("subnormal", mapped(|point| point.map(|x| x * 1e-42))),
        ("subnormal-of-doubles", mapped(|point| point.map(|x| x * 1e-310))),
        ("huge", mapped(|point| point.map(|x| x * 1e30))),
        ("largest", mapped(|point| point.map(|x| x * 1.6e38))),
        ("wide-range", mapped(|[x, y, z]| [x * 1e30, y * 1e-30, z])),
        ("far-from-origin", mapped(|[x, y, z]| [x * 1e-3 + 1e7, y * 1e-3 - 1e7, z * 1e-3])),
        ("collapses-in-f32", mapped(|point| point.map(|x| x * 1e-10 + 1.0))),
        ("inside-out", mapped(|[x, y, z]| [-x, y, z])),
        ("folded", mapped(|[x, y, z]| [if x > 1.5 { 0.5 } else { x }, y, z])),
        ("middle-outside", mapped(|point| if point == [1.0; 3] { [5.0; 3] } else { point })),
    ]
}

fn unknown() -> Vec<Case> {
    vec![
        ("unknown-text.xyz".to_owned(), b"neither this nor that\n".to_vec()),
        ("empty".to_owned(), Vec::new()),
    ]
}
