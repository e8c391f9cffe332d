//! Barycentric coordinates in a tetrahedron.

use super::vector::{Vector, cross, dot, sub};

/// Barycentric coordinates of a point in a tetrahedron; `None` for one without volume.
pub fn barycentric(point: Vector, [a, b, c, d]: [Vector; 4]) -> Option<[f64; 4]> {
    let (b, c, d, p) = (sub(b, a), sub(c, a), sub(d, a), sub(point, a));
    let volume = dot(b, cross(c, d));
    if volume == 0.0 {
        return None;
    }
    let [u, v, w] = [dot(p, cross(c, d)), dot(p, cross(d, b)), dot(p, cross(b, c))].map(|part| part / volume);
    Some([1.0 - u - v - w, u, v, w])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_weigh_the_corners() {
        let corners = [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 4.0, 0.0], [1.0, 0.0, 8.0]];
        assert_eq!(barycentric([2.0, 1.0, 1.0], corners), Some([0.125, 0.5, 0.25, 0.125]));
        assert_eq!(barycentric(corners[2], corners), Some([0.0, 0.0, 1.0, 0.0]));
        assert_eq!(barycentric([0.0; 3], [corners[0], corners[1], corners[2], [7.0, 9.0, 0.0]]), None);
    }
}
