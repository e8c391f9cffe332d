//! From a mesh to all its levels, in memory.

use crate::CompareError;
use nephrite::{BuildOptions, Lod, StoreOptions, TriangleMesh};
use std::io::Cursor;
use std::path::Path;
use std::time::Instant;

/// Which steps of the history become levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeptLevels {
    /// As many as a file keeps by default.
    Usual,
    /// Every step, for the finest choice of triangle counts.
    All,
}

/// All levels of a mesh, and what they cost.
#[derive(Debug)]
pub struct Build {
    /// The levels.
    pub lod: Lod,
    /// Seconds that the decimation took, without reading and storing.
    pub seconds: f64,
}

/// The triangles of a mesh file, without attributes.
///
/// # Errors
///
/// [`CompareError::Mesh`].
pub fn load(path: &Path) -> Result<TriangleMesh, CompareError> {
    let (mesh, _) = nephrite_formats::read_mesh(path)?;
    Ok(TriangleMesh { attributes: vec![], ..mesh })
}

/// Simplifies a mesh to the end, on the current rayon pool.
///
/// # Errors
///
/// [`CompareError`] if the engine refuses the mesh.
pub fn build_lod(
    mesh: &TriangleMesh,
    options: &BuildOptions,
    kept: KeptLevels,
) -> Result<Build, CompareError> {
    let start = Instant::now();
    let build = nephrite::build(mesh, options)?;
    let seconds = start.elapsed().as_secs_f64();
    let levels = match kept {
        KeptLevels::Usual => None,
        KeptLevels::All => Some(u32::MAX),
    };
    let mut file = Cursor::new(vec![]);
    build.write_to(&mut file, &StoreOptions { levels, ..StoreOptions::default() })?;
    Ok(Build { lod: Lod::from_bytes(file.get_ref())?, seconds })
}

/// At most `n` levels whose triangle counts are evenly spread in the logarithm, each once, finest
/// first. The last one is the coarsest; the first one has already lost triangles.
pub fn spread_levels(lod: &Lod, n: u32) -> Vec<u32> {
    let [finest, coarsest] =
        [0, lod.n_levels() - 1].map(|level| lod.at_level(level).n_simplices().max(1) as f64);
    let wanted = (1..=n).map(|i| finest * (coarsest / finest).powf(f64::from(i) / f64::from(n)));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two counts")]
    let mut levels: Vec<u32> = wanted.map(|n| lod.at_count(n.round() as usize).level()).collect();
    levels.dedup();
    levels
}

#[cfg(test)]
mod tests {
    use super::*;
    use nephrite::generate;

    #[test]
    fn levels_are_spread_from_behind_the_input_to_the_coarsest() -> Result<(), CompareError> {
        let build = build_lod(&generate::sphere(8), &BuildOptions::default(), KeptLevels::All)?;
        let levels = spread_levels(&build.lod, 8);
        assert_eq!(levels.len(), 8);
        assert!(levels[0] > 0 && levels.is_sorted());
        assert_eq!(levels.last(), Some(&(build.lod.n_levels() - 1)));
        Ok(())
    }
}
