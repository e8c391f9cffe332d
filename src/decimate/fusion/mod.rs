//! Fusion: tetrahedra collapse to points, one after another, in the order of the planar quadric
//! error metric.
//!
//! The naive decimator of volumes collapses edges and needs ten times as many steps. A fusion takes
//! all four vertices of a tetrahedron, the *prey*, to one *fusion point* (the paper's words): the
//! tetrahedra that share two of them or more die, at least eleven inside the mesh, those that share
//! one stretch to the new vertex.
//!
//! Why the mesh stays one. Before the fusion the tetrahedra around the prey fill a region exactly.
//! Its outer faces, seen from the fusion point, are the bases of the tetrahedra after it. If all of
//! those have positive volume, they fill the region bounded by the same faces and the new boundary,
//! exactly and without overlap: two sums of tetrahedra in space with one boundary are equal, and
//! with positive volumes only, no place can be counted more than once. So inside the mesh the test
//! against flipping is a topological test too, and an exact one. At the boundary it remains to see
//! that the faces that go are a disk, that those that come are one over the same rim, and that they
//! lie inside (`patch`); genus and components then stay what they are. Where the tetrahedra of a
//! file do not fill space once, vertices stay where they are, and a face never gets a third
//! tetrahedron (`links`).
//!
//! Reference: P. Chopra, J. Meyer: "Topology sensitive volume mesh simplification with planar
//! quadric error metrics" (IASTED International Conference on Visualization, Imaging and Image
//! Processing, 2003).

mod attempt;
mod creases;
mod edges;
mod fields;
mod fusion_point;
mod jumps;
mod links;
mod metric;
mod neighbourhood;
mod options;
mod patch;
mod prey;
mod queue;
mod run;
mod state;
mod tetrahedra;
mod unit;

pub use options::FusionOptions;
pub(crate) use run::run;
pub use state::FusionReport;
