//! The change from one level to another.

use super::{Cut, Lod};
use crate::tree::Difference;

/// The triangles that leave and those that enter on the way from one level to another. It is for
/// callers who keep something per triangle: a stream, a collision structure, an acceleration
/// structure for rays.
///
/// Both are runs of slots whose triangles are read from [`Lod::indices`]. A triangle of both levels
/// is in neither. A triangle that is stored twice may have another slot here than in a cut, so
/// compare vertex indices, not slots. In a file written in windows
/// ([`StoreOptions::window_levels`](crate::store::StoreOptions::window_levels)) every triangle
/// leaves at the border of a window, and those that stay enter again: take out what leaves first.
///
/// ```no_run
/// # let lod = nephrite::Lod::open("bunny.neph")?;
/// # let (mut add, mut remove) = (|_: &[u32]| (), |_: &[u32]| ());
/// let delta: nephrite::Delta = lod.delta(7, 8);
/// for run in delta.leaving() {
///     lod.indices()[run.index_range(3)].chunks(3).for_each(&mut remove);
/// }
/// for run in delta.entering() {
///     lod.indices()[run.index_range(3)].chunks(3).for_each(&mut add);
/// }
/// # Ok::<(), nephrite::OpenError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Delta<'a> {
    before: Cut<'a>,
    after: Cut<'a>,
}

impl<'a> Delta<'a> {
    /// The level before.
    pub fn before(&self) -> Cut<'a> {
        self.before
    }

    /// The level after.
    pub fn after(&self) -> Cut<'a> {
        self.after
    }

    /// Triangles of the level before that the level after does not have.
    ///
    /// Cost between neighbouring levels: at most one run per height of the interval tree, and time
    /// that does not depend on the number of triangles. Between other levels, at most linear in the
    /// triangles that are born or die between the two.
    pub fn leaving(&self) -> Difference<'a> {
        only_at(self.before, self.after)
    }

    /// Triangles of the level after that the level before does not have. Cost: as
    /// [`leaving`](Self::leaving).
    pub fn entering(&self) -> Difference<'a> {
        only_at(self.after, self.before)
    }
}

fn only_at<'a>(cut: Cut<'a>, other: Cut<'a>) -> Difference<'a> {
    let file = cut.lod().file();
    file.tree().only_at(cut.level(), other.level(), file.stamps())
}

impl Lod {
    /// The change from level `from` to level `to`, in either direction. A level that does not exist
    /// is the coarsest one. Allocates nothing.
    pub fn delta(&self, from: u32, to: u32) -> Delta<'_> {
        Delta { before: self.at_level(from), after: self.at_level(to) }
    }
}
