//! One form for the three ways to write an oriented triangle.

/// The triangle from its least corner on, in its orientation.
pub(crate) fn canonical<T: PartialOrd>([a, b, c]: [T; 3]) -> [T; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_begins_with_its_least_corner_and_keeps_its_orientation() {
        for triangle in [[1, 5, 3], [5, 3, 1], [3, 1, 5]] {
            assert_eq!(canonical(triangle), [1, 5, 3]);
        }
        assert_eq!(canonical([3, 5, 1]), [1, 3, 5]);
        assert_eq!(canonical([2, 1, 1]), [1, 1, 2]);
    }
}
