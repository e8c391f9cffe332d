//! Vertices and triangles in flat arrays: what a decimator works on.
//!
//! [`repair`] turns whatever a file held into triangles that a decimator can trust; [`Surface`] is
//! the mesh while it is being simplified, with the star of every vertex at hand; a [`Hole`] is a
//! star about to be removed, and a [`Filling`] what closes it.

mod collapse;
mod curve;
mod filling;
mod hole;
mod limits;
mod locked;
mod numbering;
mod renumbering;
mod repair;
mod stars;
mod surface;
mod tetra_repair;
mod tetra_weld;
mod tetrahedra;
mod used;
mod wedges;

pub use curve::along_a_curve;
pub use filling::Filling;
pub use hole::{Hole, MAX_VALENCE, NoHole};
pub use limits::{TooMany, check_counts, check_places};
pub use locked::Locked;
pub use numbering::Numbering;
pub use renumbering::Renumbering;
pub use repair::{RepairReport, Repaired, repair};
pub use stars::{Stars, facing_edge};
pub use surface::Surface;
pub use tetra_repair::{LostParts, RepairedVolume, TetrahedronRepairReport, repair_tetrahedra};
pub(crate) use tetra_weld::{fitting, has_coincident};
pub use tetrahedra::{FACES, Tetrahedra};
pub(crate) use tetrahedra::{boundary_faces, jump_faces};
pub(crate) use used::UsedVertices;
pub use wedges::Wedges;
