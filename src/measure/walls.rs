//! Triangles of a closed surface that lie on others of it the other way round.
//!
//! Where a mesh is refined on one side of a face and not on the other, nodes hang: the faces on
//! both sides have different corners, and each belongs to one tetrahedron only. The boundary then
//! has a wall inside, of two sheets at no distance.

use super::bvh::{self, Child, LANES, Node};
use crate::geometry::distance::{Triangle, point_triangle_distance_sq};
use crate::geometry::vector::{Vector, add, cross, dot, length, scale, sub};
use rayon::prelude::*;

/// Largest distance between the sheets of a wall, in parts of the largest coordinate: rounding.
const TOLERANCE: f64 = 4.0 * f32::EPSILON as f64;

/// Largest cosine between the normals of faces that look at each other.
const MAX_COSINE: f64 = -0.999;

/// Nodes of the hierarchy that are looked at for one triangle. In a mesh that fits, some 30 are.
const MAX_NODES: usize = 1024;

/// The triangles of a surface that lie on others the other way round.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct InnerWalls {
    /// How many.
    pub n_faces: usize,
    /// Their area, both sheets.
    pub area: f64,
}

/// Finds inner walls in the boundary of a volume; `apexes` has the fourth corner of the tetrahedron
/// at each triangle. A triangle counts whole if its centroid is on another one that looks the other
/// way. Faces of tetrahedra as flat as the tolerance do not count: the two sides of a sheet are not
/// a wall. O(n log n).
pub(crate) fn inner_walls(surface: &[Triangle], apexes: &[Vector]) -> InnerWalls {
    if surface.is_empty() {
        return InnerWalls::default();
    }
    let (nodes, order) = bvh::build(surface);
    let largest = surface.iter().flatten().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let tolerance = TOLERANCE * largest;
    let tolerance_sq = tolerance * tolerance;
    let faces: Vec<Face> = surface.iter().zip(apexes).map(|(face, &apex)| Face::new(face, apex)).collect();
    let is_thick = |face: &Face| face.height > 4.0 * tolerance;
    let is_in_wall = |face: &Face| {
        is_near(&nodes, face.centroid, tolerance_sq, |at| {
            let other = order[at as usize] as usize;
            dot(face.normal, faces[other].normal) < MAX_COSINE
                && is_thick(&faces[other])
                && point_triangle_distance_sq(face.centroid, &surface[other]) <= tolerance_sq
        })
    };
    let areas: Vec<f64> =
        faces.par_iter().filter(|face| is_thick(face) && is_in_wall(face)).map(|face| face.area).collect();
    InnerWalls { n_faces: areas.len(), area: areas.iter().fold(0.0, |sum, area| sum + area) }
}

struct Face {
    centroid: Vector,
    /// Of length 1; 0 for a triangle without area.
    normal: Vector,
    area: f64,
    /// Of the tetrahedron over it.
    height: f64,
}

impl Face {
    fn new(&[a, b, c]: &Triangle, apex: Vector) -> Self {
        let normal = cross(sub(b, a), sub(c, a));
        let twice_area = length(normal);
        let unit = if twice_area > 0.0 { 1.0 / twice_area } else { 0.0 };
        let normal = scale(normal, unit);
        Self {
            centroid: scale(add(add(a, b), c), 1.0 / 3.0),
            normal,
            area: 0.5 * twice_area,
            height: dot(normal, sub(a, apex)).abs(),
        }
    }
}

/// Whether `is_meant` holds for a triangle whose box is near to a point, among the first
/// [`MAX_NODES`] that are visited.
fn is_near(nodes: &[Node], point: Vector, tolerance_sq: f64, is_meant: impl Fn(u32) -> bool) -> bool {
    let mut stack = vec![0];
    let mut n_nodes = 0;
    while let Some(node) = stack.pop() {
        n_nodes += 1;
        if n_nodes > MAX_NODES {
            return false;
        }
        let node = &nodes[node as usize];
        let distances_sq = node.point_distances_sq(point);
        for lane in (0..LANES).filter(|&lane| distances_sq[lane] <= tolerance_sq) {
            match node.child(lane) {
                Child::Node(child) => stack.push(child),
                Child::Leaf { first, n_triangles } => {
                    if (first..first + n_triangles).any(&is_meant) {
                        return true;
                    }
                }
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{ball_volume, box_volume};
    use crate::geometry::vector::widen;
    use crate::mesh::boundary_faces;
    use nephrite_formats::TetrahedronMesh;

    fn walls(volume: &TetrahedronMesh) -> InnerWalls {
        let place = |t: usize, i: usize| widen(volume.positions[volume.tetrahedra[t][i] as usize]);
        let faces = boundary_faces(&volume.tetrahedra, volume.positions.len());
        let faces: Vec<(Triangle, Vector)> = faces
            .map(|(t, face)| (face.map(|i| place(t, i)), place(t, 6 - face.iter().sum::<usize>())))
            .collect();
        let (surface, apexes): (Vec<_>, Vec<_>) = faces.into_iter().unzip();
        inner_walls(&surface, &apexes)
    }

    #[test]
    fn hanging_nodes_make_a_wall_of_twice_the_area_between() {
        // The two sides of a sheet are not a wall.
        let mut sheet = box_volume([4, 4, 1]);
        sheet.positions.iter_mut().for_each(|p| p[2] *= 1e-8);
        assert_eq!(walls(&sheet), InnerWalls::default());
        // A coarse box beside a fine one.
        let [mut mesh, fine] = [[2; 3], [4; 3]].map(box_volume);
        assert_eq!([&mesh, &fine, &ball_volume(6)].map(walls), [InnerWalls::default(); 3]);
        let n_vertices = u32::try_from(mesh.positions.len()).unwrap();
        mesh.attributes.clear();
        mesh.positions.extend(fine.positions.iter().map(|&[x, y, z]| [x + 1.0, y, z]));
        mesh.tetrahedra.extend(fine.tetrahedra.iter().map(|t| t.map(|v| v + n_vertices)));
        let found = walls(&mesh);
        assert_eq!(found.n_faces, 2 * 4 + 2 * 16);
        assert!((found.area - 2.0).abs() < 1e-9);
    }

    #[test]
    fn very_many_sheets_in_one_place_are_given_up() {
        let sheet = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let found = inner_walls(&vec![sheet; 20_000], &vec![[0.0, 0.0, 1.0]; 20_000]);
        assert_eq!(found.n_faces, 0);
    }
}
