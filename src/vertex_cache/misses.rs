//! Counting misses of a simulated cache.

/// Length of the first-in, first-out cache that orders are made and measured for.
pub const CACHE_LEN: u32 = 16;

/// Average cache miss ratio: misses per triangle of a first-in, first-out cache of `cache_len`
/// vertices that is empty at first. 0 for no triangles.
///
/// Memory: 8 bytes per vertex up to the largest one.
///
/// ```
/// use nephrite::miss_ratio;
/// let strip = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]];
/// assert_eq!(miss_ratio(strip, 16), 6.0 / 4.0);
/// ```
pub fn miss_ratio(triangles: impl IntoIterator<Item = [u32; 3]>, cache_len: u32) -> f64 {
    let cache_len = u64::from(cache_len);
    // Misses before each vertex came in, counted from 1; 0 if it never did.
    let mut came_in: Vec<u64> = Vec::new();
    let (mut n_misses, mut n_triangles) = (0, 0u64);
    for triangle in triangles {
        n_triangles += 1;
        for vertex in triangle {
            let vertex = vertex as usize;
            if vertex >= came_in.len() {
                came_in.resize(vertex + 1, 0);
            }
            if came_in[vertex] == 0 || n_misses - came_in[vertex] >= cache_len {
                n_misses += 1;
                came_in[vertex] = n_misses;
            }
        }
    }
    if n_triangles == 0 { 0.0 } else { n_misses as f64 / n_triangles as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_leaves_after_as_many_misses_as_the_cache_is_long() {
        let far = |first| [first, first + 1, first + 2];
        // Three misses each: 0 to 2 come in, are still there after 3 others with a cache of 6, and
        // not with one of 5.
        let triangles = [far(0), far(3), far(0)];
        assert_eq!(miss_ratio(triangles, 6), 2.0);
        assert_eq!(miss_ratio(triangles, 5), 3.0);
        assert_eq!(miss_ratio(triangles, 0), 3.0);
        assert_eq!(miss_ratio([], 16), 0.0);
    }

    #[test]
    fn counts_equal_those_of_a_queue() {
        let mut random = 1u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 16) % 40
        };
        let triangles: Vec<[u32; 3]> = (0..2000).map(|_| [next(), next(), next()]).collect();
        let mut queue = std::collections::VecDeque::new();
        let mut n_misses = 0u32;
        for vertex in triangles.iter().flatten() {
            if !queue.contains(vertex) {
                n_misses += 1;
                queue.push_back(*vertex);
                if queue.len() > 16 {
                    queue.pop_front();
                }
            }
        }
        assert_eq!(miss_ratio(triangles, 16), f64::from(n_misses) / 2000.0);
    }
}
