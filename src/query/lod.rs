//! All levels of detail of one mesh.

use super::{Cut, Simplex};
use crate::store::{AttributeView, Metadata, NO_BOUND, OpenError, Opened, VerifyError};
use std::path::Path;

/// All levels of detail of one mesh, from an opened `.neph` file.
///
/// Shared freely between threads. No query allocates or waits. Level 0 is the input, the last level
/// the coarsest; there is at least one. A file that opens may still be damaged: then answers are
/// wrong, but every run stays inside [`indices`](Self::indices) and every prefix inside
/// [`vertices`](Self::vertices). [`verify`](Self::verify) tells.
///
/// ```no_run
/// # fn draw_indexed(_: std::ops::Range<usize>) {}
/// let lod = nephrite::Lod::open("bunny.neph")?;
/// let cut = lod.at_error(0.001);
/// for run in cut.runs() {
///     draw_indexed(run.index_range(3));
/// }
/// # Ok::<(), nephrite::OpenError>(())
/// ```
#[derive(Debug)]
pub struct Lod {
    file: Opened,
}

/// One level on the curve of error against size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Error of the level, in mesh units; infinite if no bound is stated, as for a level without
    /// triangles.
    pub error: f64,
    /// Its simplices: triangles of a surface, tetrahedra of a volume.
    pub simplices: u32,
    /// Its vertices.
    pub vertices: u32,
}

impl From<Opened> for Lod {
    fn from(file: Opened) -> Self {
        Self { file }
    }
}

/// The error that the number in a file stands for.
pub(super) fn from_file(error: f64) -> f64 {
    if error == NO_BOUND { f64::INFINITY } else { error }
}

