//! The vertices that a level uses, with new numbers.

use crate::store::AttributeView;
use nephrite_formats::Attribute;

/// Which vertices of a prefix are used.
pub(super) struct UsedVertices {
    /// Places in the prefix, ascending; `None` if all vertices are used.
    places: Option<Vec<u32>>,
    n_prefix: usize,
}

impl UsedVertices {
    /// Numbers the used vertices among the first `n_prefix` in their order, and replaces the old
    /// numbers in `indices` by the new ones. Every index must be below `n_prefix`. Cost: one pass
    /// over indices and prefix, and 9 bytes per vertex.
    pub(super) fn compact(indices: &mut [u32], n_prefix: usize) -> Self {
        let mut is_used = vec![false; n_prefix];
        for &index in indices.iter() {
            is_used[index as usize] = true;
        }
        if is_used.iter().all(|&used| used) {
            return Self { places: None, n_prefix };
        }
        let mut numbers = vec![0; n_prefix];
        let mut places = Vec::new();
        for (place, (number, _)) in
            (0u32..).zip(numbers.iter_mut().zip(is_used)).filter(|(_, (_, used))| *used)
        {
            *number = u32::try_from(places.len()).unwrap_or(u32::MAX);
            places.push(place);
        }
        indices.iter_mut().for_each(|index| *index = numbers[*index as usize]);
        Self { places: Some(places), n_prefix }
    }

    /// Positions of the used vertices, from those of the prefix.
    pub(super) fn positions(&self, prefix: &[[f32; 3]]) -> Vec<[f32; 3]> {
        match &self.places {
            None => prefix.to_vec(),
            Some(places) => places.iter().map(|&place| prefix[place as usize]).collect(),
        }
    }

    /// An attribute of the used vertices.
    pub(super) fn attribute(&self, view: &AttributeView<'_>) -> Attribute {
        let stride = view.stride_bytes();
        let bytes = match &self.places {
            None => view.bytes.get(..self.n_prefix * stride).unwrap_or(&[]).to_vec(),
            Some(places) => {
                let value = |&place: &u32| {
                    view.bytes.get(place as usize * stride..).and_then(|rest| rest.get(..stride))
                };
                places.iter().filter_map(value).flatten().copied().collect()
            }
        };
        Attribute { name: view.name.to_owned(), scalar: view.scalar, n_components: view.n_components, bytes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nephrite_formats::ScalarType;

    #[test]
    fn used_vertices_keep_their_order_and_their_values() {
        let mut indices = [4, 1, 3, 1];
        let used = UsedVertices::compact(&mut indices, 6);
        assert_eq!(indices, [2, 0, 1, 0]);
        let prefix = [0u8, 1, 2, 3, 4, 5].map(|i| [f32::from(i); 3]);
        assert_eq!(used.positions(&prefix), [[1.0; 3], [3.0; 3], [4.0; 3]]);
        let bytes = [0, 1, 10, 11, 20, 21, 30, 31, 40, 41, 50, 51];
        let view = AttributeView { name: "a", scalar: ScalarType::U8, n_components: 2, bytes: &bytes };
        assert_eq!(used.attribute(&view).bytes, [10, 11, 30, 31, 40, 41]);
    }

    #[test]
    fn a_prefix_that_is_all_used_stays() {
        let mut indices = [2, 0, 1];
        let used = UsedVertices::compact(&mut indices, 3);
        assert_eq!(indices, [2, 0, 1]);
        assert_eq!(used.positions(&[[0.0; 3], [1.0; 3], [2.0; 3]]).len(), 3);
    }
}
