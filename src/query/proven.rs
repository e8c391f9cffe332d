//! Whether the error of a level is proven or an estimate.

use super::{Cut, Lod, Simplex};
use crate::store::{Bound, Metadata};

impl Lod {
    /// The last level whose error the file calls proven; `None` if all its errors are estimates.
    /// Cost: a binary search over the levels.
    pub fn last_proven(&self, metadata: &Metadata) -> Option<u32> {
        let proven = match self.simplex() {
            Simplex::Triangle => Bound::Certified,
            Simplex::Tetrahedron => Bound::Boundary,
        };
        let is_proven = metadata.bound == proven;
        let least = metadata.certified_simplices.unwrap_or(0);
        let counts = self.file().simplex_counts();
        let n_proven = counts.partition_point(|&count| u64::from(count) >= least);
        is_proven.then(|| u32::try_from(n_proven.saturating_sub(1)).unwrap_or(u32::MAX))
    }
}

impl Cut<'_> {
    /// Whether the file calls the [error](Self::error) of the level proven; otherwise it is an
    /// estimate. False if the metadata cannot be read. Cost: the metadata are read.
    ///
    /// ```
    /// use nephrite::{BuildOptions, EstimateKind, JadeOptions, Lod, StoreOptions, build, generate};
    /// let is_proven = |options: BuildOptions| -> Result<bool, Box<dyn std::error::Error>> {
    ///     let mut bytes = std::io::Cursor::new(vec![]);
    ///     build(&generate::torus(16, 8), &options)?.write_to(&mut bytes, &StoreOptions::default())?;
    ///     Ok(Lod::from_bytes(bytes.get_ref())?.at_count(100).is_proven())
    /// };
    /// assert!(is_proven(BuildOptions::default())?);
    /// assert!(!is_proven(BuildOptions::with(JadeOptions::estimate(EstimateKind::Joint)))?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn is_proven(&self) -> bool {
        let metadata = self.lod().metadata();
        metadata
            .is_ok_and(|metadata| self.lod().last_proven(&metadata).is_some_and(|last| self.level() <= last))
    }
}
