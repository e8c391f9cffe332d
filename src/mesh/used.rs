//! The vertices that simplices use.

use crate::flat::{NO_INDEX, to_index};
use nephrite_formats::Attribute;

/// The vertices that some simplex uses, in their order, with new numbers from 0 on.
///
/// Memory: 4 bytes per vertex, 4 more per used one.
pub(crate) struct UsedVertices {
    /// Old number of each used vertex.
    vertices: Vec<u32>,
    /// New number of each vertex; [`NO_INDEX`] if it is not used.
    numbers: Vec<u32>,
}

impl UsedVertices {
    /// Those of `n_vertices` that are among `corners`. O(n).
    pub(crate) fn new(n_vertices: usize, corners: &[u32]) -> Self {
        let mut numbers = vec![NO_INDEX; n_vertices];
        corners.iter().for_each(|&v| numbers[v as usize] = 0);
        let mut vertices = vec![];
        for (v, number) in (0..).zip(&mut numbers).filter(|(_, number)| **number != NO_INDEX) {
            *number = to_index(vertices.len());
            vertices.push(v);
        }
        Self { vertices, numbers }
    }

    /// Gives used vertices their new numbers.
    pub(crate) fn renumber(&self, corners: &mut [u32]) {
        corners.iter_mut().for_each(|v| *v = self.numbers[*v as usize]);
    }

    /// What belongs to the used vertices.
    pub(crate) fn pick<T: Copy>(&self, of_vertices: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&v| of_vertices[v as usize]).collect()
    }

    /// Attributes of the used vertices.
    pub(crate) fn pick_attributes(&self, attributes: &[Attribute]) -> Vec<Attribute> {
        attributes.iter().map(|attribute| pick_values(attribute, &self.vertices)).collect()
    }
}

/// The values of an attribute at `vertices`, in their order.
pub(super) fn pick_values(attribute: &Attribute, vertices: &[u32]) -> Attribute {
    let stride = attribute.stride_bytes();
    let value = |&v: &u32| &attribute.bytes[v as usize * stride..][..stride];
    let bytes = vertices.iter().flat_map(value).copied().collect();
    Attribute { bytes, name: attribute.name.clone(), ..*attribute }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nephrite_formats::ScalarType;

    #[test]
    fn used_vertices_close_up_in_their_order() {
        let mut corners = [5, 1, 3, 1, 3, 4];
        let used = UsedVertices::new(7, &corners);
        used.renumber(&mut corners);
        assert_eq!(corners, [3, 0, 1, 0, 1, 2]);
        assert_eq!(used.pick(&[0, 10, 20, 30, 40, 50, 60]), [10, 30, 40, 50]);
        let heights =
            |values: &[f64]| Attribute::from_values("height", ScalarType::F32, 1, values.iter().copied());
        let picked = used.pick_attributes(&[heights(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0])]);
        assert_eq!(picked, [heights(&[1.0, 3.0, 4.0, 5.0])]);
    }
}
