//! Vertices in the order of their errors (section 4.4): a heap from which any vertex can be taken.
//!
//! The paper's heap is binary. This one has four children a node, which halves its height, and
//! keeps key and vertex in one word, so that a comparison touches nothing else.
//!
//! Equal errors are ordered by vertex, the even ones first, then every second of those that are
//! left, and so on: by the bits of their numbers, the lowest foremost. Flat parts have nothing but
//! equal errors, and vertices of near numbers are neighbours there; one after the other they would
//! go into one vertex, whose star grows, and whose triangles reach ever farther over the part.

use crate::flat::NO_INDEX;

/// A priority queue of vertices, the least error first.
#[derive(Clone, Debug, Default)]
pub(crate) struct VertexQueue {
    /// Error bits above, those of the vertex below in reverse; children of `i` are
    /// `4 i + 1 ..= 4 i + 4`.
    heap: Vec<u64>,
    /// Where each vertex is in the heap, or [`NO_INDEX`].
    places: Vec<u32>,
}

const CHILDREN: usize = 4;

impl VertexQueue {
    /// An empty queue for vertices below `n_vertices`.
    pub(crate) fn new(n_vertices: usize) -> Self {
        Self { heap: Vec::with_capacity(n_vertices), places: vec![NO_INDEX; n_vertices] }
    }

    /// Makes room for one more vertex.
    pub(crate) fn add_vertex(&mut self) {
        self.places.push(NO_INDEX);
    }

    /// How many vertices are queued.
    pub(crate) fn len(&self) -> usize {
        self.heap.len()
    }

    /// Whether `vertex` is queued.
    #[inline]
    pub(crate) fn contains(&self, vertex: u32) -> bool {
        self.places[vertex as usize] != NO_INDEX
    }

    /// The least error in the queue.
    pub(crate) fn least(&self) -> Option<f64> {
        self.heap.first().map(|&entry| unpack(entry).1)
    }

    /// Queues `vertex`, or moves it to where its new error belongs. Errors are not negative. O(log
    /// n).
    pub(crate) fn set(&mut self, vertex: u32, error: f64) {
        let entry = pack(vertex, error);
        let place = self.places[vertex as usize];
        if place == NO_INDEX {
            self.heap.push(entry);
            self.rise(self.heap.len() - 1, entry);
        } else {
            let place = place as usize;
            if entry < self.heap[place] {
                self.rise(place, entry);
            } else {
                self.sink(place, entry);
            }
        }
    }

    /// Takes the vertex with the least error, and that error as it was rounded for the queue. O(log
    /// n).
    pub(crate) fn pop(&mut self) -> Option<(u32, f64)> {
        let &entry = self.heap.first()?;
        let (vertex, error) = unpack(entry);
        self.delete(vertex);
        Some((vertex, error))
    }

    /// Takes `vertex` out, wherever it is; nothing happens if it is not queued. O(log n).
    pub(crate) fn delete(&mut self, vertex: u32) {
        let place = std::mem::replace(&mut self.places[vertex as usize], NO_INDEX);
        if place == NO_INDEX {
            return;
        }
        let place = place as usize;
        let Some(last) = self.heap.pop() else { return };
        if place < self.heap.len() {
            if last < self.heap[place] {
                self.rise(place, last);
            } else {
                self.sink(place, last);
            }
        }
    }

    /// Puts `entry` at `place` or above it.
    fn rise(&mut self, mut place: usize, entry: u64) {
        while place > 0 {
            let parent = (place - 1) / CHILDREN;
            if self.heap[parent] <= entry {
                break;
            }
            self.put(place, self.heap[parent]);
            place = parent;
        }
        self.put(place, entry);
    }

    /// Puts `entry` at `place` or below it.
    fn sink(&mut self, mut place: usize, entry: u64) {
        loop {
            let first = CHILDREN * place + 1;
            let children = first..(first + CHILDREN).min(self.heap.len());
            let least = children.min_by_key(|&child| self.heap[child]);
            match least {
                Some(child) if self.heap[child] < entry => {
                    self.put(place, self.heap[child]);
                    place = child;
                }
                _ => break,
            }
        }
        self.put(place, entry);
    }

    #[inline]
    fn put(&mut self, place: usize, entry: u64) {
        self.heap[place] = entry;
        let (vertex, _) = unpack(entry);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "each vertex is queued once, and vertices are u32"
        )]
        let at = place as u32;
        self.places[vertex as usize] = at;
    }
}

/// Bits of floats that are not negative are ordered like the floats.
#[inline]
fn pack(vertex: u32, error: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, reason = "the order among nearly equal errors is free")]
    let error = error as f32;
    u64::from(error.to_bits()) << 32 | u64::from(vertex.reverse_bits())
}

#[inline]
#[expect(clippy::cast_possible_truncation, reason = "takes the halves of a word apart")]
fn unpack(entry: u64) -> (u32, f64) {
    ((entry as u32).reverse_bits(), f64::from(f32::from_bits((entry >> 32) as u32)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn agrees_with_a_sorted_map(operations in prop::collection::vec((0_u32..24, 0_u16..50, 0_u8..4), 0..400)) {
            let mut queue = VertexQueue::new(24);
            let mut errors: BTreeMap<u32, u16> = BTreeMap::new();
            for (vertex, error, what) in operations {
                match what {
                    0 => {
                        let least = errors.iter().map(|(&v, &e)| (e, v.reverse_bits(), v)).min();
                        prop_assert_eq!(queue.pop(), least.map(|(e, _, v)| (v, f64::from(e))));
                        least.map(|(.., v)| errors.remove(&v));
                    }
                    1 => {
                        queue.delete(vertex);
                        errors.remove(&vertex);
                    }
                    _ => {
                        queue.set(vertex, error.into());
                        errors.insert(vertex, error);
                    }
                }
                prop_assert_eq!(queue.len() == 0, errors.is_empty());
            }
        }
    }

    #[test]
    fn of_equal_errors_every_second_goes_first() {
        let mut queue = VertexQueue::new(8);
        (0..8).for_each(|v| queue.set(v, 1.0));
        queue.set(5, 0.5);
        let order: Vec<u32> = std::iter::from_fn(|| queue.pop()).map(|(v, _)| v).collect();
        assert_eq!(order, [5, 0, 4, 2, 6, 1, 3, 7]);
    }
}
