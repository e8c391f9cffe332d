//! What a file stores: whole lifetimes, or lifetimes cut at the borders of windows.
//!
//! Triangles that are born together are seldom neighbours, so that levels drawn as prefixes of the
//! interval tree transform most vertices twice. Most triangles of a level live through the levels
//! around it, however. If lifetimes are cut at the borders of windows of `2^k` levels, each window
//! is a node of the tree, and what lives throughout the window is one group of that node, in which
//! neighbours are together and the order is free. A simplex is then stored in every window that
//! sees it: smaller windows buy fewer misses of the vertex cache with a larger file.

use super::WriteError;
use crate::History;
use crate::history::Levels;
use crate::tree::{Lifetime, TreeError};

/// The lifetimes that a file stores, by id.
pub(super) struct Pieces<'a, const CORNERS: usize> {
    history: &'a History<CORNERS>,
    levels: &'a Levels,
    /// Simplex and lifetime by id; without windows the simplices are the ids.
    cut: Option<Vec<(u32, Lifetime)>>,
}

impl<'a, const CORNERS: usize> Pieces<'a, CORNERS> {
    /// Cuts lifetimes at the multiples of `window_levels`, which is rounded up to a power of two;
    /// not at all for `None`.
    ///
    /// Memory: 12 bytes per piece if they are cut.
    pub(super) fn new(
        history: &'a History<CORNERS>,
        levels: &'a Levels,
        window_levels: Option<u32>,
    ) -> Result<Self, WriteError> {
        let mut pieces = Self { history, levels, cut: None };
        if let Some(window_levels) = window_levels {
            // Files have at most 2^31 levels.
            let height = window_levels.clamp(1, 1 << 31).next_power_of_two().trailing_zeros();
            let whole = (0..pieces.n_ids()?).filter_map(|id| Some((id, pieces.lifetime(id)?)));
            pieces.cut = Some(
                whole.flat_map(|(id, life)| windows(life, height).map(move |life| (id, life))).collect(),
            );
        }
        Ok(pieces)
    }

    /// Levels that lifetimes count.
    pub(super) fn n_levels(&self) -> u32 {
        self.levels.n_levels()
    }

    /// Number of ids.
    pub(super) fn n_ids(&self) -> Result<u32, WriteError> {
        let n_ids = self.cut.as_ref().map_or(self.history.simplices.len(), Vec::len);
        let max = u64::from(u32::MAX);
        let too_many = TreeError::TooManySlots { found: n_ids as u64, max };
        u32::try_from(n_ids).map_err(|_| too_many.into())
    }

    /// Simplices of the history.
    pub(super) fn n_simplices(&self) -> usize {
        self.history.simplices.len()
    }

    /// The simplex of a piece.
    pub(super) fn simplex(&self, id: u32) -> u32 {
        self.cut.as_ref().map_or(id, |cut| cut[id as usize].0)
    }

    /// Its vertices, as the history names them.
    pub(super) fn vertices(&self, id: u32) -> [u32; CORNERS] {
        self.history.simplices[self.simplex(id) as usize]
    }

    /// Its lifetime, or `None` when no level sees it.
    pub(super) fn lifetime(&self, id: u32) -> Option<Lifetime> {
        match &self.cut {
            Some(cut) => Some(cut[id as usize].1),
            None => self.levels.lifetime(self.history.birth[id as usize], self.history.death[id as usize]),
        }
    }
}

/// The parts of a lifetime in each window of `2^height` levels.
fn windows(life: Lifetime, height: u32) -> impl Iterator<Item = Lifetime> {
    (life.birth() >> height..=life.last() >> height).filter_map(move |window| {
        let start = window << height;
        // Ends behind 2^31 exceed every death.
        let end = (u64::from(window) + 1) << height;
        let end = u32::try_from(end).unwrap_or(u32::MAX);
        Lifetime::new(life.birth().max(start), life.death().min(end))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(birth: u32, death: u32, height: u32) -> Vec<(u32, u32)> {
        let life = Lifetime::new(birth, death).unwrap();
        windows(life, height).map(|part| (part.birth(), part.death())).collect()
    }

    #[test]
    fn parts_meet_and_stay_in_their_windows() {
        assert_eq!(parts(3, 9, 2), [(3, 4), (4, 8), (8, 9)]);
        assert_eq!(parts(4, 8, 2), [(4, 8)]);
        assert_eq!(parts(5, 6, 2), [(5, 6)]);
        assert_eq!(parts(3, 5, 0), [(3, 4), (4, 5)]);
        assert_eq!(parts(0, 1 << 31, 31), [(0, 1 << 31)]);
        assert_eq!(parts((1 << 31) - 1, 1 << 31, 30), [((1 << 31) - 1, 1 << 31)]);
    }
}
