//! Ordering triangles fan by fan.

use super::CACHE_LEN;
use crate::flat::{Groups, NO_INDEX, to_index};

/// Orders triangles so that neighbours are drawn while their vertices are in the cache.
///
/// All triangles around one vertex are drawn. The next vertex is chosen among theirs: the one that
/// came into the cache longest ago and will still be there when its own triangles are drawn. If
/// there is none, it is the last vertex drawn that has triangles left; if there is none either, the
/// first vertex with triangles left in the given order. Linear in the triangles.
///
/// Memory: 4 bytes per vertex of the mesh, kept between calls, and some 40 bytes per triangle
/// during a call.
///
/// Reference: P. Sander, D. Nehab, J. Barczak: "Fast triangle reordering for vertex locality and
/// reduced overdraw" (SIGGRAPH 2007), section 3, the algorithm called Tipsify.
#[derive(Clone, Debug)]
pub(crate) struct FanOrder {
    /// Place of each vertex in the lists of one call.
    place: Vec<u32>,
    vertices: Vec<u32>,
}

impl FanOrder {
    /// For triangles of vertices below `n_vertices`.
    pub(crate) fn new(n_vertices: usize) -> Self {
        Self { place: vec![NO_INDEX; n_vertices], vertices: Vec::new() }
    }

    /// The order of `triangles`: each index below their number, once.
    ///
    /// `None` if a vertex is out of range or the corners do not fit in 32 bits.
    pub(crate) fn order(&mut self, triangles: &[[u32; 3]]) -> Option<Vec<u32>> {
        self.order_owned(triangles.to_vec())
    }

    /// As [`Self::order`], for triangles that the caller gives away.
    pub(crate) fn order_owned(&mut self, mut triangles: Vec<[u32; 3]>) -> Option<Vec<u32>> {
        let corners = triangles.as_flattened();
        u32::try_from(corners.len()).ok()?;
        if corners.iter().any(|&vertex| vertex as usize >= self.place.len()) {
            return None;
        }
        self.enter(&triangles);
        triangles.as_flattened_mut().iter_mut().for_each(|vertex| *vertex = self.place[*vertex as usize]);
        let n_vertices = self.vertices.len();
        for vertex in std::mem::take(&mut self.vertices) {
            self.place[vertex as usize] = NO_INDEX;
        }
        Some(Drawing::new(triangles, n_vertices).run())
    }

    /// Numbers the vertices in the order in which they appear.
    fn enter(&mut self, triangles: &[[u32; 3]]) {
        let mut next_place = 0;
        for &vertex in triangles.as_flattened() {
            let place = &mut self.place[vertex as usize];
            if *place == NO_INDEX {
                *place = next_place;
                next_place += 1;
                self.vertices.push(vertex);
            }
        }
    }
}

/// One call: triangles around each vertex, and how far the drawing has come. Vertices are named by
/// their places.
struct Drawing {
    corners: Vec<[u32; 3]>,
    /// Triangles around each vertex.
    around: Groups<u32>,
    n_left: Vec<u32>,
    is_drawn: Vec<bool>,
    /// Misses so far, and the number of misses at which each vertex came in.
    time: u32,
    came_in: Vec<u32>,
    /// Vertices drawn, the latest last; vertices without triangles left may be missing.
    trail: Vec<u32>,
    /// Length of the trail from which it is shortened.
    long_trail: usize,
    order: Vec<u32>,
}

impl Drawing {
    fn new(corners: Vec<[u32; 3]>, n_vertices: usize) -> Self {
        let around = Groups::new(
            n_vertices,
            (0..).zip(&corners).flat_map(|(triangle, vertices)| vertices.map(|vertex| (vertex, triangle))),
        );
        let n_left = (0..).take(n_vertices).map(|vertex| to_index(around.of(vertex).len())).collect();
        Self {
            is_drawn: vec![false; corners.len()],
            order: Vec::with_capacity(corners.len()),
            trail: Vec::new(),
            came_in: vec![0; n_vertices],
            long_trail: n_vertices,
            time: CACHE_LEN + 1,
            corners,
            around,
            n_left,
        }
    }

    fn run(mut self) -> Vec<u32> {
        let mut first_left = 0;
        let mut fan = self.next_left(&mut first_left);
        while let Some(vertex) = fan {
            if self.trail.len() > self.long_trail {
                self.shorten_trail();
            }
            let trail_start = self.trail.len();
            self.draw_around(vertex);
            fan = self
                .best_of_trail(trail_start)
                .or_else(|| self.latest_left())
                .or_else(|| self.next_left(&mut first_left));
        }
        self.order
    }

