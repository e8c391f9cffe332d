//! The vertices of a file, and the mesh that is made of them and its faces.

use crate::files::coordinates::{Coordinates, Points};
use crate::files::error::{MeshError, Place};
use crate::files::faces::Faces;
use crate::{Attribute, FileReport, TriangleMesh};

/// The vertices of a file, and the places of those whose coordinates `f32` cannot hold.
pub(crate) struct Vertices {
    pub points: Points,
    pub attributes: Vec<Attribute>,
    /// Vertex and place, in the order of the vertices; only of text.
    pub bad_places: Vec<(usize, Place)>,
}

impl Vertices {
    /// The mesh of these vertices and faces, see [`assemble`].
    ///
    /// # Errors
    ///
    /// As [`assemble`].
    pub(crate) fn into_mesh(
        self,
        faces: Faces,
        report: FileReport,
    ) -> Result<(TriangleMesh, FileReport), MeshError> {
        let Self { points, attributes, bad_places } = self;
        assemble(points, attributes, faces, &|vertex| place_of(&bad_places, vertex), report)
    }
}

/// Where a vertex stands: at its place if that is in the list, which is in the order of the
/// vertices, else at its number.
pub(crate) fn place_of(bad_places: &[(usize, Place)], vertex: usize) -> Place {
    let found = bad_places.binary_search_by_key(&vertex, |&(vertex, _)| vertex);
    found.map_or(Place::item("vertex", vertex), |at| bad_places[at].1)
}

/// Leaves out vertices that no face uses and that have no place, chooses the origin, and cuts the
/// faces into triangles.
///
/// # Errors
///
/// [`MeshError::NonFinite`] or [`MeshError::CoordinateTooLarge`] for a vertex that a face uses,
/// [`MeshError::NoFaces`] if no triangle results.
pub(crate) fn assemble(
    mut points: Points,
    mut attributes: Vec<Attribute>,
    mut faces: Faces,
    place_of: &dyn Fn(usize) -> Place,
    mut report: FileReport,
) -> Result<(TriangleMesh, FileReport), MeshError> {
    points.drop_bad(&mut attributes, &mut faces.corners_mut(), place_of, &mut report)?;
    let Coordinates { origin, positions, rounding } = points.into_coordinates()?;
    let triangles = faces.into_triangles(&positions, &mut report);
    if triangles.is_empty() {
        return Err(MeshError::NoFaces { n_vertices: positions.len() });
    }
    Ok((TriangleMesh { origin, positions, triangles, attributes, rounding }, report))
}
