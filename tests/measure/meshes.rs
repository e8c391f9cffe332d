//! Surfaces whose distances are known in closed form.

use nephrite::TriangleMesh;

pub(crate) fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh { positions, triangles, ..TriangleMesh::default() }
}

/// A grid of `n` by `n` cells over the rectangle from (0, 0) to `size`, at height `z(x, y)`.
pub(crate) fn grid(n: u32, size: [f32; 2], z: impl Fn(f32, f32) -> f32) -> TriangleMesh {
    let at = |i: u32, side: f32| i as f32 / n as f32 * side;
    let positions = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| (i, j)))
        .map(|(i, j)| (at(i, size[0]), at(j, size[1])))
        .map(|(x, y)| [x, y, z(x, y)])
        .collect();
    let triangles = (0..n)
        .flat_map(|j| (0..n).map(move |i| j * (n + 1) + i))
        .flat_map(|v| [[v, v + 1, v + n + 2], [v, v + n + 2, v + n + 1]])
        .collect();
    mesh(positions, triangles)
}

/// A sphere of radius 1 about the origin, an octahedron whose triangles are quartered `levels`
/// times.
pub(crate) fn sphere(levels: u32) -> TriangleMesh {
    let mut positions: Vec<[f32; 3]> = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum: [f32; 3] =
                    std::array::from_fn(|i| positions[a as usize][i] + positions[b as usize][i]);
                let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
                positions.push(sum.map(|x| x / length));
                u32::try_from(positions.len() - 1).unwrap()
            })
        };
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    mesh(positions, triangles)
}

/// Every coordinate times `factor`, rounded to `f32`.
pub(crate) fn scaled(mesh: &TriangleMesh, factor: f32) -> TriangleMesh {
    let positions = mesh.positions.iter().map(|p| p.map(|x| x * factor)).collect();
    TriangleMesh { positions, ..mesh.clone() }
}

/// Corners of a triangle in `f64`.
pub(crate) fn corners(mesh: &TriangleMesh, triangle: usize) -> [[f64; 3]; 3] {
    mesh.triangles[triangle].map(|v| mesh.positions[v as usize].map(f64::from))
}
