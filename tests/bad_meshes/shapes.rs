//! Files that are in order and hold meshes that are not: topology and geometry of every unpleasant
//! kind, as OBJ.

use super::{Case, Cases};
use std::fmt::Write;

/// An OBJ of vertices, and of faces that count from 0.
fn obj(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Vec<u8> {
    let mut text = String::new();
    vertices.iter().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").unwrap());
    for face in faces {
        let corners: String = face.iter().map(|corner| format!(" {}", corner + 1)).collect();
        writeln!(text, "f{corners}").unwrap();
    }
    text.into_bytes()
}

/// A bumpy grid of `side * side` vertices.
fn grid(side: usize) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let vertices = (0..side * side)
        .map(|i| ((i % side) as f64, (i / side) as f64))
        .map(|(x, y)| [x, y, ((7.0 * x + 3.0 * y) % 5.0) / 8.0])
        .collect();
    let starts = (0..side * (side - 1)).filter(|i| i % side != side - 1);
    let faces =
        starts.flat_map(|i| [vec![i, i + 1, i + side + 1], vec![i, i + side + 1, i + side]]).collect();
    (vertices, faces)
}

fn mapped(side: usize, map: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<u8> {
    let (vertices, faces) = grid(side);
    obj(&vertices.into_iter().map(map).collect::<Vec<_>>(), &faces)
}

/// Triangles around an edge from the origin along z.
fn book(n_pages: usize) -> Vec<u8> {
    let mut vertices = vec![[0.0; 3], [0.0, 0.0, 1.0]];
    vertices.extend((0..n_pages).map(|i| [i as f64 + 1.0, (i * i % 97) as f64, 0.5]));
    obj(&vertices, &(0..n_pages).map(|i| vec![0, 1, i + 2]).collect::<Vec<_>>())
}

/// A closed fan about its first vertex.
fn fan(n_triangles: usize) -> Vec<u8> {
    let mut vertices = vec![[0.0; 3]];
    let angle = |i: usize| i as f64 * std::f64::consts::TAU / n_triangles as f64;
    vertices.extend((0..n_triangles).map(|i| [angle(i).cos(), angle(i).sin(), (i % 2) as f64 / 4.0]));
    // Rounded, so that the text is the same wherever it is made.
    let vertices: Vec<_> = vertices.iter().map(|v| v.map(|x| (x * 65536.0).round() / 65536.0)).collect();
    obj(&vertices, &(0..n_triangles).map(|i| vec![0, i + 1, (i + 1) % n_triangles + 1]).collect::<Vec<_>>())
}

/// A band of `n` quads, its end joined to its start upside down.
fn moebius(n: usize) -> Vec<u8> {
    let angle = |i: usize| i as f64 * std::f64::consts::TAU / n as f64;
    let edge = |i: usize, side: f64| {
        let (half, r) = (angle(i) / 2.0, 4.0);
        let out = r + side * half.cos();
        [out * angle(i).cos(), out * angle(i).sin(), side * half.sin()]
            .map(|x| (x * 65536.0).round() / 65536.0)
    };
    let vertices: Vec<_> = (0..n).flat_map(|i| [edge(i, -1.0), edge(i, 1.0)]).collect();
    let next = |i: usize| if i + 1 < n { [2 * i + 2, 2 * i + 3] } else { [1, 0] };
    let faces: Vec<_> = (0..n)
        .flat_map(|i| [vec![2 * i, 2 * i + 1, next(i)[0]], vec![next(i)[0], 2 * i + 1, next(i)[1]]])
        .collect();
    obj(&vertices, &faces)
}

fn components(n: usize) -> Vec<u8> {
    let at = |i: usize, x: f64, y: f64| [(i % 20) as f64 * 2.0 + x, (i / 20) as f64 * 2.0 + y, 0.0];
    let vertices: Vec<_> = (0..n).flat_map(|i| [at(i, 0.0, 0.0), at(i, 1.0, 0.0), at(i, 0.0, 1.0)]).collect();
    obj(&vertices, &(0..n).map(|i| vec![3 * i, 3 * i + 1, 3 * i + 2]).collect::<Vec<_>>())
}

pub(crate) fn cases() -> Vec<Case> {
    let lists = [of_a_grid(), of_few_faces(), positions(), polygons()];
    let shapes = lists.into_iter().flatten().map(|(name, bytes)| (format!("{name}.obj"), bytes));
    let others = [("unknown-text.xyz", &b"neither this nor that\n"[..]), ("empty", &[])];
    shapes.chain(others.map(|(name, bytes)| (name.to_owned(), bytes.to_vec()))).collect()
}

fn point(x: f64, y: f64) -> [f64; 3] {
    [x, y, 0.0]
}

/// The grid with more vertices and faces behind its own.
fn grid_and(more: &[[f64; 3]], more_faces: &[Vec<usize>]) -> Vec<u8> {
    let (vertices, faces) = grid(4);
    obj(&[&vertices[..], more].concat(), &[&faces[..], more_faces].concat())
}

/// What is wrong between faces.
fn of_a_grid() -> Cases {
    let (vertices, faces) = grid(4);
    let reversed = faces.iter().enumerate().map(|(i, face)| match i {
        4..8 => face.iter().rev().copied().collect(),
        _ => face.clone(),
    });
    vec![
        ("shape-edge-of-3-faces", book(3)),
        ("shape-edge-of-1000-faces", book(1000)),
        ("shape-fan-of-1000", fan(1000)),
        ("shape-moebius", moebius(16)),
        ("shape-200-components", components(200)),
        ("shape-one-patch-reversed", obj(&vertices, &reversed.collect::<Vec<_>>())),
        ("shape-isolated-vertices", grid_and(&[[9.0; 3], [8.0; 3]], &[])),
        ("shape-doubled-vertices", grid_and(&[vertices[0], vertices[5]], &[vec![16, 17, 1]])),
        ("shape-duplicate-faces", grid_and(&[], &[faces[0].clone(), faces[3].clone()])),
        ("shape-opposite-faces", grid_and(&[], &[faces[0].iter().rev().copied().collect()])),
    ]
}

/// Surfaces that meet themselves.
fn of_few_faces() -> Cases {
    vec![
        (
            "shape-bow-tie-vertex",
            obj(
                &[point(0.0, 0.0), point(1.0, 0.0), point(1.0, 1.0), point(-1.0, 0.0), point(-1.0, -1.0)],
                &[vec![0, 1, 2], vec![0, 3, 4]],
            ),
        ),
        (
            "shape-self-intersection",
            obj(
                &[
                    point(-1.0, -1.0),
                    point(1.0, -1.0),
                    point(0.0, 1.0),
                    [0.0, 0.0, -1.0],
                    [0.0, 0.0, 1.0],
                    [0.0, -2.0, 0.0],
                ],
                &[vec![0, 1, 2], vec![3, 4, 5]],
            ),
        ),
        (
            "shape-closed-tetrahedron-inside-out",
            obj(
                &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                &[vec![0, 1, 2], vec![0, 3, 1], vec![1, 3, 2], vec![0, 2, 3]],
            ),
        ),
        (
            "shape-two-tetrahedra-at-an-edge",
            obj(
                &[
                    [0.0; 3],
                    [0.0, 0.0, 1.0],
                    [1.0, 0.0, 0.5],
                    [1.0, 1.0, 0.5],
                    [-1.0, 0.0, 0.5],
                    [-1.0, -1.0, 0.5],
                ],
                &[
                    vec![0, 1, 2],
                    vec![0, 3, 1],
                    vec![0, 2, 3],
                    vec![1, 3, 2],
                    vec![0, 1, 4],
                    vec![0, 5, 1],
                    vec![0, 4, 5],
                    vec![1, 5, 4],
                ],
            ),
        ),
    ]
}

/// Positions at the ends of what numbers can be, and without area.
fn positions() -> Cases {
    vec![
        (
            "shape-zero-area",
            grid_and(&[[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [2.0, 0.0, 5.0]], &[vec![16, 17, 18]]),
        ),
        ("shape-all-equal", obj(&[[3.0; 3]; 4], &[vec![0, 1, 2], vec![1, 2, 3]])),
        ("shape-collinear", mapped(4, |[x, y, _]| [x + 4.0 * y, 0.0, 0.0])),
        ("shape-planar", mapped(5, |[x, y, _]| [x, y, 0.0])),
        ("shape-subnormal", mapped(4, |v| v.map(|x| x * 1e-42))),
        ("shape-subnormal-of-doubles", mapped(4, |v| v.map(|x| x * 1e-310))),
        ("shape-huge", mapped(4, |v| v.map(|x| x * 1e30))),
        ("shape-largest", mapped(4, |v| v.map(|x| x * 1.1e38))),
        ("shape-wide-range", mapped(4, |[x, y, z]| [x * 1e30, y * 1e-30, z])),
        ("shape-far-from-origin", mapped(4, |[x, y, z]| [x * 1e-3 + 1e7, y * 1e-3 - 1e7, z * 1e-3])),
        (
            "shape-collapses-in-f32",
            mapped(4, |[x, y, z]| [x * 1e-10 + 1.0, y * 1e-10 + 1.0, z * 1e-10 + 1.0]),
        ),
    ]
}

/// Faces of more than three corners.
fn polygons() -> Cases {
    vec![
        (
            "shape-concave-polygon",
            obj(
                &[point(0.0, 0.0), point(4.0, 0.0), point(4.0, 4.0), point(2.0, 1.0), point(0.0, 4.0)],
                &[vec![0, 1, 2, 3, 4]],
            ),
        ),
        (
            "shape-polygon-crosses-itself",
            obj(&[point(0.0, 0.0), point(4.0, 4.0), point(4.0, 0.0), point(0.0, 4.0)], &[vec![0, 1, 2, 3]]),
        ),
        (
            "shape-polygon-not-planar",
            obj(&[point(0.0, 0.0), [4.0, 0.0, 3.0], point(4.0, 4.0), [0.0, 4.0, 3.0]], &[vec![0, 1, 2, 3]]),
        ),
        (
            "shape-polygon-visits-a-corner-twice",
            obj(
                &[point(0.0, 0.0), point(2.0, 0.0), point(2.0, 2.0), point(-2.0, 0.0), point(-2.0, -2.0)],
                &[vec![0, 1, 2, 0, 3, 4]],
            ),
        ),
        (
            "shape-polygon-collinear",
            obj(&[point(0.0, 0.0), point(1.0, 0.0), point(2.0, 0.0), point(3.0, 0.0)], &[vec![0, 1, 2, 3]]),
        ),
    ]
}