impl Lod {
    /// Reads a file into memory.
    ///
    /// # Errors
    ///
    /// [`OpenError`] when the system refuses or the head of the file is not in order.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        Opened::open(path).map(Self::from)
    }

    /// Takes a copy of the bytes of a file. [`from_owner`](Self::from_owner) takes none.
    ///
    /// # Errors
    ///
    /// [`OpenError::Format`] when the head is not in order, [`OpenError::OutOfMemory`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, OpenError> {
        Opened::from_bytes(bytes).map(Self::from)
    }

    /// Opens a file where it lies in memory: in a vector, behind an `Arc`, in a map made elsewhere,
    /// or in the memory of a caller in another language. The bytes must begin at a multiple of 8; a
    /// copy is made if they do not. They must stay the same as long as the result lives: answers are
    /// wrong otherwise, though never out of range.
    ///
    /// # Errors
    ///
    /// As [`from_bytes`](Self::from_bytes).
    ///
    /// ```
    /// use nephrite::{BuildOptions, Lod, StoreOptions, build, generate};
    /// use std::io::Cursor;
    /// use std::sync::Arc;
    /// let mut file = Cursor::new(Vec::new());
    /// build(generate::torus(16, 8), &BuildOptions::default())?.write_to(&mut file, &StoreOptions::default())?;
    /// let bytes: Arc<[u8]> = file.into_inner().into();
    /// let viewers = [Lod::from_owner(Arc::clone(&bytes))?, Lod::from_owner(bytes)?];
    /// assert_eq!(viewers[0].errors(), viewers[1].errors());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_owner(owner: impl AsRef<[u8]> + Send + Sync + 'static) -> Result<Self, OpenError> {
        Opened::from_owner(owner).map(Self::from)
    }

    /// The coarsest level whose error is at most `error` (mesh units): the last one, for errors
    /// never fall. Level 0 if no level has so small an error, as for negative errors and NaN. Cost:
    /// a binary search over the levels.
    pub fn at_error(&self, error: f64) -> Cut<'_> {
        let n_within = self.errors().partition_point(|&stated| stated <= error);
        self.at_index(n_within.saturating_sub(1))
    }

    /// The finest level with at most `n_simplices` simplices; the coarsest level if every level has
    /// more. Cost: a binary search over the levels.
    pub fn at_count(&self, n_simplices: usize) -> Cut<'_> {
        let n_above = self.file.simplex_counts().partition_point(|&stated| stated as usize > n_simplices);
        self.at_index(n_above)
    }

    /// The given level; the coarsest one if there is no such level.
    pub fn at_level(&self, level: u32) -> Cut<'_> {
        Cut::new(self, level.min(self.n_levels() - 1))
    }

    /// Number of levels, at least 1.
    pub fn n_levels(&self) -> u32 {
        self.file.header().n_levels
    }

    /// Error of each level in mesh units, never falling; `f64::MAX` if no bound is stated, as for
    /// levels without triangles, where [`Cut::error`] is infinite. Length:
    /// [`n_levels`](Self::n_levels).
    pub fn errors(&self) -> &[f64] {
        self.file.errors()
    }

    /// What the levels state beside their errors, such as how far each field of a volume has come
    /// from that of the input: name and a number per level, never falling. These are estimates.
    pub fn deviations(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.file.deviations()
    }

    /// The whole curve, finest level first. Cost: in a file with [births](Self::vertex_births) one
    /// pass over them and 4 bytes per level.
    pub fn curve(&self) -> impl ExactSizeIterator<Item = CurvePoint> + '_ {
        let mut n_unborn = self.unborn_counts().into_iter();
        let counts = self.file.simplex_counts().iter().zip(self.file.vertex_counts());
        let counts = counts.map(move |(&simplices, &vertices)| {
            (simplices, vertices.saturating_sub(n_unborn.next().unwrap_or(0)))
        });
        self.errors().iter().zip(counts).map(|(&error, (simplices, vertices))| CurvePoint {
            error: from_file(error),
            simplices,
            vertices,
        })
    }

    /// Vertices born after each level; empty where all are born at level 0. Every one of them dies
    /// later still.
    fn unborn_counts(&self) -> Vec<u32> {
        let births = self.vertex_births();
        if births.is_empty() {
            return Vec::new();
        }
        let mut counts = vec![0; self.n_levels() as usize];
        for &birth in births {
            if let Some(count) = counts.get_mut((birth as usize).wrapping_sub(1)) {
                *count += 1;
            }
        }
        for level in (1..counts.len()).rev() {
            counts[level - 1] += counts[level];
        }
        counts
    }

    /// First level that has each vertex, in the order of [`vertices`](Self::vertices); empty where
    /// level 0 has them all, as after a decimator that only removes.
    pub fn vertex_births(&self) -> &[u32] {
        self.file.vertex_births()
    }

    /// Positions of all vertices, relative to [`origin`](Self::origin). The vertices of any level
    /// are in a prefix.
    pub fn vertices(&self) -> &[[f32; 3]] {
        self.file.positions()
    }

    /// Vertex indices of all slots, [`n_corners`](Self::n_corners) each: the buffer that runs refer
    /// to.
    pub fn indices(&self) -> &[u32] {
        self.file.simplices()
    }

    /// Per-vertex attributes, in the order of [`vertices`](Self::vertices).
    pub fn attributes(&self) -> impl ExactSizeIterator<Item = AttributeView<'_>> {
        self.file.attributes()
    }

    /// What the file holds: triangles of a surface or tetrahedra of a volume.
    pub fn simplex(&self) -> Simplex {
        if self.n_corners() == 4 { Simplex::Tetrahedron } else { Simplex::Triangle }
    }

    /// Vertex indices per simplex: 3 for triangles, 4 for tetrahedra.
    pub fn n_corners(&self) -> u32 {
        self.file.header().n_corners
    }

    /// Stored lifetimes; a simplex may have several.
    pub fn n_lifetimes(&self) -> u64 {
        self.file.header().n_lifetimes
    }

    /// Added to every position to give the coordinates of the input.
    pub fn origin(&self) -> [f64; 3] {
        self.file.header().origin
    }

    /// Least and largest coordinates of all vertices, relative to [`origin`](Self::origin).
    pub fn bounds(&self) -> ([f32; 3], [f32; 3]) {
        (self.file.header().bounds_min, self.file.header().bounds_max)
    }

    /// Length of the diagonal of [`bounds`](Self::bounds): what percentages of error refer to.
    pub fn bounding_diagonal(&self) -> f64 {
        let (min, max) = self.bounds();
        let side_sq = |i: usize| (f64::from(max[i]) - f64::from(min[i])).powi(2);
        (0..3).map(side_sq).sum::<f64>().sqrt()
    }

    /// Largest distance between a vertex of the input and its position here, in mesh units.
    pub fn rounding(&self) -> f64 {
        self.file.header().rounding
    }

    /// How the file was made.
    ///
    /// # Errors
    ///
    /// If the metadata of the file is not a JSON object of the known shape.
    pub fn metadata(&self) -> Result<Metadata, serde_json::Error> {
        self.file.metadata()
    }

    /// Length of the file.
    pub fn file_bytes(&self) -> u64 {
        self.file.header().file_bytes
    }

    /// Checks everything the format promises: checksums, padding, metadata, error table, counts,
    /// the interval tree with both lists of every node, vertex indices against the vertex prefix of
    /// every level, positions, and that the operations build level 0 up.
    ///
    /// For a file read into memory the answer holds for as long as this value lives; for a mapped
    /// one it is a fact about the past. Cost: `O(n log n)` in the slots, all threads; memory up to
    /// 8 bytes per slot.
    ///
    /// # Errors
    ///
    /// The first rule that is broken.
    pub fn verify(&self) -> Result<(), VerifyError> {
        self.file.verify()
    }

    /// The operations of a progressive build, for [`ProgressiveMesh`](crate::ProgressiveMesh);
    /// empty if the file has none.
    pub fn operations(&self) -> &[u8] {
        self.file.operations()
    }

    /// The opened file behind this.
    pub(crate) fn file(&self) -> &Opened {
        &self.file
    }

    fn at_index(&self, level: usize) -> Cut<'_> {
        self.at_level(u32::try_from(level).unwrap_or(u32::MAX))
    }
}
