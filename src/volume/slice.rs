//! The section of a volume with a plane.
//!
//! Every tetrahedron with vertices on both sides gives a triangle or a quadrilateral, whose corners
//! lie on its edges. The two ends of the edge are the name of a corner, so that neighbours share
//! it. A vertex on the plane counts as an edge of length 0.

use crate::geometry::vector::{cross, dot, length, sub};
use nephrite_formats::{Attribute, TetrahedronMesh, TriangleMesh};
use std::collections::HashMap;

/// The points `x` with `normal x = offset`, in file coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Of any length but 0.
    pub normal: [f64; 3],
    /// In units of the normal's length.
    pub offset: f64,
}

/// Where a volume meets a plane: triangles that face along the normal of the plane, with
/// interpolated fields. A tetrahedron that only touches the plane gives nothing, so a plane along
/// faces gives one side. Empty for a normal of length 0. O(n).
pub(crate) fn slice(volume: &TetrahedronMesh, plane: &Plane) -> TriangleMesh {
    let Plane { normal, offset } = *plane;
    let offset = offset - dot(normal, volume.origin);
    let heights: Vec<f64> = volume.positions.iter().map(|p| dot(normal, p.map(f64::from)) - offset).collect();
    let mut section =
        Section { volume, heights, corners: HashMap::new(), edges: Vec::new(), triangles: Vec::new() };
    if length(normal) > 0.0 {
        volume.tetrahedra.iter().for_each(|&tetrahedron| section.cut(tetrahedron, normal));
    }
    section.into_mesh()
}

struct Section<'a> {
    volume: &'a TetrahedronMesh,
    /// Signed distance of each vertex, in units of the normal's length.
    heights: Vec<f64>,
    corners: HashMap<[u32; 2], u32>,
    edges: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
}

impl Section<'_> {
    fn cut(&mut self, tetrahedron: [u32; 4], normal: [f64; 3]) {
        let is_above = tetrahedron.map(|v| self.heights[v as usize] >= 0.0);
        let side = |wanted: bool| {
            let mut vertices = [0; 4];
            let mut n = 0;
            for (&v, &above) in tetrahedron.iter().zip(&is_above) {
                if above == wanted {
                    vertices[n] = v;
                    n += 1;
                }
            }
            (vertices, n)
        };
        let ((above, n_above), (below, _)) = (side(true), side(false));
        let corners = match n_above {
            1 => [below[0], below[1], below[2]].map(|v| self.corner(above[0], v)).to_vec(),
            3 => [above[0], above[1], above[2]].map(|v| self.corner(v, below[0])).to_vec(),
            2 => {
                let [a, b, c, d] = [above[0], above[1], below[0], below[1]];
                [[a, c], [a, d], [b, d], [b, c]].map(|[p, q]| self.corner(p, q)).to_vec()
            }
            _ => return,
        };
        for i in 1..corners.len() - 1 {
            let [a, b, c] = [corners[0], corners[i], corners[i + 1]];
            if a == b || b == c || c == a {
                continue;
            }
            let [p, q, r] = [a, b, c].map(|corner| self.point(self.edges[corner as usize]));
            let faces = dot(cross(sub(q, p), sub(r, p)), normal);
            self.triangles.push(if faces >= 0.0 { [a, b, c] } else { [a, c, b] });
        }
    }

    /// The corner on the edge from a vertex on the plane or above it to one below.
    fn corner(&mut self, above: u32, below: u32) -> u32 {
        let edge = if self.heights[above as usize] == 0.0 { [above, above] } else { [above, below] };
        let next = u32::try_from(self.edges.len()).unwrap_or(u32::MAX);
        let corner = *self.corners.entry(edge).or_insert(next);
        if corner == next {
            self.edges.push(edge);
        }
        corner
    }

    /// How far along an edge the plane is.
    fn part(&self, [above, below]: [u32; 2]) -> f64 {
        let (high, low) = (self.heights[above as usize], self.heights[below as usize]);
        if above == below { 0.0 } else { high / (high - low) }
    }

    fn point(&self, edge: [u32; 2]) -> [f64; 3] {
        let [p, q] = edge.map(|v| self.volume.positions[v as usize].map(f64::from));
        let part = self.part(edge);
        std::array::from_fn(|axis| p[axis] + part * (q[axis] - p[axis]))
    }

    fn into_mesh(self) -> TriangleMesh {
        #[expect(clippy::cast_possible_truncation, reason = "positions are kept in f32")]
        let positions = self.edges.iter().map(|&edge| self.point(edge).map(|x| x as f32)).collect();
        let attributes = self.volume.attributes.iter().map(|attribute| {
            let n = attribute.n_components as usize;
            let values: Vec<f64> = attribute.values().collect();
            let interpolated = self.edges.iter().flat_map(|&edge| {
                let [p, q] = edge.map(|v| &values[v as usize * n..][..n]);
                let part = self.part(edge);
                p.iter().zip(q).map(move |(p, q)| p + part * (q - p)).collect::<Vec<_>>()
            });
            Attribute::from_values(&*attribute.name, attribute.scalar, attribute.n_components, interpolated)
        });
        TriangleMesh {
            origin: self.volume.origin,
            positions,
            attributes: attributes.collect(),
            triangles: self.triangles,
            rounding: self.volume.rounding,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::box_volume;

    #[test]
    fn a_box_is_cut_in_rectangles_that_face_the_normal() {
        let volume = box_volume([3, 4, 5]);
        // Through the inside of cells, and through vertices.
        for (normal, offset, area) in [
            ([0.0, 0.0, 1.0], 0.45, 1.0),
            ([0.0, 0.0, -2.0], -0.8, 1.0),
            ([1.0, 1.0, 0.0], 1.0, 2.0_f64.sqrt()),
            ([1.0, 0.0, 0.0], 7.0, 0.0),
            ([0.0; 3], 0.0, 0.0),
        ] {
            let section = slice(&volume, &Plane { normal, offset });
            let areas = section.triangles.iter().map(|triangle| {
                let [p, q, r] = triangle.map(|v| section.positions[v as usize].map(f64::from));
                dot(cross(sub(q, p), sub(r, p)), normal) / length(normal) / 2.0
            });
            let areas: Vec<f64> = areas.collect();
            assert!(areas.iter().all(|&area| area >= 0.0));
            assert!((areas.iter().sum::<f64>() - area).abs() < 1e-6, "{normal:?}: {areas:?}");
        }
    }
}
