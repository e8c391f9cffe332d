//! The input vertices that a hole's filling will stand for.

/// Source vertices over a hole.
#[derive(Clone, Debug, Default)]
pub struct Covered {
    /// The vertices, in no particular order.
    pub vertices: Vec<u32>,
}

impl Covered {
    /// Takes the source vertices of the given lists. O(vertices).
    pub fn gather<'a>(&mut self, lists: impl Iterator<Item = &'a [u32]>) {
        self.vertices.clear();
        lists.for_each(|list| self.vertices.extend_from_slice(list));
    }
}
