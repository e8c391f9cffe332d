//! Proving a file's error table anew, from the file alone.
//!
//! The builder states each level's error from a map that it carried along. Nothing of that is used
//! here: the finest level of the file is the input, every level is a mesh, and the distance between
//! the two is bounded in both directions by branch and bound ([`check_within`]). The two proofs
//! share no code beyond the distance of a point to a triangle. Of a volume the surface around it is
//! taken, on which its errors are.

use crate::measure::{MeasureError, Verdict, check_within};
use crate::query::{Cut, Lod, QueryError};
use crate::store::Bound;
use nephrite_formats::TriangleMesh;

/// Pieces after which the proof of a level is given up.
const MAX_PIECES: usize = 20_000_000;

/// The errors that a file states, and the mesh that they are relative to.
#[derive(Debug)]
pub struct ErrorTable<'a> {
    lod: &'a Lod,
    input: TriangleMesh,
    last_certified: u32,
    /// Added to every stated error: what rounding moves the vertices of a volume's boundary that
    /// stay in one plane or line. 0 for surfaces, whose errors count it in.
    slack: f64,
}

/// Rounding of a fusion point, in parts of the largest coordinate.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// Why a level's error was not proven anew.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReproveError {
    /// The file does not claim a proof.
    #[error("errors are of the kind {found}, only certified ones can be proven")]
    NotCertified {
        /// What the file's metadata say the errors are.
        found: Bound,
    },
    /// The file does not claim a proof for this level, as where a decimator has changed the
    /// topology.
    #[error("level {level} carries an estimate, certified are the errors up to level {last_certified}")]
    Estimate {
        /// The level.
        level: u32,
        /// The last level with a certified error.
        last_certified: u32,
    },
    /// The error is wrong.
    #[error("level {level} states an error of {stated:e}, a point is {distance:e} away")]
    Exceeded {
        /// The level.
        level: u32,
        /// Its error, in mesh units.
        stated: f64,
        /// A distance that occurs, in mesh units.
        distance: f64,
    },
    /// The proof did not come to an end.
    #[error("level {level} states an error of {stated:e}, proven is {upper_bound:e}")]
    Undecided {
        /// The level.
        level: u32,
        /// Its error, in mesh units.
        stated: f64,
        /// Proven bound of its distance, in mesh units.
        upper_bound: f64,
    },
    /// The metadata cannot be read.
    #[error("metadata cannot be read: {0}")]
    Metadata(String),
    /// A level cannot be taken out of the file.
    #[error(transparent)]
    Query(#[from] QueryError),
    /// A level has no distance.
    #[error(transparent)]
    Measure(#[from] MeasureError),
}

impl<'a> ErrorTable<'a> {
    /// The error table of `lod`. Copies the finest level.
    ///
    /// # Errors
    ///
    /// [`ReproveError`] when the file's errors are estimates, or its finest level is damaged.
    pub fn new(lod: &'a Lod) -> Result<Self, ReproveError> {
        let metadata = lod.metadata().map_err(|error| ReproveError::Metadata(error.to_string()))?;
        let Some(last_certified) = lod.last_proven(&metadata) else {
            return Err(ReproveError::NotCertified { found: metadata.bound });
        };
        // A level is within its error of the input, and level 0 is within its own: a level has the
        // difference left.
        let finest = surface(lod, &lod.at_level(0))?;
        let input = TriangleMesh { rounding: finest.rounding.max(lod.at_level(0).error()), ..finest };
        let largest = input.positions.iter().flatten().fold(0.0_f32, |largest, x| largest.max(x.abs()));
        let slack = if lod.n_corners() == 4 { ROUNDING * f64::from(largest) } else { 0.0 };
        Ok(Self { lod, input, last_certified, slack })
    }

    /// The last level whose error the file calls certified.
    pub fn last_certified(&self) -> u32 {
        self.last_certified
    }

    /// Proves that no point of level `level` is farther from the input than the level's error, nor
    /// the other way round. Level 0 is the input, so there is nothing to prove. Costs about as much
    /// as measuring the distance.
    ///
    /// # Errors
    ///
    /// [`ReproveError::Exceeded`] when the error is wrong, [`ReproveError::Undecided`] when this
    /// proof fails, and what stands in the way of trying.
    pub fn prove(&self, level: u32) -> Result<(), ReproveError> {
        let cut = self.lod.at_level(level);
        if cut.level() == 0 {
            return Ok(());
        }
        let last_certified = self.last_certified;
        if cut.level() > last_certified {
            return Err(ReproveError::Estimate { level: cut.level(), last_certified });
        }
        let stated = cut.error();
        // The level is what the file says; only the input was rounded on its way there.
        let mesh = TriangleMesh { rounding: 0.0, ..surface(self.lod, &cut)? };
        match check_within(&self.input, &mesh, stated + self.slack, MAX_PIECES)? {
            Verdict::Within => Ok(()),
            Verdict::Beyond { distance, .. } => Err(ReproveError::Exceeded { level, stated, distance }),
            Verdict::Undecided { upper_bound } => Err(ReproveError::Undecided { level, stated, upper_bound }),
        }
    }
}

/// The mesh of a level; of a volume, its boundary.
fn surface(lod: &Lod, cut: &Cut<'_>) -> Result<TriangleMesh, QueryError> {
    if lod.n_corners() == 4 { cut.boundary() } else { cut.to_mesh() }
}
