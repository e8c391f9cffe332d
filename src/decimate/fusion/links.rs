//! Vertices around which the tetrahedra do not fill a ball or half ball.
//!
//! A file need not have tetrahedra that fill space once. The test against flipping is a test of
//! topology only if they do: if the *link* of a vertex, the faces opposite to it, is a sphere, or a
//! disk for a vertex of the boundary.

use crate::flat::{DisjointSets, NO_INDEX};
use crate::mesh::{FACES, Tetrahedra};

/// Vertices whose link is neither a sphere nor a disk, or at a face that does not separate two
/// tetrahedra. `rims` has the edges opposite to each vertex in the faces of the boundary.
/// O(tetrahedra), and O(n log n) at the boundary.
pub(super) fn irregular(mesh: &Tetrahedra, rims: &[Vec<[u32; 2]>]) -> Vec<u32> {
    let mut found = mesh.misfits().as_flattened().to_vec();
    let mut link = vec![];
    let mut met = vec![NO_INDEX; mesh.n_vertices()];
    for (v, rim) in (0..).zip(rims) {
        link.clear();
        for &slot in mesh.slots_at(v) {
            let Some(corners) = mesh.get(slot) else { continue };
            if let Some(at) = corners.iter().position(|&w| w == v) {
                link.push(FACES[at].map(|i| corners[i]));
            }
        }
        let mut n_vertices = 0;
        for &w in link.as_flattened() {
            n_vertices += usize::from(std::mem::replace(&mut met[w as usize], v) != v);
        }
        if !is_simple(n_vertices, link.len(), rim.len()) || (!rim.is_empty() && !is_one_piece(&link)) {
            found.push(v);
        }
    }
    found
}

/// Whether `n_triangles` triangles with `n_vertices` vertices are a sphere, or a disk with `n_rim`
/// edges on its rim, by Euler's formula: vertices - edges + triangles is 2 or 1, and an edge that
/// is not on the rim has two triangles.
pub(super) fn is_simple(n_vertices: usize, n_triangles: usize, n_rim: usize) -> bool {
    let euler = if n_rim == 0 { 2 } else { 1 };
    2 * n_vertices == 2 * euler + n_triangles + n_rim
}

/// Whether the triangles are connected over edges. O(n log n).
fn is_one_piece(triangles: &[[u32; 3]]) -> bool {
    let sides = |(at, &[a, b, c]): (u32, &[u32; 3])| {
        [[a, b], [b, c], [a, c]].map(|[p, q]| ([p.min(q), p.max(q)], at))
    };
    let mut sides: Vec<([u32; 2], u32)> = (0..).zip(triangles).flat_map(sides).collect();
    sides.sort_unstable();
    let mut pieces = DisjointSets::new(triangles.len());
    let mut n_pieces = triangles.len();
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        n_pieces -= usize::from(pieces.join(pair[0].1, pair[1].1));
    }
    n_pieces <= 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn irregular_of(tetrahedra: &[[u32; 4]]) -> Vec<u32> {
        let positions =
            (0..10_u8).map(|i| [f32::from(i), f32::from(i * i % 7), f32::from(i * 3 % 5)]).collect();
        let mesh = Tetrahedra::new(positions, tetrahedra.to_vec());
        let mut rims = vec![vec![]; 10];
        for [a, b, c] in mesh.boundary() {
            [(a, [b, c]), (b, [c, a]), (c, [a, b])]
                .into_iter()
                .for_each(|(v, rim)| rims[v as usize].push(rim));
        }
        let mut found = irregular(&mesh, &rims);
        found.sort_unstable();
        found.dedup();
        // Numbers without a tetrahedron have no link at all.
        found.retain(|v| tetrahedra.as_flattened().contains(v));
        found
    }

    #[test]
    fn links_are_spheres_and_disks_or_irregular() {
        // Four around a vertex: its link is a sphere, those of the others are disks.
        let ball = [[0, 1, 2, 3], [0, 2, 1, 4], [0, 3, 2, 4], [0, 1, 3, 4]];
        assert!(irregular_of(&ball).is_empty());
        // One more that meets them in a vertex, in an edge, or in three vertices inside and none of
        // the faces.
        assert_eq!(irregular_of(&[&ball[..], &[[0, 5, 6, 7]]].concat()), [0]);
        assert_eq!(irregular_of(&[&ball[..], &[[0, 1, 6, 7]]].concat()), [0, 1]);
        // On the other side of a face, and on the same one.
        assert!(irregular_of(&[[0, 1, 2, 3], [0, 2, 1, 4]]).is_empty());
        assert_eq!(irregular_of(&[[0, 1, 2, 3], [0, 1, 2, 4]]), [0, 1, 2]);
        // A third one at a face.
        assert_eq!(irregular_of(&[[0, 1, 2, 3], [0, 2, 1, 4], [0, 1, 2, 5]]), [0, 1, 2]);
    }

    #[test]
    fn a_sphere_and_a_disk_that_share_two_vertices_are_two_pieces() {
        let sphere = [[1, 2, 3], [1, 3, 4], [1, 4, 5], [1, 5, 2], [6, 3, 2], [6, 4, 3], [6, 5, 4], [6, 2, 5]];
        let both = [&sphere[..], &[[1, 6, 7]]].concat();
        assert!(is_simple(7, both.len(), 3) && is_one_piece(&sphere) && !is_one_piece(&both));
    }
}
