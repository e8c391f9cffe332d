//! Levels of a volume: as tetrahedra, as the surface around them, and as a plane section.

use super::used::UsedVertices;
use super::{Cut, QueryError};
use crate::volume::{self, Plane};
use nephrite_formats::{TetrahedronMesh, TriangleMesh};

impl Cut<'_> {
    /// The level of a volume as a mesh of its own, with fields and without vertices that no
    /// tetrahedron uses. Every index and every position is checked.
    ///
    /// # Errors
    ///
    /// [`QueryError::NotTetrahedra`] for a file of other simplices; [`QueryError::VertexIndex`] and
    /// [`QueryError::Position`] for a damaged file.
    pub fn to_volume(&self) -> Result<TetrahedronMesh, QueryError> {
        let lod = self.lod();
        if lod.n_corners() != 4 {
            return Err(QueryError::NotTetrahedra { found: lod.n_corners() });
        }
        let positions = self.vertices();
        if let Some(vertex) = positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
            return Err(QueryError::Position { vertex });
        }
        let mut tetrahedra = vec![[0; 4]; self.n_simplices()];
        self.extract_into(tetrahedra.as_flattened_mut())?;
        self.check_indices(tetrahedra.as_flattened())?;
        let used = UsedVertices::compact(tetrahedra.as_flattened_mut(), positions.len());
        Ok(TetrahedronMesh {
            origin: lod.origin(),
            positions: used.positions(positions),
            tetrahedra,
            attributes: lod.attributes().map(|view| used.attribute(&view)).collect(),
            rounding: lod.rounding(),
        })
    }

    /// The surface around the level of a volume, seen counter-clockwise from outside, with the
    /// fields of its vertices.
    ///
    /// # Errors
    ///
    /// As [`to_volume`](Self::to_volume).
    pub fn boundary(&self) -> Result<TriangleMesh, QueryError> {
        Ok(volume::boundary_of_checked(&self.to_volume()?))
    }

    /// The section of the level of a volume with a plane given in file coordinates: triangles with
    /// interpolated fields that face along the normal of the plane.
    ///
    /// # Errors
    ///
    /// As [`to_volume`](Self::to_volume).
    pub fn slice(&self, plane: &Plane) -> Result<TriangleMesh, QueryError> {
        Ok(volume::slice(&self.to_volume()?, plane))
    }
}
