//! A normal for every vertex of a file.

use glam::Vec3;
use nephrite::{Lod, ScalarType};

/// Normals for the vertex buffer, in the order of [`Lod::vertices`]: 16 bits per component, the
/// fourth unused.
///
/// They are the attribute `normal` of the file if it has one, otherwise the mean over the triangles
/// around a vertex at the first level that has it, weighted by area. Coarser levels keep the
/// normals of the finest level, and with them its shading. Cost: one pass over level 0 and over the
/// triangles around vertices that are born later.
pub(crate) fn vertex_normals(lod: &Lod) -> Vec<[i16; 4]> {
    let normals = stated(lod).unwrap_or_else(|| mean_of_triangles(lod));
    normals.into_iter().map(quantized).collect()
}

fn stated(lod: &Lod) -> Option<Vec<Vec3>> {
    let attribute = lod
        .attributes()
        .find(|view| view.name == "normal" && view.scalar == ScalarType::F32 && view.n_components == 3)?;
    let (components, _) = attribute.bytes.as_chunks::<4>();
    let (normals, _) = components.as_chunks::<3>();
    // A damaged file may have too few.
    (normals.len() == lod.vertices().len())
        .then(|| normals.iter().map(|normal| Vec3::from_array(normal.map(f32::from_le_bytes))).collect())
}

fn mean_of_triangles(lod: &Lod) -> Vec<Vec3> {
    let births = lod.vertex_births();
    let mut sums = vec![Vec3::ZERO; lod.vertices().len()];
    for run in lod.at_level(0).runs() {
        add(lod, &lod.indices()[run.index_range(3)], 0, &mut sums);
    }
    let last_birth = births.iter().copied().max().unwrap_or(0).min(lod.n_levels() - 1);
    for level in 1..=last_birth {
        // All triangles around a vertex that is born here are born here too.
        for run in lod.delta(level - 1, level).entering() {
            add(lod, &lod.indices()[run.index_range(3)], level, &mut sums);
        }
    }
    sums
}

/// Adds the normals of triangles, weighted by area, to those of their vertices that are born at
/// `level`.
fn add(lod: &Lod, indices: &[u32], level: u32, sums: &mut [Vec3]) {
    let births = lod.vertex_births();
    let position = |vertex: u32| lod.vertices().get(vertex as usize).copied().map(Vec3::from_array);
    for &corners in indices.as_chunks::<3>().0 {
        let [Some(a), Some(b), Some(c)] = corners.map(position) else { continue };
        let normal = (b - a).cross(c - a);
        for vertex in corners {
            if births.get(vertex as usize).is_none_or(|&birth| birth == level) {
                sums[vertex as usize] += normal;
            }
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "components of a unit vector, scaled to 16 bits")]
fn quantized(normal: Vec3) -> [i16; 4] {
    let [x, y, z] = normal.normalize_or(Vec3::Y).to_array().map(|x| (x * f32::from(i16::MAX)).round() as i16);
    [x, y, z, 0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nephrite::NEVER;
    use nephrite::{History, TriangleMesh};

    #[test]
    fn normals_of_a_sphere_point_outwards() {
        let lod = crate::builtin::lod_of(&nephrite::generate::sphere(12)).unwrap();
        let normals = vertex_normals(&lod);
        assert_eq!(normals.len(), lod.vertices().len());
        for (position, [x, y, z, _]) in lod.vertices().iter().zip(normals) {
            let normal = Vec3::new(f32::from(x), f32::from(y), f32::from(z)) / f32::from(i16::MAX);
            assert!(normal.dot(Vec3::from_array(*position).normalize()) > 0.99);
        }
    }

    #[test]
    fn a_vertex_that_is_born_later_has_the_normal_of_its_first_triangles() {
        let mesh = TriangleMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            ..TriangleMesh::default()
        };
        // Two triangles that face along the third axis are replaced by one that faces down the
        // second.
        let history = History {
            simplices: vec![[0, 1, 2], [1, 3, 2], [0, 1, 4]],
            birth: vec![0, 0, 1],
            death: vec![1, 1, NEVER],
            vertex_birth: vec![0, 0, 0, 0, 1],
            vertex_death: vec![NEVER, NEVER, 1, 1, NEVER],
            errors: vec![0.0, 1.0],
            ..History::default()
        };
        let lod = crate::builtin::stored(|file, options| history.write_to(file, &mesh, options)).unwrap();
        assert_eq!((lod.n_levels(), lod.vertices().len()), (2, 5));
        for (position, normal) in lod.vertices().iter().zip(vertex_normals(&lod)) {
            let expected = if position[2] > 0.0 { [0, -i16::MAX, 0, 0] } else { [0, 0, i16::MAX, 0] };
            assert_eq!(normal, expected, "at {position:?}");
        }
    }

    #[test]
    fn lengths_that_are_no_numbers_get_some_normal() {
        assert_eq!(quantized(Vec3::ZERO), [0, i16::MAX, 0, 0]);
        assert_eq!(quantized(Vec3::NAN), [0, i16::MAX, 0, 0]);
        assert_eq!(quantized(Vec3::new(0.0, 0.0, -3.0)), [0, 0, -i16::MAX, 0]);
    }
}
