//! Corners at the same position joined into one vertex.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The distinct positions in first-seen order, and the number of its vertex for each corner. Zero
/// and minus zero are the same.
///
/// Expected linear time; the standard hash function has a secret key, so no file can make the table
/// slow.
pub(crate) fn weld(corners: &[[f32; 3]]) -> (Vec<[f32; 3]>, Vec<u32>) {
    let mut vertex_at: HashMap<[u32; 3], u32> = HashMap::with_capacity(corners.len() / 4);
    let mut positions = Vec::new();
    let mut next = 0;
    let mut vertex_of =
        |&corner: &[f32; 3]| match vertex_at.entry(corner.map(|value| (value + 0.0).to_bits())) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                positions.push(corner);
                next += 1;
                *entry.insert(next - 1)
            }
        };
    let vertices = corners.iter().map(&mut vertex_of).collect();
    (positions, vertices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_become_one_vertex() {
        let (positions, vertices) = weld(&[[1.0, 0.0, 0.0], [0.0; 3], [1.0, -0.0, 0.0], [1.0, 1e-45, 0.0]]);
        assert_eq!(vertices, [0, 1, 0, 2]);
        assert_eq!(positions, [[1.0, 0.0, 0.0], [0.0; 3], [1.0, 1e-45, 0.0]]);
    }
}
