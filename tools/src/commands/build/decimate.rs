//! From a mesh that was read to a file: by the decimators of its kind.

use super::job::Job;
use super::{surface, volume};
use crate::failure::Failure;
use crate::meshes::{Mesh, Read};
use crate::report::Report;

/// Builds the mesh and writes the file.
pub(super) fn run(job: &Job<'_>, read: Read) -> Result<Report, Failure> {
    match read.mesh {
        Mesh::Surface(mesh) => surface::run(job, mesh, &read.report),
        Mesh::Volume(mesh) => volume::run(job, mesh, &read.report),
    }
}
