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
mod places;
mod renumbering;
mod repair;
mod stars;
mod surface;
mod tetra_repair;
mod tetra_weld;
mod tetrahedra;
mod used;
mod wedges;

pub(crate) use curve::along_a_curve;
pub(crate) use filling::Filling;
pub(crate) use hole::{Hole, MAX_VALENCE, NoHole};
pub(crate) use limits::{TooMany, check_counts, check_places};
pub(crate) use locked::Locked;
pub(crate) use numbering::Numbering;
pub(crate) use renumbering::Renumbering;
pub use repair::RepairReport;
pub(crate) use repair::{Repaired, repair};
pub(crate) use stars::{Stars, facing_edge};
pub(crate) use surface::Surface;
pub use tetra_repair::TetrahedronRepairReport;
pub(crate) use tetra_repair::{LostParts, RepairedVolume, repair_tetrahedra};
pub(crate) use tetra_weld::{fitting, has_coincident};
pub(crate) use tetrahedra::{FACES, Tetrahedra};
pub(crate) use tetrahedra::{boundary_faces, jump_faces};
pub(crate) use used::UsedVertices;
pub(crate) use wedges::Wedges;
