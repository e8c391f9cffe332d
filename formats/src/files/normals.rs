//! Normals of vertices for which a file gives none.

use std::collections::HashMap;

use crate::files::coordinates::nearest_f32;

/// What a report says of normals that were filled in.
pub(crate) const COMPUTED: &str = "computed from the triangles";

/// Unit normals of all vertices: the sum of the normals of the triangles at a vertex's position,
/// each weighted by its area. `[0, 0, 1]` if no triangle has an area.
///
/// Vertices at exactly one position get one normal, so that a seam of other attributes is not seen.
/// Expected linear time.
pub(crate) fn smooth(points: &[[f64; 3]], triangles: impl IntoIterator<Item = [u32; 3]>) -> Vec<[f32; 3]> {
    let mut first_at: HashMap<[u64; 3], usize> = HashMap::with_capacity(points.len());
    let places: Vec<usize> = points
        .iter()
        .enumerate()
        .map(|(i, point)| *first_at.entry(point.map(|value| (value + 0.0).to_bits())).or_insert(i))
        .collect();
    let mut sums = vec![[0.0_f64; 3]; points.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| points[corner as usize]);
        let [u, v]: [[f64; 3]; 2] = [b, c].map(|end| std::array::from_fn(|axis| end[axis] - a[axis]));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        for corner in triangle {
            let sum = &mut sums[places[corner as usize]];
            (0..3).for_each(|axis| sum[axis] += normal[axis]);
        }
    }
    let unit = |sum: [f64; 3]| {
        // Divided by the largest first: squares of small numbers would be zero.
        let largest = sum.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        if !(largest > 0.0 && largest.is_finite()) {
            return [0.0, 0.0, 1.0];
        }
        let sum = sum.map(|value| value / largest);
        let length = sum.iter().map(|value| value * value).sum::<f64>().sqrt();
        sum.map(|value| nearest_f32(value / length))
    };
    places.iter().map(|&place| unit(sums[place])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_triangles_count_more_and_seams_do_not() {
        let points = [
            [0.0; 3],
            [2.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0; 3],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [9.0; 3],
        ];
        let normals = smooth(&points, [[0, 1, 2], [3, 4, 5]]);
        let length = 17.0_f32.sqrt();
        assert_eq!(normals[0], normals[3]);
        for (found, expected) in normals[0].into_iter().zip([1.0 / length, 0.0, 4.0 / length]) {
            assert!((found - expected).abs() < 1e-6);
        }
        assert_eq!((normals[1], normals[5], normals[6]), ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    }
}
