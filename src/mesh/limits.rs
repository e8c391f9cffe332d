//! How many vertices and simplices a mesh may have.
//!
//! Ids are `u32`, and so are places in the pools that hold stars, with up to six entries for each triangle and eight for each
//! tetrahedron between two tidyings. What is accepted leaves room for these, and for as many fusion points as vertices: every
//! cast of a count or place below relies on it.

/// Most vertices that are accepted.
pub const MAX_VERTICES: usize = (u32::MAX / 2) as usize;

/// Most triangles or tetrahedra that are accepted.
pub const MAX_SIMPLICES: usize = (u32::MAX / 8) as usize;

/// A count beyond its limit: what is counted, in the plural, how many there are, and the limit.
pub type TooMany = (&'static str, usize, usize);

/// Compares the counts of a mesh with the limits.
///
/// # Errors
///
/// The first count that is too large.
pub fn check_counts(n_vertices: usize, n_simplices: usize) -> Result<(), TooMany> {
    let counts = [("vertices", n_vertices, MAX_VERTICES), ("simplices", n_simplices, MAX_SIMPLICES)];
    counts.into_iter().find(|(_, found, limit)| found > limit).map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_accepted_up_to_their_limits() {
        assert_eq!(check_counts(MAX_VERTICES, MAX_SIMPLICES), Ok(()));
        assert_eq!(check_counts(MAX_VERTICES + 1, 0), Err(("vertices", MAX_VERTICES + 1, MAX_VERTICES)));
        assert_eq!(check_counts(3, MAX_SIMPLICES + 1), Err(("simplices", MAX_SIMPLICES + 1, MAX_SIMPLICES)));
    }
}
