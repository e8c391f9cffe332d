//! Affine maps in `f64`: what a node does to its mesh.

use super::document::Node;
use crate::files::error::{MeshError, Place};

/// `x -> linear x + translation`, the linear part by columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Affine {
    pub linear: [[f64; 3]; 3],
    pub translation: [f64; 3],
}

impl Affine {
    pub(crate) const IDENTITY: Self =
        Self { linear: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };

    /// The map of a node itself: its matrix, or scale, then rotation, then translation.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unsupported`] for a matrix that is not affine.
    pub(crate) fn of_node(node: &Node, place: Place) -> Result<Self, MeshError> {
        if let Some([a, b, c, d, e, f, g, h, i, j, k, l, x, y, z, w]) = node.matrix {
            if [d, h, l, w] != [0.0, 0.0, 0.0, 1.0] {
                return Err(MeshError::Unsupported { place, feature: "a projective matrix".into() });
            }
            return Ok(Self { linear: [[a, b, c], [e, f, g], [i, j, k]], translation: [x, y, z] });
        }
        let mut linear = node.rotation.map_or(Self::IDENTITY.linear, rotation);
        if let Some(scale) = node.scale {
            linear = std::array::from_fn(|column| linear[column].map(|value| value * scale[column]));
        }
        Ok(Self { linear, translation: node.translation.unwrap_or_default() })
    }

    /// The map that applies `inner` first.
    pub(crate) fn after(&self, inner: &Self) -> Self {
        Self {
            linear: inner.linear.map(|column| self.turn(column)),
            translation: self.apply(inner.translation),
        }
    }

    /// The image of a point.
    pub(crate) fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(point);
        std::array::from_fn(|axis| turned[axis] + self.translation[axis])
    }

    /// The image of a vector.
    pub(crate) fn turn(&self, vector: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.linear;
        std::array::from_fn(|axis| x[axis] * vector[0] + y[axis] * vector[1] + z[axis] * vector[2])
    }

    /// Six times the signed volume of the image of the unit simplex; negative where the map
    /// mirrors.
    pub(crate) fn determinant(&self) -> f64 {
        let [x, y, z] = self.linear;
        dot(x, cross(y, z))
    }

    /// The map of normals: the inverse transpose, times the size of the determinant so that flat
    /// maps have one too.
    pub(crate) fn of_normals(&self) -> Self {
        let [x, y, z] = self.linear;
        let sign = if self.determinant() < 0.0 { -1.0 } else { 1.0 };
        let linear = [cross(y, z), cross(z, x), cross(x, y)].map(|column| column.map(|value| sign * value));
        Self { linear, translation: [0.0; 3] }
    }

    /// Whether the linear part is the identity.
    pub(crate) fn is_translation(&self) -> bool {
        self.linear == Self::IDENTITY.linear
    }
}

/// The rotation of a quaternion of any length; of length zero, the identity.
fn rotation([x, y, z, w]: [f64; 4]) -> [[f64; 3]; 3] {
    let length_sq = x * x + y * y + z * z + w * w;
    let s = if length_sq > 0.0 { 2.0 / length_sq } else { 0.0 };
    [
        [1.0 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)],
        [s * (x * y - z * w), 1.0 - s * (x * x + z * z), s * (y * z + x * w)],
        [s * (x * z + y * w), s * (y * z - x * w), 1.0 - s * (x * x + y * y)],
    ]
}

/// The vector at length one, or as it is where it has none.
pub(crate) fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = dot(vector, vector).sqrt();
    if length > 0.0 && length.is_finite() { vector.map(|value| value / length) } else { vector }
}

fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn dot(u: [f64; 3], v: [f64; 3]) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map_of(node: &Node) -> Affine {
        Affine::of_node(node, Place::File).unwrap()
    }

    #[test]
    fn scale_then_rotation_then_translation() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let map = map_of(&Node {
            scale: Some([2.0, 3.0, 4.0]),
            rotation: Some([0.0, 0.0, half, half]),
            translation: Some([10.0, 0.0, 0.0]),
            ..Node::default()
        });
        let image = map.apply([1.0, 1.0, 1.0]);
        for (found, expected) in image.into_iter().zip([7.0, 2.0, 4.0]) {
            assert!((found - expected).abs() < 1e-12, "{image:?}");
        }
        assert!((map.determinant() - 24.0).abs() < 1e-12);
    }

    #[test]
    fn matrices_are_given_by_columns() {
        let matrix = [1.0, 2.0, 3.0, 0.0, 4.0, 5.0, 6.0, 0.0, 7.0, 8.0, 10.0, 0.0, 11.0, 12.0, 13.0, 1.0];
        let map = map_of(&Node { matrix: Some(matrix), ..Node::default() });
        assert_eq!(map.apply([0.0, 1.0, 0.0]), [15.0, 17.0, 19.0]);
        let mut projective = matrix;
        projective[3] = 1.0;
        let projective = Node { matrix: Some(projective), ..Node::default() };
        assert!(Affine::of_node(&projective, Place::File).is_err());
    }

    #[test]
    fn normals_stay_at_right_angles() {
        let shear =
            Affine { linear: [[1.0, 0.0, 0.0], [0.7, 2.0, 0.0], [0.0, 0.3, -1.5]], translation: [1.0; 3] };
        let (u, v) = ([1.0, 2.0, 0.5], [0.0, 1.0, -3.0]);
        let normal = shear.of_normals().turn(cross(u, v));
        assert!(dot(normal, shear.turn(u)).abs() < 1e-12 && dot(normal, shear.turn(v)).abs() < 1e-12);
        // The map mirrors; a normal must not go through the surface, so it keeps its side: that of
        // a direction off the plane.
        let off = cross(u, v);
        assert!(dot(normal, shear.turn(off)) > 0.0);
    }

    #[test]
    fn maps_compose_from_the_inside() {
        let outer = map_of(&Node { scale: Some([2.0; 3]), ..Node::default() });
        let inner = map_of(&Node { translation: Some([1.0, 0.0, 0.0]), ..Node::default() });
        assert_eq!(outer.after(&inner).apply([1.0, 0.0, 0.0]), [4.0, 0.0, 0.0]);
        assert!(inner.is_translation() && !outer.is_translation());
    }
}
