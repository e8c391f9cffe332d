//! The driver: candidates from the queue, each tried, the ones that hold made. First tetrahedra, as the paper has it; where no
//! tetrahedron can be fused any more, edges.

use super::edges::fuse_edges;
use super::options::FusionOptions;
use super::queue::Queue;
use super::state::{FusionReport, State};
use crate::decimate::{Decimated, Input, Stopped, Watch};
use crate::mesh::RepairedVolume;
use nephrite_formats::TetrahedronMesh;
use rayon::prelude::*;

/// Fusions between two calls of the observer.
const OBSERVED: usize = 256;

/// Fuses the tetrahedra of a mesh as far as it goes, or until the error of the boundary would exceed
/// the largest one asked for.
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

/// What is known of a tetrahedron, by slot.
#[derive(Clone, Copy, Default)]
struct Candidate {
    /// Whether its cost in the queue is out of date.
    is_stale: bool,
    /// What it costs with the boundary's error counted in, as far as known: a lower bound.
    cost: f32,
}

/// Fuses tetrahedra that cost no more than the cheapest `share` of them did at the start.
fn fuse_tetrahedra(state: &mut State, share: f64, watch: Watch<'_>) -> Result<(), Stopped> {
    #[expect(clippy::cast_possible_truncation, reason = "slots are counted in u32")]
    let n_slots = state.mesh.n_slots() as u32;
    let mut candidates = vec![Candidate::default(); n_slots as usize];
    let cost = |slot: u32| {
        let corners = state.mesh.get(slot)?;
        // What is inverted goes first: a fusion leaves nothing so.
        let is_right = state.mesh.six_volumes(slot) > 0.0;
        Some((slot, if is_right { state.cost(&state.tetrahedron(slot, corners)) } else { 0.0 }))
    };
    let costs: Vec<(u32, f64)> = (0..n_slots).into_par_iter().filter_map(cost).collect();
    let limit = quantile(&costs, share);
    let mut queue = Queue::new(costs.into_iter());
    let mut success_rate = SuccessRate::default();
    while !queue.is_first(u32::MAX, limit)
        && let Some(slot) = queue.pop()
    {
        let Some(corners) = state.mesh.get(slot) else { continue };
        let prey = state.tetrahedron(slot, corners);
        let candidate = &mut candidates[slot as usize];
        if std::mem::take(&mut candidate.is_stale) {
            let cost = state.cost(&prey).max(candidate.cost.into());
            if !queue.is_first(slot, cost) {
                queue.push(slot, cost);
                continue;
            }
        }
        let accepted = state.try_fusion(&prey);
        if success_rate.is_low_after(accepted.is_some()) {
            return Ok(());
        }
        let Some(accepted) = accepted else { continue };
        if comes_later(&mut candidate.cost, accepted.cost) && !queue.is_first(slot, accepted.cost) {
            queue.push(slot, accepted.cost);
            continue;
        }
        state.fuse(&prey, &accepted, |slot| candidates[slot as usize].is_stale = true);
        observe(state, watch)?;
    }
    Ok(())
}

/// The cost that a share of the candidates does not exceed: none for 0, no limit for 1.
fn quantile(costs: &[(u32, f64)], share: f64) -> f64 {
    if share >= 1.0 {
        return f64::INFINITY;
    }
    let mut costs: Vec<f64> = costs.iter().map(|&(_, cost)| cost).collect();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of a length")]
    let n_within = (share * costs.len() as f64) as usize;
    match n_within.checked_sub(1) {
        None => -1.0,
        Some(last) => *costs.select_nth_unstable_by(last, f64::total_cmp).1,
    }
}

/// How often tetrahedra could be fused lately. If nearly none can, edges take away more for the same
/// time.
#[derive(Default)]
struct SuccessRate {
    n_tried: u32,
    n_held: u32,
}

impl SuccessRate {
    /// Tries in one count.
    const WINDOW: u32 = 4096;
    /// It is not worth going on if fewer than one of so many holds.
    const LEAST_PART: u32 = 256;

    /// Counts one more try. True at the end of a window in which too few held.
    fn is_low_after(&mut self, holds: bool) -> bool {
        self.n_tried += 1;
        self.n_held += u32::from(holds);
        if self.n_tried < Self::WINDOW {
            return false;
        }
        let is_rare = self.n_held * Self::LEAST_PART < self.n_tried;
        *self = Self::default();
        is_rare
    }
}

/// Takes down what a candidate costs with the boundary's error counted in; true where that is more than was known.
#[expect(clippy::cast_possible_truncation, reason = "the order needs no more digits")]
pub(super) fn comes_later(known: &mut f32, cost: f64) -> bool {
    let cost = cost as f32;
    let is_news = cost > *known;
    *known = known.max(cost);
    is_news
}

/// Told now and then how far it has come.
pub(super) fn observe(state: &State, watch: Watch<'_>) -> Result<(), Stopped> {
    let is_time = state.n_fusions.is_multiple_of(OBSERVED);
    if is_time && watch(state.mesh.n_alive(), state.recorder.error()).is_break() {
        return Err(Stopped::Interrupted);
    }
    Ok(())
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
