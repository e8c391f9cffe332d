//! Cells of any kind on their way to tetrahedra.

use std::collections::HashMap;

use super::coning::{HEXAHEDRON, PRISM, PYRAMID, UPRIGHT_PRISM, VOXEL, cone};
use crate::FileReport;
use crate::files::error::{MeshError, Place};

/// What a cell is, whatever the format calls it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CellKind {
    /// Without a volume.
    Flat,
    Tetrahedron,
    Hexahedron,
    Voxel,
    Prism,
    Pyramid,
}

impl CellKind {
    /// Number of corners. They stand before all other nodes of a cell.
    pub(super) fn n_corners(self) -> usize {
        match self {
            Self::Flat => 0,
            Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Prism => 6,
            Self::Hexahedron | Self::Voxel => 8,
        }
    }
}

/// Cells with a volume, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Cells {
    kinds: Vec<CellKind>,
    /// Corners of all cells, one cell after the other.
    corners: Vec<u32>,
}

impl Cells {
    /// Adds a cell by its nodes, corners first. Counts flat cells, and solids that will be cut;
    /// leaves out nodes behind the corners.
    ///
    /// # Errors
    ///
    /// [`MeshError::IndexOutOfRange`] or [`MeshError::Missing`] at `place`.
    pub(super) fn push(
        &mut self,
        kind: CellKind,
        nodes: &[u32],
        n_points: usize,
        place: Place,
        report: &mut FileReport,
    ) -> Result<(), MeshError> {
        if kind == CellKind::Flat {
            report.n_cells_ignored += 1;
            return Ok(());
        }
        let corners = nodes.get(..kind.n_corners()).ok_or(MeshError::Missing { place, what: "corner" })?;
        if let Some(&index) = corners.iter().find(|&&index| index as usize >= n_points) {
            let (index, count) = (i64::from(index), n_points as u64);
            return Err(MeshError::IndexOutOfRange { place, what: "vertex", index, count });
        }
        report.n_cells_straightened += usize::from(nodes.len() > corners.len());
        report.n_solids_cut += usize::from(kind != CellKind::Tetrahedron);
        self.kinds.push(kind);
        self.corners.extend_from_slice(corners);
        Ok(())
    }

    /// Adds the cells of a later piece, whose vertices are numbered from `first` on in the whole.
    pub(super) fn append(&mut self, later: Self, first: u32) {
        self.kinds.extend(later.kinds);
        self.corners.extend(later.corners.into_iter().map(|corner| first + corner));
    }

    /// Number of cells with a volume.
    pub(super) fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Corners of all cells.
    pub(super) fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// Gives every corner the new number of its vertex.
    pub(super) fn renumber(&mut self, new_numbers: &[u32]) {
        self.corners.iter_mut().for_each(|corner| *corner = new_numbers[*corner as usize]);
    }

    /// The tetrahedra, in the order of their cells. Two solids with a face at the same place cut it
    /// alike, also if each has vertices of its own there.
    pub(super) fn into_tetrahedra(self, positions: &[[f32; 3]]) -> Vec<[u32; 4]> {
        if self.kinds.iter().all(|&kind| kind == CellKind::Tetrahedron) {
            return self.corners.as_chunks::<4>().0.to_vec();
        }
        let representatives = representatives(positions);
        let mut tetrahedra = Vec::with_capacity(self.kinds.len());
        let mut rest = self.corners.as_slice();
        for kind in self.kinds {
            let (corners, later) = rest.split_at(kind.n_corners());
            rest = later;
            let faces: &[&[usize]] = match kind {
                CellKind::Hexahedron => &HEXAHEDRON,
                CellKind::Voxel => &VOXEL,
                CellKind::Prism => prism_faces(corners, positions),
                CellKind::Pyramid => &PYRAMID,
                CellKind::Tetrahedron | CellKind::Flat => {
                    tetrahedra.extend(corners.first_chunk::<4>());
                    continue;
                }
            };
            let rank = |corner: usize| representatives[corners[corner] as usize];
            cone(faces, corners.len(), rank, |t| tetrahedra.push(t.map(|corner| corners[corner])));
        }
        tetrahedra
    }
}

