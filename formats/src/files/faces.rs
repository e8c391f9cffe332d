//! Faces as a file lists them, made into triangles once the positions are known.

use crate::FileReport;
use crate::files::polygon::Triangulator;

/// Faces in file order. Triangles are stored as such; polygons beside them, with their place in the
/// order.
#[derive(Default)]
pub(crate) struct Faces {
    triangles: Vec<[u32; 3]>,
    polygons: Vec<Polygon>,
    polygon_corners: Vec<u32>,
    n_dropped: usize,
}

/// A face of four corners or more.
struct Polygon {
    /// Triangles of the list that come before it in the file.
    n_triangles_before: usize,
    /// End of its corners in the list of all polygons' corners; they begin where the previous
    /// polygon's end.
    corners_end: usize,
}

impl Faces {
    /// Makes room for `n_faces` more triangles.
    pub(crate) fn reserve(&mut self, n_faces: usize) {
        self.triangles.reserve(n_faces);
    }

    /// Appends a triangle.
    pub(crate) fn push_triangle(&mut self, triangle: [u32; 3]) {
        self.triangles.push(triangle);
    }

    /// Appends a face of any number of corners; fewer than three are counted and dropped.
    pub(crate) fn push(&mut self, corners: &[u32]) {
        match *corners {
            [] | [_] | [_, _] => self.n_dropped += 1,
            [a, b, c] => self.triangles.push([a, b, c]),
            _ => {
                self.polygon_corners.extend_from_slice(corners);
                let corners_end = self.polygon_corners.len();
                self.polygons.push(Polygon { n_triangles_before: self.triangles.len(), corners_end });
            }
        }
    }

    /// Appends the triangles of a strip: every three corners in a row, each second triangle turned
    /// over. Triangles with a repeated corner join strips and are left out.
    pub(crate) fn push_strip(&mut self, strip: &[u32]) {
        if strip.len() < 3 {
            self.n_dropped += usize::from(!strip.is_empty());
        }
        for (i, corners) in strip.windows(3).enumerate() {
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            if a != b && b != c && a != c {
                self.triangles.push(if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
            }
        }
    }

    /// Triangles for normals: polygons as fans about their first corner, whatever their shape.
    pub(crate) fn fans(&self) -> impl Iterator<Item = [u32; 3]> {
        let starts = std::iter::once(0).chain(self.polygons.iter().map(|polygon| polygon.corners_end));
        let ends = self.polygons.iter().map(|polygon| polygon.corners_end);
        let fan = |(start, end): (usize, usize)| {
            let corners = &self.polygon_corners[start..end];
            corners.windows(2).skip(1).map(|edge| [corners[0], edge[0], edge[1]])
        };
        self.triangles.iter().copied().chain(starts.zip(ends).flat_map(fan))
    }

    /// The corners of all faces, in two lists.
    pub(crate) fn corners_mut(&mut self) -> [&mut [u32]; 2] {
        [self.triangles.as_flattened_mut(), &mut self.polygon_corners]
    }

    /// All faces as triangles in file order, polygons cut; every index must be below
    /// `positions.len()`. Counts go to `report`.
    pub(crate) fn into_triangles(self, positions: &[[f32; 3]], report: &mut FileReport) -> Vec<[u32; 3]> {
        report.n_faces_dropped += self.n_dropped;
        report.n_polygons_triangulated += self.polygons.len();
        if self.polygons.is_empty() {
            return self.triangles;
        }
        let n_cut = self.polygon_corners.len() - 2 * self.polygons.len();
        let mut triangles = Vec::with_capacity(self.triangles.len() + n_cut);
        let mut triangulator = Triangulator::default();
        let (mut corner_positions, mut cut) = (Vec::new(), Vec::new());
        let (mut n_triangles, mut corners_start) = (0, 0);
        for polygon in &self.polygons {
            triangles.extend_from_slice(&self.triangles[n_triangles..polygon.n_triangles_before]);
            n_triangles = polygon.n_triangles_before;
            let corners = &self.polygon_corners[corners_start..polygon.corners_end];
            corners_start = polygon.corners_end;
            corner_positions.clear();
            corner_positions.extend(corners.iter().map(|&corner| positions[corner as usize]));
            cut.clear();
            let is_tiled = triangulator.triangulate(&corner_positions, &mut cut);
            report.n_polygons_folded += usize::from(!is_tiled);
            triangles.extend(cut.iter().map(|triangle| triangle.map(|corner| corners[corner])));
        }
        triangles.extend_from_slice(&self.triangles[n_triangles..]);
        triangles
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MeshFormat;

    #[test]
    fn file_order_is_kept() {
        let mut faces = Faces::default();
        faces.push(&[0, 1, 2]);
        faces.push(&[0, 1, 2, 3]);
        faces.push(&[3, 1]);
        faces.push_triangle([2, 1, 0]);
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mut report = FileReport::new(MeshFormat::Ply);
        let triangles = faces.into_triangles(&positions, &mut report);
        assert_eq!(triangles, [[0, 1, 2], [0, 1, 2], [0, 2, 3], [2, 1, 0]]);
        assert_eq!((report.n_polygons_triangulated, report.n_faces_dropped), (1, 1));
    }
}
