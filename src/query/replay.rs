//! A mesh with a count between two levels, from the operations of the file.

use super::used::UsedVertices;
use super::{Cut, Lod};
use crate::progressive_mesh::{ProgressiveMesh, StreamError};
use crate::store::AttributeView;
use nephrite_formats::TriangleMesh;

/// A mesh between two levels.
#[derive(Clone, Debug)]
pub struct Replayed<'a> {
    /// The mesh, without vertices that no triangle uses.
    pub mesh: TriangleMesh,
    /// The finest level that has no more triangles. Its error holds for the mesh as well.
    pub bound: Cut<'a>,
}

impl Lod {
    /// The largest mesh with at most `n_triangles` that the file's operations lead to, whether or
    /// not it is a level. Most operations make two triangles, so the count is met or missed by one;
    /// a few make more. `None` if the file has no operations, and for counts that no level falls
    /// short of or exceeds: [`at_count`](Self::at_count) answers those. Cost: all operations are
    /// read.
    ///
    /// # Errors
    ///
    /// [`StreamError`] for damaged operations.
    ///
    /// ```
    /// use nephrite::{BuildOptions, Lod, ProgressiveOptions, Replayed, StoreOptions, build, generate};
    /// let options = BuildOptions::with(ProgressiveOptions::default());
    /// let few = StoreOptions { levels: Some(4), operations: true, ..StoreOptions::default() };
    /// let mut bytes = std::io::Cursor::new(vec![]);
    /// build(&generate::torus(40, 20), &options)?.write_to(&mut bytes, &few)?;
    /// let lod = Lod::from_bytes(bytes.get_ref())?;
    /// let Replayed { mesh, bound } = lod.replay(1000)?.ok_or("no operations")?;
    /// assert!((999..=1000).contains(&mesh.triangles.len()));
    /// assert!(bound.n_simplices() < 999);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn replay(&self, n_triangles: usize) -> Result<Option<Replayed<'_>>, StreamError> {
        let counts = self.file().simplex_counts();
        let is_between = counts.first().is_some_and(|&finest| n_triangles < finest as usize)
            && counts.last().is_some_and(|&coarsest| n_triangles > coarsest as usize);
        if self.file().operations().is_empty() || !is_between {
            return Ok(None);
        }
        let mut played = ProgressiveMesh::from_bytes(self.file().operations())?;
        let count = played.seek(n_triangles);
        let mut triangles = played.triangles().to_vec();
        let used = UsedVertices::compact(triangles.as_flattened_mut(), played.positions().len());
        let mut start = 0;
        let attributes = self.attributes().map(|view| {
            let values = start..start + view.stride_bytes();
            start = values.end;
            let of_vertices = played.attribute_bytes().chunks(played.stride_bytes().max(1));
            let bytes: Vec<u8> =
                of_vertices.filter_map(|all| all.get(values.clone())).flatten().copied().collect();
            used.attribute(&AttributeView { bytes: &bytes, ..view })
        });
        let mesh = TriangleMesh {
            origin: self.origin(),
            positions: used.positions(played.positions()),
            attributes: attributes.collect(),
            triangles,
            rounding: self.rounding(),
        };
        Ok(Some(Replayed { mesh, bound: self.at_count(count) }))
    }
}
