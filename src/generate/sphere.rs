//! A sphere of nearly equal triangles: an icosahedron whose faces are subdivided and projected
//! outwards.

use std::collections::HashMap;

use nephrite_formats::TriangleMesh;

use super::mesh_of;
use crate::geometry::vector::{cross, dot, length, scale, sub};

/// Largest frequency: 20 million triangles.
const MAX_FREQUENCY: u32 = 1000;

/// The unit sphere about the origin: an icosahedron with every edge cut into `frequency` parts.
///
/// `20 * frequency^2` triangles over `10 * frequency^2 + 2` vertices, all on the sphere to the
/// precision of `f32`; `frequency` in `1..=1000`. The enclosed volume is a little smaller than that
/// of the ball.
pub fn sphere(frequency: u32) -> TriangleMesh {
    let frequency = frequency.clamp(1, MAX_FREQUENCY);
    let corners = icosahedron();
    let mut surface = Subdivision { corners, ids: HashMap::new(), positions: Vec::new() };
    let mut triangles = Vec::with_capacity(20 * frequency as usize * frequency as usize);
    for face in icosahedron_faces(&corners) {
        for row in 0..frequency {
            let width = frequency - row;
            for column in 0..width {
                let mut at = |column: u32, row: u32| {
                    surface.vertex([(face[0], frequency - column - row), (face[1], column), (face[2], row)])
                };
                let [left, right, high] = [at(column, row), at(column + 1, row), at(column, row + 1)];
                triangles.push([left, right, high]);
                if column + 1 < width {
                    triangles.push([right, at(column + 1, row + 1), high]);
                }
            }
        }
    }
    mesh_of(&surface.positions, triangles)
}

/// The frequency of the sphere whose number of triangles is nearest to `n_triangles`.
pub fn sphere_frequency(n_triangles: u32) -> u32 {
    let count = |frequency: u32| 20 * frequency * frequency;
    let below = (n_triangles / 20).isqrt().clamp(1, MAX_FREQUENCY - 1);
    if n_triangles.abs_diff(count(below)) <= n_triangles.abs_diff(count(below + 1)) {
        below
    } else {
        below + 1
    }
}

/// A corner of the icosahedron and its share of a point, in units of `1 / frequency`.
type Share = (u32, u32);

/// Vertices so far, shared by all faces.
struct Subdivision {
    corners: [[f64; 3]; 12],
    ids: HashMap<[Share; 3], u32>,
    positions: Vec<[f64; 3]>,
}

impl Subdivision {
    /// The vertex in the direction of the weighted sum of three corners.
    ///
    /// Corners of weight 0 are left out and the others sorted, so that the faces at an edge share
    /// its vertices.
    fn vertex(&mut self, mut shares: [Share; 3]) -> u32 {
        for share in &mut shares {
            if share.1 == 0 {
                *share = (0, 0);
            }
        }
        shares.sort_unstable();
        let next = u32::try_from(self.ids.len()).unwrap_or(u32::MAX);
        *self.ids.entry(shares).or_insert_with(|| {
            let mut sum = [0.0; 3];
            for (corner, weight) in shares {
                for (sum, coordinate) in sum.iter_mut().zip(self.corners[corner as usize]) {
                    *sum += f64::from(weight) * coordinate;
                }
            }
            self.positions.push(scale(sum, 1.0 / length(sum)));
            next
        })
    }
}

/// The cyclic permutations of `(0, +-1, +-golden ratio)`: edges have length 2.
fn icosahedron() -> [[f64; 3]; 12] {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    std::array::from_fn(|index| {
        let one = if index & 1 == 0 { 1.0 } else { -1.0 };
        let long = if index & 2 == 0 { golden } else { -golden };
        let mut corner = [0.0, one, long];
        corner.rotate_right(index / 4);
        corner
    })
}

/// All triples of corners that are neighbours of one another, counter-clockwise from outside.
fn icosahedron_faces(corners: &[[f64; 3]; 12]) -> Vec<[u32; 3]> {
    let near = |a: u32, b: u32| {
        let difference = sub(corners[a as usize], corners[b as usize]);
        dot(difference, difference) < 5.0
    };
    let mut faces = Vec::with_capacity(20);
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let [p, q, r] = [a, b, c].map(|corner| corners[corner as usize]);
                    let faces_outwards = dot(p, cross(q, r)) > 0.0;
                    faces.push(if faces_outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    #[test]
    fn is_a_closed_sphere_at_every_frequency() {
        for frequency in [1, 2, 3, 7, 20] {
            let mesh = sphere(frequency);
            let topology = Topology::of(&mesh);
            assert_eq!(mesh.triangles.len(), 20 * (frequency * frequency) as usize);
            assert_eq!(mesh.positions.len(), 10 * (frequency * frequency) as usize + 2);
            assert_eq!(topology.euler(), 2);
            assert!(topology.is_closed() && topology.is_oriented);
        }
    }

    #[test]
    fn lies_on_the_unit_sphere_and_encloses_its_volume() {
        let mesh = sphere(40);
        for position in &mesh.positions {
            let radius = length(position.map(f64::from));
            assert!((radius - 1.0).abs() < 1e-7, "radius {radius}");
        }
        let ball = 4.0 / 3.0 * std::f64::consts::PI;
        let volume = Topology::volume(&mesh);
        assert!(volume < ball && volume > 0.998 * ball, "{volume} of {ball}");
    }

    #[test]
    fn frequency_comes_nearest_to_the_count() {
        assert_eq!(sphere_frequency(0), 1);
        assert_eq!(sphere_frequency(20), 1);
        assert_eq!(sphere_frequency(49), 1);
        assert_eq!(sphere_frequency(51), 2);
        assert_eq!(sphere_frequency(50_000), 50);
        assert_eq!(sphere_frequency(u32::MAX), MAX_FREQUENCY);
    }
}
