//! Tetrahedral volumes with known answers: a box with a linear field, and a ball.

use nephrite_formats::{Attribute, ScalarType, TetrahedronMesh};

/// Largest count of cells along one direction of a volume.
const MAX_CELLS: u32 = 400;

/// The box [0, 1]^3 in `cells` hexahedra along each axis (each in `1..=400`), five tetrahedra per
/// hexahedron. The cut alternates so that neighbours share their faces. The field `linear` is
/// `1 + 2 x + 3 y - 4 z`, in `f64`.
pub fn box_volume(cells: [u32; 3]) -> TetrahedronMesh {
    let cells = cells.map(|n| n.clamp(1, MAX_CELLS));
    let mut mesh = lattice(cells, |point| point);
    let linear = mesh.positions.iter().map(|p| {
        let [x, y, z] = p.map(f64::from);
        1.0 + 2.0 * x + 3.0 * y - 4.0 * z
    });
    mesh.attributes = vec![Attribute::from_values("linear", ScalarType::F64, 1, linear)];
    mesh
}

/// The unit ball: a lattice of `cells` hexahedra along each axis (in `1..=400`) whose cube is
/// mapped to the ball. The field `radius` is the distance from the centre, in `f32`.
pub fn ball_volume(cells: u32) -> TetrahedronMesh {
    let cells = cells.clamp(1, MAX_CELLS);
    let mut mesh = lattice([cells; 3], |point| {
        let centred = point.map(|x| 2.0 * x - 1.0);
        let largest = centred.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let length = centred.iter().map(|x| x * x).sum::<f64>().sqrt();
        // Shells of the cube become shells of the ball.
        if length > 0.0 { centred.map(|x| x * largest / length) } else { centred }
    });
    let radius = mesh.positions.iter().map(|p| p.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt());
    mesh.attributes = vec![Attribute::from_values("radius", ScalarType::F32, 1, radius)];
    mesh
}

fn lattice([ni, nj, nk]: [u32; 3], place: impl Fn([f64; 3]) -> [f64; 3]) -> TetrahedronMesh {
    let mut mesh = TetrahedronMesh::default();
    let part = |i: u32, n: u32| f64::from(i) / f64::from(n);
    for k in 0..=nk {
        for j in 0..=nj {
            for i in 0..=ni {
                #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is the point")]
                mesh.positions.push(place([part(i, ni), part(j, nj), part(k, nk)]).map(|x| x as f32));
            }
        }
    }
    let vertex = |[i, j, k]: [u32; 3]| (k * (nj + 1) + j) * (ni + 1) + i;
    for k in 0..nk {
        for j in 0..nj {
            for i in 0..ni {
                // Corner `c` of a cell is one step along axis `a` where bit `a` of `c` is set; odd
                // cells are mirrored.
                let mirror = if (i + j + k) % 2 == 1 { 1 } else { 0 };
                let corner = |c: u32| {
                    let c = c ^ mirror;
                    vertex([i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)])
                };
                for [a, b, c, d] in [[1, 3, 0, 5], [2, 0, 3, 6], [4, 0, 6, 5], [7, 3, 5, 6], [0, 3, 6, 5]] {
                    let mut corners = [a, b, c, d].map(corner);
                    if mirror == 1 {
                        corners.swap(0, 1);
                    }
                    mesh.tetrahedra.push(corners);
                }
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(mesh: &TetrahedronMesh, volume: f64, tolerance: f64) {
        mesh.check().unwrap();
        assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0));
        assert!((mesh.volume() / volume - 1.0).abs() < tolerance, "{}", mesh.volume());
        // A closed surface around it: every edge of the boundary has two faces.
        let surface = crate::volume::boundary_of_checked(mesh);
        let mut edges: Vec<[u32; 2]> = surface
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        assert!(edges.chunk_by(|a, b| a == b).all(|faces| faces.len() == 2));
        assert_eq!(surface.positions.len() + surface.triangles.len() - edges.len() / 2, 2);
    }

    #[test]
    fn volumes_are_whole() {
        check(&box_volume([1, 1, 1]), 1.0, 1e-12);
        check(&box_volume([3, 4, 5]), 1.0, 1e-6);
        check(&ball_volume(20), 4.0 / 3.0 * std::f64::consts::PI, 0.02);
        assert_eq!(box_volume([3, 4, 5]).tetrahedra.len(), 300);
    }
}
