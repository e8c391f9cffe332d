//! The driver: candidates from the queue, each tried, the ones that hold made. First tetrahedra, as
//! the paper has it; where no tetrahedron can be fused any more, edges.

use super::edges::fuse_edges;
use super::options::FusionOptions;
use super::state::{FusionReport, State};
use super::tetrahedra::fuse_tetrahedra;
use crate::decimate::{Decimated, Input, Stopped, Watch};
use crate::mesh::RepairedVolume;
use nephrite_formats::TetrahedronMesh;

/// Fuses the tetrahedra of a mesh as far as it goes, or until the error of the boundary would
/// exceed the largest one asked for.
///
/// # Errors
///
/// [`Stopped`] when `watch` breaks.
pub(crate) fn run(
    input: Input<RepairedVolume>,
    options: &FusionOptions,
    watch: Watch<'_>,
) -> Result<Decimated<TetrahedronMesh, 4, FusionReport>, Stopped> {
    let mut state = State::new(input, options);
    let max_error = state.max_error;
    state.max_error = max_error.min(state.fine_error);
    fuse_tetrahedra(&mut state, options.tetrahedron_share, watch)?;
    state.max_error = max_error;
    let by_tetrahedra = [state.n_fusions, state.mesh.n_alive()];
    fuse_edges(&mut state, watch)?;
    Ok(state.finish(by_tetrahedra))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::ball_volume;
    use crate::mesh::repair_tetrahedra;
    use crate::volume::boundary_of_checked as boundary;
    use std::ops::ControlFlow;

    /// The boundary of a ball and one vertex in its middle, to which every tetrahedron goes.
    fn cone(cells: u32) -> TetrahedronMesh {
        let surface = boundary(&ball_volume(cells));
        let hub = u32::try_from(surface.positions.len()).unwrap();
        let mesh = TetrahedronMesh {
            tetrahedra: surface.triangles.iter().map(|&[a, b, c]| [hub, a, b, c]).collect(),
            positions: surface.positions.into_iter().chain([[0.0; 3]]).collect(),
            ..TetrahedronMesh::default()
        };
        assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0));
        mesh
    }

    fn fused(mesh: &TetrahedronMesh) -> FusionReport {
        let input = Input {
            mesh: repair_tetrahedra(mesh),
            max_error: None,
            cos_feature_angle: 0.5,
            lock_boundary: false,
        };
        run(input, &FusionOptions::default(), &|_, _| ControlFlow::Continue(())).unwrap().report
    }

    #[test]
    fn work_at_one_vertex_follows_its_tetrahedra() {
        let [few, many] = [20, 40].map(cone);
        assert_eq!([few.tetrahedra.len(), many.tetrahedra.len()], [4800, 19_200]);
        let [few, many] = [&few, &many].map(fused);
        assert!(few.n_fusions > 400 && many.n_fusions > 1600, "{} and {}", few.n_fusions, many.n_fusions);
        let [few, many] = [few.n_read, many.n_read];
        assert!(
            many < 6 * few,
            "{few} entries of stars are read for a quarter of the mesh, {many} for all of it"
        );
    }
}
