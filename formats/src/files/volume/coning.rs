//! Solids of flat quadrilaterals and triangles, cut into tetrahedra that fit those of their
//! neighbours.
//!
//! Cutting each hexahedron by a fixed pattern leaves neighbours with crossing diagonals on the face
//! they share. Here every solid is the cone from its least corner over the faces that do not touch
//! it, and every quadrilateral is cut through its own least corner. Both neighbours of a face know
//! its corners and so cut it alike. The order of the corners comes from their places, so that this
//! holds for neighbours with vertices of their own as well.
//!
//! Reference: J. Dompierre, P. Labbe, M.-G. Vallet, R. Camarero: "How to subdivide pyramids, prisms
//! and hexahedra into tetrahedra" (International Meshing Roundtable, 1999).

/// Faces of a hexahedron with the vertex order of VTK, seen from outside counter-clockwise.
pub(super) const HEXAHEDRON: [&[usize]; 6] =
    [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
/// Faces of a voxel: a hexahedron whose vertices count x first, then y, then z.
pub(super) const VOXEL: [&[usize]; 6] =
    [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[1, 3, 7, 5], &[3, 2, 6, 7], &[2, 0, 4, 6]];
/// Faces of a prism over the triangle 0 1 2, which is seen counter-clockwise from outside.
pub(super) const PRISM: [&[usize]; 5] = [&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]];
/// Faces of a prism over the triangle 0 1 2, which is seen counter-clockwise from inside.
pub(super) const UPRIGHT_PRISM: [&[usize]; 5] =
    [&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
/// Faces of a pyramid over the quadrilateral 0 1 2 3 with the apex 4.
pub(super) const PYRAMID: [&[usize]; 5] = [&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]];

/// Cuts a solid with the given faces and `n_corners` corners, and hands out its tetrahedra by
/// corner.
///
/// `rank` orders the corners, equal for corners at one place. The least one is the apex.
pub(super) fn cone(
    faces: &[&[usize]],
    n_corners: usize,
    rank: impl Fn(usize) -> u32,
    mut tetrahedron: impl FnMut([usize; 4]),
) {
    let Some(apex) = (0..n_corners).min_by_key(|&corner| rank(corner)) else { return };
    for face in faces {
        let corner = |i: usize| face[i % face.len()];
        if face.iter().any(|&corner| rank(corner) == rank(apex)) {
            continue;
        }
        let least = (0..face.len()).min_by_key(|&i| rank(corner(i))).unwrap_or(0);
        for i in 1..face.len() - 1 {
            // The face is seen from outside, the apex from inside.
            tetrahedron([corner(least), corner(least + i + 1), corner(least + i), apex]);
        }
    }
}

#[cfg(test)]
#[allow(clippy::cast_possible_truncation, reason = "small solids")]
mod tests {
    use super::*;
    use crate::TetrahedronMesh;

    const CUBE: [[f32; 3]; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];

    /// The solid whose corner `i` is vertex `names[i]`, at the place of corner `i`.
    fn coned(faces: &[&[usize]], corners: &[[f32; 3]], names: &[u32]) -> TetrahedronMesh {
        let mut mesh = TetrahedronMesh { positions: vec![[0.0; 3]; corners.len()], ..Default::default() };
        for (&name, &corner) in names.iter().zip(corners) {
            mesh.positions[name as usize] = corner;
        }
        let named = |t: [usize; 4]| mesh.tetrahedra.push(t.map(|corner| names[corner]));
        cone(faces, names.len(), |corner| names[corner], named);
        mesh
    }

    fn check(faces: &[&[usize]], corners: &[[f32; 3]], n_tetrahedra: usize, volume: f64) {
        let n = corners.len();
        // Every vertex is the least one once.
        for turn in 0..n {
            let names: Vec<u32> = (0..n).map(|i| ((i + turn) % n) as u32).collect();
            let mesh = coned(faces, corners, &names);
            assert_eq!(mesh.tetrahedra.len(), n_tetrahedra);
            assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0), "{names:?}");
            assert!((mesh.volume() - volume).abs() < 1e-12);
        }
    }

    #[test]
    fn every_solid_is_filled_whatever_the_order_of_its_vertices() {
        check(&HEXAHEDRON, &CUBE, 6, 1.0);
        let voxel = [0, 1, 3, 2, 4, 5, 7, 6].map(|i: usize| CUBE[i]);
        check(&VOXEL, &voxel, 6, 1.0);
        let prism = [0, 2, 1, 4, 6, 5].map(|i: usize| CUBE[i]);
        check(&PRISM, &prism, 3, 0.5);
        let upright = [0, 1, 2, 4, 5, 6].map(|i: usize| CUBE[i]);
        check(&UPRIGHT_PRISM, &upright, 3, 0.5);
        let pyramid = [CUBE[0], CUBE[1], CUBE[2], CUBE[3], [0.5, 0.5, 1.0]];
        check(&PYRAMID, &pyramid, 2, 1.0 / 3.0);
    }
}