/// The faces of a prism. Programs differ in which side they see its triangles from, also those that
/// write one format, so its shape decides.
fn prism_faces(corners: &[u32], positions: &[[f32; 3]]) -> &'static [&'static [usize]] {
    let point = |corner: usize| positions[corners[corner] as usize].map(f64::from);
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let side = |[a, b, c]: [usize; 3], towards: [f64; 3]| {
        let (u, v) = (minus(point(b), point(a)), minus(point(c), point(a)));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        normal[0] * towards[0] + normal[1] * towards[1] + normal[2] * towards[2]
    };
    let edges = [0, 1, 2].map(|corner| minus(point(corner + 3), point(corner)));
    let upwards = [0, 1, 2].map(|axis| edges.iter().map(|edge| edge[axis]).sum());
    if side([0, 1, 2], upwards) + side([3, 4, 5], upwards) > 0.0 { &UPRIGHT_PRISM } else { &PRISM }
}

/// For each vertex the first vertex at its position.
fn representatives(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut first_at = HashMap::with_capacity(positions.len());
    // Adding zero makes one zero of the two.
    let key = |position: &[f32; 3]| position.map(|coordinate| (coordinate + 0.0).to_bits());
    (0..).zip(positions).map(|(vertex, position)| *first_at.entry(key(position)).or_insert(vertex)).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::VolumeFormat;
    use std::collections::BTreeMap;

    /// Counts the faces of one tetrahedron; all others are of two. Faces are told by their places.
    pub(in crate::files::volume) fn n_outer_faces(positions: &[[f32; 3]], tetrahedra: &[[u32; 4]]) -> usize {
        let mut faces: BTreeMap<Vec<[u32; 3]>, usize> = BTreeMap::new();
        for tetrahedron in tetrahedra {
            for left_out in 0..4 {
                let corners = (0..4).filter(|&corner| corner != left_out);
                let mut face: Vec<[u32; 3]> =
                    corners.map(|c| positions[tetrahedron[c] as usize].map(f32::to_bits)).collect();
                face.sort_unstable();
                *faces.entry(face).or_default() += 1;
            }
        }
        assert!(faces.values().all(|&n| n <= 2));
        faces.values().filter(|&&n| n == 1).count()
    }

    /// A block of unit cubes, each with 8 vertices of its own, whose corners are numbered from
    /// another one in each cube.
    fn cubes_apart(n: u32) -> (Vec<[f32; 3]>, Cells) {
        let mut report = FileReport::new(VolumeFormat::Vtk);
        let (mut positions, mut cells) = (Vec::new(), Cells::default());
        for cube in 0..n * n * n {
            let low = [cube % n, cube / n % n, cube / n / n];
            let start = 8 * cube;
            let turned = |corner: u32| start + (corner + cube) % 8;
            let mut at = vec![[0.0; 3]; 8];
            for corner in 0..8_u32 {
                let offset = [(corner + 1) >> 1 & 1, corner >> 1 & 1, corner >> 2];
                #[expect(clippy::cast_precision_loss, reason = "small coordinates")]
                let place = [0, 1, 2].map(|axis| (low[axis] + offset[axis]) as f32);
                at[(turned(corner) - start) as usize] = place;
            }
            positions.extend(at);
            let nodes: Vec<u32> = (0..8).map(turned).collect();
            cells.push(CellKind::Hexahedron, &nodes, positions.len(), Place::File, &mut report).unwrap();
        }
        (positions, cells)
    }

    #[test]
    fn prisms_are_filled_whichever_side_their_triangles_are_seen_from() {
        let positions: Vec<[f32; 3]> = vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [0.0, 1.0, 1.0],
        ];
        for nodes in [[0, 1, 2, 3, 4, 5], [0, 2, 1, 3, 5, 4], [4, 3, 5, 1, 0, 2]] {
            let mut report = FileReport::new(VolumeFormat::Vtk);
            let mut cells = Cells::default();
            cells.push(CellKind::Prism, &nodes, 6, Place::File, &mut report).unwrap();
            let tetrahedra = cells.into_tetrahedra(&positions);
            let mesh =
                crate::TetrahedronMesh { positions: positions.clone(), tetrahedra, ..Default::default() };
            assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0), "{nodes:?}");
            assert!((mesh.volume() - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn hexahedra_with_vertices_of_their_own_cut_common_faces_alike() {
        let n = 4;
        let (positions, cells) = cubes_apart(n);
        let tetrahedra = cells.into_tetrahedra(&positions);
        assert_eq!(tetrahedra.len(), 6 * 64);
        // Two triangles for each square on the outside.
        assert_eq!(n_outer_faces(&positions, &tetrahedra), 2 * 6 * 16);
    }
}
