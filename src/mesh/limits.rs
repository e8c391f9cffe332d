//! How many vertices and simplices a mesh may have.
//!
//! Ids are `u32`, and so are places in the pools that hold stars, with up to six entries for each
//! triangle and eight for each tetrahedron between two tidyings. What is accepted leaves room for
//! these, and for as many fusion points as vertices: every cast of a count or place below relies on
//! it. How much the pools of the proof hold depends on how the surface lies, so they are compared
//! with their limit before each change.

/// Most vertices that are accepted.
pub(super) const MAX_VERTICES: usize = (u32::MAX / 2) as usize;

/// Most triangles or tetrahedra that are accepted.
pub(super) const MAX_SIMPLICES: usize = (u32::MAX / 8) as usize;

/// Most entries of a pool whose places are `u32`; the last number stands for no place.
pub(super) const MAX_PLACES: usize = (u32::MAX - 1) as usize;

/// A count beyond its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooMany {
    /// What is counted, in the plural.
    pub what: &'static str,
    /// How many there are.
    pub found: usize,
    /// How many there may be.
    pub limit: usize,
}

/// Compares the counts of a mesh with the limits.
///
/// # Errors
///
/// The first count that is too large.
pub(crate) fn check_counts(n_vertices: usize, n_simplices: usize) -> Result<(), TooMany> {
    check_count("vertices", n_vertices, MAX_VERTICES)?;
    check_count("simplices", n_simplices, MAX_SIMPLICES)
}

/// Compares a pool's entries, and those about to be added, with their limit.
///
/// # Errors
///
/// `what` it holds, and how many there would be.
pub(crate) fn check_places(what: &'static str, n_entries: usize, n_more: usize) -> Result<(), TooMany> {
    check_count(what, n_entries.saturating_add(n_more), MAX_PLACES)
}

fn check_count(what: &'static str, found: usize, limit: usize) -> Result<(), TooMany> {
    if found > limit { Err(TooMany { what, found, limit }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn too_many(what: &'static str, found: usize, limit: usize) -> Result<(), TooMany> {
        Err(TooMany { what, found, limit })
    }

    #[test]
    fn counts_are_accepted_up_to_their_limits() {
        assert_eq!(check_counts(MAX_VERTICES, MAX_SIMPLICES), Ok(()));
        assert_eq!(check_counts(MAX_VERTICES + 1, 0), too_many("vertices", MAX_VERTICES + 1, MAX_VERTICES));
        assert_eq!(
            check_counts(3, MAX_SIMPLICES + 1),
            too_many("simplices", MAX_SIMPLICES + 1, MAX_SIMPLICES)
        );
    }

    #[test]
    fn pools_are_filled_up_to_their_limit() {
        assert_eq!(check_places("portions", MAX_PLACES - 5, 5), Ok(()));
        assert_eq!(
            check_places("portions", MAX_PLACES - 5, 6),
            too_many("portions", MAX_PLACES + 1, MAX_PLACES)
        );
        assert_eq!(check_places("portions", 1, usize::MAX), too_many("portions", usize::MAX, MAX_PLACES));
    }
}
