//! From a tetrahedral mesh to the history of its fusion.

use crate::build::BuildError;
use crate::decimate::fusion::{self, FusionOptions};
use crate::decimate::{Decimated, Input};
use crate::history::History;
use crate::mesh::{TetrahedronRepairReport, check_counts, repair_tetrahedra};
use crate::{Observer, Phase, Progress};
use nephrite_formats::{MeshError, TetrahedronMesh};
use serde::{Deserialize, Serialize};

/// How to build from a volume.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VolumeOptions {
    /// Largest error of any level, in mesh units; `None` simplifies as far as it goes.
    pub max_error: Option<f64>,
    /// Edges of the boundary at which its normals turn by more than this, in degrees, are feature edges.
    pub feature_angle_degrees: f64,
    /// Constants of the fusion.
    pub fusion: FusionOptions,
}

impl Default for VolumeOptions {
    fn default() -> Self {
        Self { max_error: None, feature_angle_degrees: 40.0, fusion: FusionOptions::default() }
    }
}

/// What a build of a volume leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeBuild {
    /// The input after repair, and behind its vertices all fusion points: what the history's indices refer to.
    pub mesh: TetrahedronMesh,
    /// Every tetrahedron that ever lived. Its errors bound the distance between the boundary of a step and that of the input
    /// both ways; its deviations are estimates: of the planar quadric distance, and of every field.
    pub history: History<4>,
    /// What the repair did.
    pub repairs: TetrahedronRepairReport,
    /// Fusions made.
    pub n_fusions: usize,
    /// Fusions of tetrahedra among them, which come first; the others are of edges.
    pub n_tetrahedron_fusions: usize,
    /// Tetrahedra left by the fusions of tetrahedra.
    pub n_left_by_tetrahedra: usize,
}

/// Repairs `mesh` and fuses its tetrahedra as the options say. The result does not depend on the number of threads.
///
/// # Errors
///
/// [`BuildError`] for a mesh without tetrahedra or that contradicts itself, for options out of their range, and when `observer`
/// breaks.
pub fn build_volume(
    mesh: &TetrahedronMesh,
    options: &VolumeOptions,
    observer: Observer<'_>,
) -> Result<VolumeBuild, BuildError> {
    check_options(options)?;
    check_counts(mesh.positions.len(), mesh.tetrahedra.len())?;
    mesh.check().map_err(|error| inconsistent(&error))?;
    let n_in = mesh.tetrahedra.len();
    let tell = |phase, n_triangles, error| {
        let max_error = options.max_error;
        observer(&Progress { phase, n_triangles, n_triangles_in: n_in, error, max_error })
    };
    if tell(Phase::Repair, n_in, 0.0).is_break() {
        return Err(BuildError::Interrupted);
    }
    let (mesh, repairs) = repair_tetrahedra(mesh);
    if mesh.tetrahedra.is_empty() {
        return Err(BuildError::NoTetrahedra { n_tetrahedra: n_in });
    }
    let cos_feature_angle = options.feature_angle_degrees.to_radians().cos();
    let watch = |n_alive, error| tell(Phase::Decimate, n_alive, error);
    let input = Input { mesh, max_error: options.max_error, cos_feature_angle };
    let Decimated { mesh, history, report } = fusion::run(input, &options.fusion, &watch)?;
    Ok(VolumeBuild {
        mesh,
        history,
        repairs,
        n_fusions: report.n_fusions,
        n_tetrahedron_fusions: report.n_tetrahedron_fusions,
        n_left_by_tetrahedra: report.n_left_by_tetrahedra,
    })
}

fn inconsistent(error: &MeshError) -> BuildError {
    match *error {
        MeshError::NonFinite { place: nephrite_formats::Place::Item(_, vertex), .. } => {
            BuildError::NotFinite { vertex: usize::try_from(vertex).unwrap_or(usize::MAX) }
        }
        MeshError::InconsistentMesh { found, expected, .. } => BuildError::Inconsistent { found, expected },
        _ => BuildError::Inconsistent { found: 0, expected: 0 },
    }
}

fn check_options(options: &VolumeOptions) -> Result<(), BuildError> {
    let check = |option, expected, found: f64, is_good: bool| {
        if is_good { Ok(()) } else { Err(BuildError::Option { option, expected, found }) }
    };
    let VolumeOptions { max_error, feature_angle_degrees: angle, fusion } = *options;
    if let Some(error) = max_error {
        check("max error", "finite and above zero", error, error.is_finite() && error > 0.0)?;
    }
    check("feature angle", "from 0 to 180 degrees", angle, (0.0..=180.0).contains(&angle))?;
    let FusionOptions { field_weight: weight, tetrahedron_share: share, volume_loss: loss } = fusion;
    check("field weight", "finite and not negative", weight, weight.is_finite() && weight >= 0.0)?;
    check("tetrahedron share", "from 0 to 1", share, (0.0..=1.0).contains(&share))?;
    check("volume loss", "from 0 to 1", loss, (0.0..=1.0).contains(&loss))
}
