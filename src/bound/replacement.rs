//! What a removal does to the mesh.

use crate::mesh::{Filling, Hole, Surface};

/// A star about to be replaced by a filling.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Replacement<'a> {
    /// The mesh before it.
    pub surface: &'a Surface,
    /// The star.
    pub hole: &'a Hole,
    /// What closes it; its triangles go into the first slots of the star.
    pub filling: &'a Filling,
}