    fn draw_around(&mut self, vertex: u32) {
        for at in self.around.range(vertex) {
            let triangle = *self.around.member(at);
            if std::mem::replace(&mut self.is_drawn[triangle as usize], true) {
                continue;
            }
            self.order.push(triangle);
            for corner in self.corners[triangle as usize] {
                self.n_left[corner as usize] -= 1;
                self.trail.push(corner);
                if self.time - self.came_in[corner as usize] > CACHE_LEN {
                    self.came_in[corner as usize] = self.time;
                    self.time += 1;
                }
            }
        }
    }

    /// Drops vertices without triangles left. O(1) per vertex drawn, amortised.
    fn shorten_trail(&mut self) {
        let Self { trail, n_left, .. } = self;
        trail.retain(|&vertex| n_left[vertex as usize] > 0);
        self.long_trail = self.long_trail.max(2 * self.trail.len());
    }

    /// The vertex among the last ones drawn that has been in the cache longest and will stay until
    /// its triangles are drawn; each of them brings in at most two more. If there is none, any
    /// other of them that has triangles left.
    fn best_of_trail(&self, trail_start: usize) -> Option<u32> {
        let mut best = None;
        for &vertex in &self.trail[trail_start..] {
            let n_left = self.n_left[vertex as usize];
            if n_left == 0 {
                continue;
            }
            let age = self.time - self.came_in[vertex as usize];
            let priority = if age + 2 * n_left <= CACHE_LEN { age } else { 0 };
            if best.is_none_or(|(highest, _)| priority > highest) {
                best = Some((priority, vertex));
            }
        }
        best.map(|(_, vertex)| vertex)
    }

    fn latest_left(&mut self) -> Option<u32> {
        while let Some(vertex) = self.trail.pop() {
            if self.n_left[vertex as usize] > 0 {
                return Some(vertex);
            }
        }
        None
    }

    /// The first vertex with triangles left; none before `first_left` has any.
    fn next_left(&self, first_left: &mut u32) -> Option<u32> {
        let n_skipped = self.n_left[*first_left as usize..].iter().take_while(|&&n_left| n_left == 0).count();
        // Vertices are numbered in 32 bits.
        *first_left += u32::try_from(n_skipped).ok()?;
        ((*first_left as usize) < self.n_left.len()).then_some(*first_left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vertex_cache::miss_ratio;

    #[test]
    fn neighbours_come_together() {
        let triangles = [[0, 1, 2], [5, 6, 7], [0, 2, 3], [5, 7, 8]];
        assert_eq!(FanOrder::new(9).order(&triangles), Some(vec![0, 2, 1, 3]));
        assert_eq!(FanOrder::new(8).order(&triangles), None);
    }

    /// Triangles of a grid in an order without any locality.
    fn shuffled_grid(side: u32) -> Vec<[u32; 3]> {
        let n_cells = side * side;
        let mut triangles = Vec::new();
        for cell in 0..n_cells {
            // Coprime to the number of cells, so that each is met once.
            let cell = cell * 7919 % n_cells;
            let (x, y) = (cell % side, cell / side);
            let vertex = |x, y| y * (side + 1) + x;
            let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles
    }

    #[test]
    fn an_order_is_a_permutation_with_few_misses() {
        let triangles = shuffled_grid(100);
        let order = FanOrder::new(101 * 101).order(&triangles).unwrap();
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..20_000));
        let ratio = miss_ratio(order.iter().map(|&triangle| triangles[triangle as usize]), CACHE_LEN);
        assert!(ratio < 0.75 && miss_ratio(triangles, CACHE_LEN) > 1.9, "{ratio}");
    }

    #[test]
    fn one_value_orders_many_lists() {
        let mut fans = FanOrder::new(1000);
        assert_eq!(fans.order(&[]), Some(vec![]));
        let lists = [vec![[0, 1, 2]], shuffled_grid(20), vec![[999, 999, 999], [0, 0, 1], [0, 1, 1]]];
        for list in lists.iter().chain(lists.iter().rev()) {
            assert_eq!(fans.order(list), FanOrder::new(1000).order(list));
            assert_eq!(fans.order(list).unwrap().len(), list.len());
        }
        assert_eq!(fans.order(&[[0, 1, 1000]]), None);
    }
}
